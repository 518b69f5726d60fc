# Inside the window of degree 4 the filters of degree 4 neither under- nor overflow: lifts, cross products, their
# products and the sum of three err relatively by at most u each, which is what the calculus and incircle_term.g assume.
# The product of permanent and bound may underflow; as in orient2d_window.g, that does no harm.
#
# code: exactkernel.incircle.determinant_and_permanent
#   | lift_a, lift_b, lift_c = a * a + A * A, b * b + B * B, c * c + C * C
#   | det = lift_a * (bC - cB) + lift_b * (cA - aC) + lift_c * (aB - bA)
# constant: 0x1p253 = exactkernel.constants.MAX_COORDINATE_DEGREE_4
# exponent: -268 = exactkernel.constants.MIN_UNIT_DEGREE_4
# control, coordinates finer than the window: fixed<-268, ne> => fixed<-269, ne>
# control, coordinates larger than the window: <= 0x1p253 => <= 0x1p255

@rnd = float<ieee_64, ne>;
ax = fixed<-268, ne>(ax_); ay = fixed<-268, ne>(ay_); bx = fixed<-268, ne>(bx_); by = fixed<-268, ne>(by_);
cx = fixed<-268, ne>(cx_); cy = fixed<-268, ne>(cy_); dx = fixed<-268, ne>(dx_); dy = fixed<-268, ne>(dy_);
a rnd= ax - dx; A rnd= ay - dy; b rnd= bx - dx; B rnd= by - dy; c rnd= cx - dx; C rnd= cy - dy;
bC rnd= b * C; cB rnd= c * B; aa rnd= a * a; AA rnd= A * A; lift rnd= aa + AA;
minor rnd= bC - cB; plus rnd= |bC| + |cB|; term rnd= lift * minor; size rnd= plus * lift;

# the three terms are of one form: |term|, |term2|, |term3| are bounded alike
term2 = fixed<-1072, ne>(term2_); term3 = fixed<-1072, ne>(term3_);
two rnd= term + term2; det rnd= two + term3; sum2 rnd= size + |term2|; sum rnd= sum2 + |term3|;

{ |ax| <= 0x1p253 /\ |ay| <= 0x1p253 /\ |bx| <= 0x1p253 /\ |by| <= 0x1p253
  /\ |cx| <= 0x1p253 /\ |cy| <= 0x1p253 /\ |dx| <= 0x1p253 /\ |dy| <= 0x1p253
  /\ |term2| <= 1b1019 /\ |term3| <= 1b1019
  -> |term| <= 1b1019 /\ |size| <= 1b1019 /\ |det| <= 1b1022 /\ |sum| <= 1b1022
  /\ a -/ (ax - dx) in [-1b-53, 1b-53] /\ bC -/ (b * C) in [-1b-53, 1b-53] /\ aa -/ (a * a) in [-1b-53, 1b-53]
  /\ lift -/ (aa + AA) in [-1b-53, 1b-53] /\ minor -/ (bC - cB) in [-1b-53, 1b-53]
  /\ plus -/ (|bC| + |cB|) in [-1b-53, 1b-53] /\ term -/ (lift * minor) in [-1b-53, 1b-53]
  /\ size -/ (plus * lift) in [-1b-53, 1b-53] /\ two -/ (term + term2) in [-1b-53, 1b-53]
  /\ det -/ (two + term3) in [-1b-53, 1b-53] /\ sum -/ (sum2 + |term3|) in [-1b-53, 1b-53] }

# Inside the window of degree 2 the filters of orient2d and diametral neither under- nor overflow up to the permanent:
# every operation errs relatively by at most u, which is what orient2d_filter.g assumes. Both are p q - r s of four
# differences. The product of permanent and bound may underflow, which does no harm: det is a double, and rounding is
# monotone, so det > fl(y) only if det > y.
#
# code: exactkernel.orient2d.orient2d_filter
#   | left = (ax - cx) * (by - cy)
#   | right = (ay - cy) * (bx - cx)
#   | det = left - right
#   | error = bound * (abs(left) + abs(right))
# code: exactkernel.diametral.diametral_filter
#   | left = (px - ax) * (bx - px)
#   | right = (py - ay) * (py - by)
# constant: 0x1p509 = exactkernel.constants.MAX_COORDINATE_DEGREE_2
# exponent: -537 = exactkernel.constants.MIN_UNIT_DEGREE_2
# control, coordinates finer than the window: fixed<-537, ne> => fixed<-538, ne>
# control, coordinates larger than the window: <= 0x1p509 => <= 0x1p511

@rnd = float<ieee_64, ne>;
ax = fixed<-537, ne>(ax_); ay = fixed<-537, ne>(ay_);
bx = fixed<-537, ne>(bx_); by = fixed<-537, ne>(by_);
cx = fixed<-537, ne>(cx_); cy = fixed<-537, ne>(cy_);
p rnd= ax - cx; q rnd= by - cy; r rnd= ay - cy; s rnd= bx - cx;
left rnd= p * q; right rnd= r * s; det rnd= left - right; sum rnd= |left| + |right|;

{ |ax| <= 0x1p509 /\ |ay| <= 0x1p509 /\ |bx| <= 0x1p509 /\ |by| <= 0x1p509 /\ |cx| <= 0x1p509 /\ |cy| <= 0x1p509
  -> p -/ (ax - cx) in [-1b-53, 1b-53] /\ q -/ (by - cy) in [-1b-53, 1b-53]
  /\ left -/ (p * q) in [-1b-53, 1b-53] /\ right -/ (r * s) in [-1b-53, 1b-53]
  /\ det -/ (left - right) in [-1b-53, 1b-53] /\ sum -/ (|left| + |right|) in [-1b-53, 1b-53]
  /\ |det| <= 1b1022 /\ |sum| <= 1b1022 }

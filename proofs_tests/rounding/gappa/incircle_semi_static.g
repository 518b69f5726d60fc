# The filter of incircle in its semi-static form: where no computed difference from d is larger than M, here 1, the
# computed determinant errs by at most 128 u M^4, subnormal coordinates and underflow included. The shipped bound is
# 120 u M^4 where the permanent is as large as it can be, 12 M^4. Relative to smaller permanents, Gappa does not find it.
#
# code: exactkernel.incircle.determinant_and_permanent
#   | bC, cB, cA, aC, aB, bA = b * C, c * B, c * A, a * C, a * B, b * A
#   | lift_a, lift_b, lift_c = a * a + A * A, b * b + B * B, c * c + C * C
#   | det = lift_a * (bC - cB) + lift_b * (cA - aC) + lift_c * (aB - bA)
# control, an eighth of it: 1b-46 => 1b-49
# control, larger differences: |a| <= 1 => |a| <= 2

@rnd = float<ieee_64, ne>;
ax = rnd(ax_); ay = rnd(ay_); bx = rnd(bx_); by = rnd(by_); cx = rnd(cx_); cy = rnd(cy_); dx = rnd(dx_); dy = rnd(dy_);
a rnd= ax - dx; A rnd= ay - dy; b rnd= bx - dx; B rnd= by - dy; c rnd= cx - dx; C rnd= cy - dy;
bC rnd= b * C; cB rnd= c * B; cA rnd= c * A; aC rnd= a * C; aB rnd= a * B; bA rnd= b * A;
la rnd= rnd(a * a) + rnd(A * A); lb rnd= rnd(b * b) + rnd(B * B); lc rnd= rnd(c * c) + rnd(C * C);
ta rnd= la * rnd(bC - cB); tb rnd= lb * rnd(cA - aC); tc rnd= lc * rnd(aB - bA);
two rnd= ta + tb; det rnd= two + tc;
LA = (ax - dx) * (ax - dx) + (ay - dy) * (ay - dy);
LB = (bx - dx) * (bx - dx) + (by - dy) * (by - dy);
LC = (cx - dx) * (cx - dx) + (cy - dy) * (cy - dy);
DET = LA * ((bx - dx) * (cy - dy) - (cx - dx) * (by - dy)) + LB * ((cx - dx) * (ay - dy) - (ax - dx) * (cy - dy))
  + LC * ((ax - dx) * (by - dy) - (bx - dx) * (ay - dy));

{ |a| <= 1 /\ |A| <= 1 /\ |b| <= 1 /\ |B| <= 1 /\ |c| <= 1 /\ |C| <= 1 -> |det - DET| <= 1b-46 }

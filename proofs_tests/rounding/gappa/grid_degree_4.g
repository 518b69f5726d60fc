# The grid stages of degree 4: incircle and centre_side are exact where differences are integer multiples of the grid
# unit, at most GRID_STEPS of them.
#
# code: exactkernel.incircle.determinant_and_permanent
#   | det = lift_a * (bC - cB) + lift_b * (cA - aC) + lift_c * (aB - bA)
# code: exactmesh.verify.centres.centre_side
#   | det = doubled * (sx * wy - sy * wx) + (sx * y - sy * x)
#   | error = 0.0 if largest <= k.grid_limit else _FACTOR * k.incircle_bound * permanent
# code: exactkernel.incircle.incircle_slow
#   | within = max(max(max(abs(a), abs(A)), max(abs(b), abs(B))), max(abs(c), abs(C))) <= k.grid_limit
# constant: 0x1p12 = exactkernel.constants.GRID_STEPS
# control, the limit is too large: <= 0x1p12 => <= 0x1p14
# control, differences off the grid: @FIX(a, 0) => @FIX(a, -5)

@rnd = float<ieee_64, ne>;
bC rnd= b * C; cB rnd= c * B; cA rnd= c * A; aC rnd= a * C; aB rnd= a * B; bA rnd= b * A;
la rnd= rnd(a * a) + rnd(A * A); lb rnd= rnd(b * b) + rnd(B * B); lc rnd= rnd(c * c) + rnd(C * C);
ta rnd= la * rnd(bC - cB); tb rnd= lb * rnd(cA - aC); tc rnd= lc * rnd(aB - bA);
two rnd= ta + tb; det rnd= two + tc;
DET = (a * a + A * A) * (b * C - c * B) + (b * b + B * B) * (c * A - a * C) + (c * c + C * C) * (a * B - b * A);

{ @FIX(a, 0) /\ @FIX(A, 0) /\ @FIX(b, 0) /\ @FIX(B, 0) /\ @FIX(c, 0) /\ @FIX(C, 0)
  /\ |a| <= 0x1p12 /\ |A| <= 0x1p12 /\ |b| <= 0x1p12 /\ |B| <= 0x1p12 /\ |c| <= 0x1p12 /\ |C| <= 0x1p12
  -> det - DET in [0, 0] }

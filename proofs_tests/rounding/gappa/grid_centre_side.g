# The grid stage of centre_side: exact where differences are integer multiples of the grid unit, at most GRID_STEPS.
#
# code: exactmesh.verify.centres.centre_side
#   | doubled = 2.0 * (left - right)
#   | x, y = vy * u - uy * v, ux * v - vx * u
#   | det = doubled * (sx * wy - sy * wx) + (sx * y - sy * x)
#   | error = 0.0 if largest <= k.grid_limit else _FACTOR * k.incircle_bound * permanent
#   | error = 0.0 if largest <= k.grid_limit else _FACTOR * k.incircle_bound * permanent
#   | return 0 if error == 0.0 else UNKNOWN
# constant: 0x1p12 = exactkernel.constants.GRID_STEPS
# control, the limit is too large: <= 0x1p12 => <= 0x1p14
# control, differences off the grid: @FIX(ux, 0) => @FIX(ux, -5)

@rnd = float<ieee_64, ne>;
u rnd= rnd(ux * ux) + rnd(uy * uy); v rnd= rnd(vx * vx) + rnd(vy * vy);
doubled rnd= 2 * rnd(rnd(ux * vy) - rnd(uy * vx));
x rnd= rnd(vy * u) - rnd(uy * v); y rnd= rnd(ux * v) - rnd(vx * u);
det rnd= rnd(doubled * rnd(rnd(sx * wy) - rnd(sy * wx))) + rnd(rnd(sx * y) - rnd(sy * x));
U = ux * ux + uy * uy; V = vx * vx + vy * vy;
DET = 2 * (ux * vy - uy * vx) * (sx * wy - sy * wx) + (sx * (ux * V - vx * U) - sy * (vy * U - uy * V));

{ @FIX(ux, 0) /\ @FIX(uy, 0) /\ @FIX(vx, 0) /\ @FIX(vy, 0) /\ @FIX(sx, 0) /\ @FIX(sy, 0) /\ @FIX(wx, 0) /\ @FIX(wy, 0)
  /\ |ux| <= 0x1p12 /\ |uy| <= 0x1p12 /\ |vx| <= 0x1p12 /\ |vy| <= 0x1p12
  /\ |sx| <= 0x1p12 /\ |sy| <= 0x1p12 /\ |wx| <= 0x1p12 /\ |wy| <= 0x1p12 -> det - DET in [0, 0] }

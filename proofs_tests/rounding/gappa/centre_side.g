# The filter of centre_side: doubled * e + (sx y - sy x), relative to its permanent, with a constant twice that of
# incircle. Scaled so that the computed permanents of the two summands sum to 1: t and s, which the computed values fill
# to parts p and q. Each summand errs by at most 10 u + 90 u^2 of its permanent before its last rounding e, as the
# calculus finds (cross products 4 u, lifts 4 u, their products 9 u, sums of them 10 u).
#
# code: exactmesh.verify.centres.centre_side
#   | det = doubled * (sx * wy - sy * wx) + (sx * y - sy * x)
#   | permanent = doubles * (abs(sx * wy) + abs(sy * wx)) + (abs(sx) * ys + abs(sy) * xs)
#   | error = 0.0 if largest <= k.grid_limit else _FACTOR * k.incircle_bound * permanent
#   | if det > error:
#   | if -det > error:
# constant: 0x1.4000000000006p-49 = exactmesh.verify.centres._FACTOR * exactkernel.constants.INCIRCLE_BOUND
# control, half of the factor: 0x1.4000000000006p-49 => 0x1.4000000000006p-50
# control, the comparison is left out: /\ det - K >= 0 =>

C = 0x1.4000000000006p-49;
s = 1 - t;
det = t * p + s * q;
DET = t * (p + m1) + s * (q + m2);
K = C * (1 + g2) * (1 + g3) / (1 + g1);

{ t in [0, 1] /\ |p| <= 1 /\ |q| <= 1 /\ |m1| <= 0xB.001p-53 /\ |m2| <= 0xB.001p-53
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ det - K >= 0 -> DET >= 1b-52 }

DET -> (det - K) + K + (t * m1 + s * m2);
$ t in 8;

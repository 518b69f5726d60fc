# The double-double stage of degree 2: left - right in pairs, against DD_BOUND times the sum of the heads. Scaled to
# |left| + |right| = 1 (exact products): the computed pairs err by l, r, their sum by a relative to its value, the head
# of the sum by h. The bound is computed from rounded heads, g.
#
# code: exactkernel.orient2d.products_difference
#   | det, _ = dd_add(left, left_tail, -right, -right_tail)
#   | bound = DD_BOUND * (abs(left) + abs(right))
#   | if det > bound:
#   | if -det > bound:
# code: exactkernel.crossing.dd_cross
#   | return high, low, DD_BOUND * (abs(left) + abs(right))
# code: exactkernel.bisector.nearer_adaptive
#   | error = DD_BOUND * (p + q)
#   | if difference > error:
#   | if -difference > error:
# constant: 0x1p-100 = exactkernel.constants.DD_BOUND
# control, an eighth of the bound: 0x1p-100 => 0x1p-103
# control, the comparison is left out: /\ det - K >= 0 =>

C = 0x1p-100;
y = 1 - |x|;
sum = (x * (1 + l) - y * sigma * (1 + r)) * (1 + a);
det = sum * (1 + h);
DET = x - y * sigma;
K = C * (1 + g);

{ |x| <= 1 /\ |sigma| <= 1 /\ |l| <= 0xB.001p-106 /\ |r| <= 0xB.001p-106 /\ |a| <= 0x3.001p-106 /\ |h| <= 1b-53
  /\ |g| <= 1b-49 /\ det - K >= 0 -> DET >= 1b-103 }

DET -> ((det - K) + K) / ((1 + a) * (1 + h)) - (x * l - y * sigma * r) { (1 + a) <> 0, (1 + h) <> 0 };
$ x in 16;

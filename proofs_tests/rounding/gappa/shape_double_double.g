# The double-double stages of angles, areas and lengths, where the weight is between SMALLEST_WEIGHT and LARGEST_WEIGHT.
# Each is a sum of three products (areas), of two squares and a third (lengths), or of two products with a sine and a
# cosine (angles), relative to its weight. Scaled so that the exact weight is 1: t, r, q, filled to parts x, y, z. A
# product errs by 8 u^2, for angles by 8 + 3 (cross product), 1 (sine in a pair) and 8 u^2; a sum by 3 u^2 each. Tails
# of products of the sine, and the squared bound, may underflow: an operation by 2^-1075, less than 64 of them, f;
# the exact weight is more than half of the computed one, which is at least SMALLEST_WEIGHT.
#
# code: exactkernel.angle.corner_code
#   | if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
#   | sign = beyond(corner_double_double(angle, ux, uxt, uy, uyt, vx, vxt, vy, vyt), DD_BOUND * weight)
# code: exactkernel.measure.area_code
#   | sign = beyond(dd_add(cross, cross_tail, -twice, 0.0)[0], DD_BOUND * weight)
# code: exactkernel.measure.length_code
#   | sign = beyond(dd_add(squared, squared_tail, -limit, -limit_tail)[0], DD_BOUND * weight)
# constant: 0x1p-100 = exactkernel.constants.DD_BOUND
# constant: 1b-218 = 2^6 * 2^-1074 / exactkernel.constants.SMALLEST_WEIGHT
# control, a quarter of the bound: 0x1p-100 => 0x1p-102
# control, no guard against underflow: /\ |f| <= 1b-218 =>

C = 0x1p-100;
r = (1 - t) * v; q = (1 - t) * (1 - v);
det = (((t * (x + l) + r * (y + m)) * (1 + a) + q * (z + n)) * (1 + b) + f) * (1 + h);
DET = t * x + r * y + q * z;
K = C * (1 + g);

{ t in [0, 1] /\ v in [0, 1] /\ |x| <= 1 /\ |y| <= 1 /\ |z| <= 1
  /\ |l| <= 0x18p-106 /\ |m| <= 0x18p-106 /\ |n| <= 0x18p-106 /\ |a| <= 0x3.001p-106 /\ |b| <= 0x3.001p-106
  /\ |f| <= 1b-218 /\ |h| <= 1b-53 /\ |g| <= 1b-48 /\ det - K >= 0 -> DET >= 1b-103 }

DET -> (((det - K) + K) / (1 + h) - f) / (1 + b) - (t * l + r * m + q * n) - (t * (x + l) + r * (y + m)) * a
  { (1 + b) <> 0, (1 + h) <> 0 };
$ t in 16, v in 16;

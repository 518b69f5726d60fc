# The filter of angles: dot sin - cross cos, relative to its weight, with what underflows where the weight is at least
# SMALLEST_WEIGHT. Scaled so that sin dots + |cos| crosses = 1: t and s are the two summands, x = dot / dots and
# y = cross / crosses (with the sign of the cosine). The true dot and cross products differ by m1, m2 (see below), sine
# and cosine by h1, h2. Products of the sine may underflow, by f, at most 2^-1075 over the exact weight, which is more
# than half of the computed one.
# m: products of two differences err by 3 u, their sum by u more, and the permanent is too small by u.
#
# code: exactkernel.angle.angle_filter
#   | det = angle.sine * dot - angle.cosine * cross
#   | weight = angle.sine * dots + abs(angle.cosine) * crosses
#   | if not weight >= SMALLEST_WEIGHT:
#   | return beyond(det, bound * weight)
# code: exactkernel.angle.angle_below_adaptive
#   | sign = angle_filter(SHAPE_FACTOR * k.orient2d_bound, angle, cross, crosses, max(max(da, db), dc), dots)
# code: exactkernel.angle.corner_code
#   | sign = angle_filter(SHAPE_FACTOR * ORIENT2D_BOUND, angle, cross, crosses, dot, dots)
# code: exactkernel.angle.angle_above_adaptive
#   | sign = angle_filter(SHAPE_FACTOR * k.orient2d_bound, angle, cross, crosses, min(min(da, db), dc), dots)
# code: exactkernel.angle.beyond
#   | return 1 if det > error else (-1 if -det > error else 0)
# constant: 0x1.8000000000004p-50 = exactkernel.constants.SHAPE_FACTOR * exactkernel.constants.ORIENT2D_BOUND
# constant: 1b-224 = 2^-1074 / exactkernel.constants.SMALLEST_WEIGHT
# control, half of the factor: 0x1.8000000000004p-50 => 0x1.8000000000004p-51
# control, no guard against underflow: /\ |f1| <= 1b-224 => 

C = 0x1.8000000000004p-50;
s = 1 - t;
det = t * x * (1 + e1) - s * y * (1 + e2) + (f1 - f2);
DET = t * ((1 + h1) * (x + m1)) - s * ((1 + h2) * (y + m2));
K = C * (((t * (1 + e4) + f3) + (s * (1 + e5) + f4)) * (1 + e6)) * (1 + e7) / (1 + e3);

{ t in [0, 1] /\ x in [-1, 1] /\ y in [-1, 1] /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53
  /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\ |e7| <= 1b-53 /\ |h1| <= 0x1.001p-53 /\ |h2| <= 0x1.001p-53
  /\ |m1| <= 0x4.001p-53 /\ |m2| <= 0x4.001p-53
  /\ |f1| <= 1b-224 /\ |f2| <= 1b-224 /\ |f3| <= 1b-224 /\ |f4| <= 1b-224 /\ det - K >= 0 -> DET >= 1b-52 }

DET -> (det - K) + K + (t * ((1 + h1) * (x + m1) - x * (1 + e1)) - s * ((1 + h2) * (y + m2) - y * (1 + e2))) - (f1 - f2);
(1 + h1) * (x + m1) - x * (1 + e1) -> x * (h1 - e1) + m1 * (1 + h1);
(1 + h2) * (y + m2) - y * (1 + e2) -> y * (h2 - e2) + m2 * (1 + h2);
$ t in 8;

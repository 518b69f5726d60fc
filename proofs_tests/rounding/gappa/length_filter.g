# The filter of lengths: squared - limit, relative to their sum, both positive. Scaled to squared + limit = 1,
# w = squared - limit. The squared length errs like a lift (4 roundings), the squared bound by one; that may underflow,
# by f, at most 2^-1075 over the exact weight, which is more than half of the computed one: that is at least
# SMALLEST_WEIGHT.
#
# code: exactkernel.measure.length_filter
#   | squared, limit = ux * ux + uy * uy, bound * bound
#   | weight = squared + limit
#   | if not weight >= SMALLEST_WEIGHT:
#   | return beyond(squared - limit, factor * weight)
# code: exactkernel.measure.length_above_adaptive
#   | sign = length_filter(SHAPE_FACTOR * k.orient2d_bound, bound, bx - ax, by - ay)
# code: exactkernel.measure.length_code
#   | sign = length_filter(SHAPE_FACTOR * ORIENT2D_BOUND, bound, bx - ax, by - ay)
# constant: 0x1.8000000000004p-50 = exactkernel.constants.SHAPE_FACTOR * exactkernel.constants.ORIENT2D_BOUND
# constant: 1b-224 = 2^-1074 / exactkernel.constants.SMALLEST_WEIGHT
# control, a sixth of the constant: 0x1.8000000000004p-50 => 0x1p-52
# control, no guard against underflow: /\ |f| <= 1b-224 =>

C = 0x1.8000000000004p-50;
t = (1 + w) / 2; s = (1 - w) / 2;
L = t * ((1 + d1) * (1 + d2) * (1 + d3) * (1 + d4)); R = s * (1 + d5) + f;
K = C * (1 + g2) * (1 + g3) / (1 + g1);

{ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53 /\ |d5| <= 1b-53 /\ |f| <= 1b-224
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ w in [-1, 1]
  /\ w - K >= 0 -> L - R >= 1b-52 }

w -> (w - K) + K;
L - R -> w + (t * ((1 + d1) * (1 + d2) * (1 + d3) * (1 + d4) - 1) - s * d5 - f);

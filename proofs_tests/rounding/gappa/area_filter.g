# The filter of areas: (left - right) - 2 bound, relative to its weight. Scaled so that |left| + |right| + 2 bound = 1:
# t, r, b are the three (left and right with their signs x, y). Sums do not underflow, and products in the window of
# degree 2 do not; the guard keeps the product with C from underflowing.
#
# code: exactkernel.measure.area_filter
#   | left, right, twice = ux * vy, uy * vx, 2.0 * bound
#   | weight = abs(left) + abs(right) + abs(twice)
#   | if not weight >= SMALLEST_WEIGHT:
#   | return beyond((left - right) - twice, factor * weight)
# code: exactkernel.measure.area_above_adaptive
#   | sign = area_filter(SHAPE_FACTOR * k.orient2d_bound, bound, bx - ax, by - ay, cx - ax, cy - ay)
# code: exactkernel.measure.area_code
#   | sign = area_filter(SHAPE_FACTOR * ORIENT2D_BOUND, bound, ux, uy, vx, vy)
# constant: 0x1.8000000000004p-50 = exactkernel.constants.SHAPE_FACTOR * exactkernel.constants.ORIENT2D_BOUND
# control, a quarter of the factor: 0x1.8000000000004p-50 => 0x1.8000000000004p-52
# control, the comparison is left out: /\ det - K >= 0 =>

C = 0x1.8000000000004p-50;
r = (1 - t) * v; b = (1 - t) * (1 - v);
det = (t * x - r * y) * (1 + e1) - b;
DET = t * x * ((1 + d1) * (1 + d2) * (1 + d3)) - r * y * ((1 + d4) * (1 + d5) * (1 + d6)) - b;
K = C * (((t + r) * (1 + e2) + b) * (1 + e3)) * (1 + e4) / (1 + e5);

{ t in [0, 1] /\ v in [0, 1] /\ |x| <= 1 /\ |y| <= 1 /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53
  /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53
  /\ |d4| <= 1b-53 /\ |d5| <= 1b-53 /\ |d6| <= 1b-53 /\ det - K >= 0 -> DET >= 1b-52 }

DET -> (det - K) + K + t * x * ((1 + d1) * (1 + d2) * (1 + d3) - (1 + e1))
  - r * y * ((1 + d4) * (1 + d5) * (1 + d6) - (1 + e1));

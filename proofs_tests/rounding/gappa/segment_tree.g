# 1. The value of a cut along a segment, relative to the sum of the absolute products at both ends, scaled to 1 (the part
# of the first end is t): each end errs by 3 u of its part, interpolation by two roundings, and one more for the
# comparison with cut + error, which is at most 2 there.
# 2. Where the cut meets the segment: (c - f) / (g - f), f and g known up to e each, at most a quarter of their
# difference, scaled to 1; the parameter is between -1/2 and 3/2 where it matters.
# 3. A point between two ends, relative to the sum of their magnitudes, scaled to 1.
#
# code: exactmesh.crossings.segment_tree._projected
#   | return ax + ay, bx + by, _ERROR * (abs(ax) + abs(ay) + abs(bx) + abs(by)) + _UNDERFLOW
# code: exactmesh.crossings.segment_tree._sides
#   | first, last = f + low * (g - f), f + high * (g - f)
#   | if min(first, last) > c + error:
#   | t = (c - f) / (g - f)
#   | slack = 4.0 * error / (abs(g - f) - 2.0 * error) + 8.0 * UNIT_ROUNDOFF
#   | elif max(first, last) < c - error:
#   | elif abs(g - f) > 4.0 * error:
# code: exactmesh.crossings.segment_tree.box_pieces
#   | first, last = a + low * (b - a), a + high * (b - a)
#   | error += _BOX_ERROR * (abs(a) + abs(b))
# constant: 1b-49 = exactmesh.crossings.segment_tree._ERROR
# constant: 1b-51 = exactmesh.crossings.segment_tree._BOX_ERROR
# constant: 1b-53 = exactkernel.constants.UNIT_ROUNDOFF
# control, half of the error: 1b-49 => 1b-50
# control, a quarter of the slack: 4 / (1 - 2 * e) => 1 / (1 - 2 * e)
# control, half of the box error: 1b-51 => 1b-52

#@ -Eno-auto-dichotomy
F = f + t * d1; G = g + (1 - t) * d2;
first = (f + low * (g - f) * (1 + r1) * (1 + r2)) * (1 + r3);
FIRST = F + low * (G - F);
T = (x - e * m1) / (1 + e * (m2 - m1));
steps = x * (1 + r4) * (1 + r6) / (1 + r5);
box = (a + low * (b - a) * (1 + r1) * (1 + r2)) * (1 + r3);
BOX = a + low * (b - a);

{ t in [0, 1] /\ |f| <= 1 /\ |g| <= 1 /\ f + g in [-1.01, 1.01] /\ |f - g| <= 1.01 /\ |d1| <= 0x3.001p-53 /\ |d2| <= 0x3.001p-53 /\ low in [0, 1]
  /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53 /\ |r5| <= 1b-53 /\ |r6| <= 1b-53
  /\ x in [-0.5, 1.5] /\ e in [0, 0.25] /\ |m1| <= 0.5 /\ |m2| <= 0.5
  /\ |a| <= 1 /\ |b| <= 1 /\ |b - a| <= 1 /\ |a + low * (b - a)| <= 1
  -> 1b-49 * (1 - 1b-50) - |first - FIRST| - 2 * 1b-53 >= 0
  /\ 4 / (1 - 2 * e) - |((1 - x) * m1 + x * m2) / (1 + e * (m2 - m1))| >= 0 /\ 8 * 1b-53 * (1 - 1b-50) - |steps - x| - 3b-53 >= 0
  /\ 1b-51 * (1 - 1b-50) - |box - BOX| >= 0 }

first - FIRST -> (f + low * (g - f) * (1 + r1) * (1 + r2)) * r3 + low * (g - f) * (r1 + r2 + r1 * r2)
  - (1 - low) * t * d1 - low * (1 - t) * d2;
box - BOX -> (a + low * (b - a)) * r3 + low * (b - a) * (r1 + r2 + r1 * r2) * (1 + r3);
steps - x -> x * ((1 + r4) * (1 + r6) - (1 + r5)) / (1 + r5) { (1 + r5) <> 0 };

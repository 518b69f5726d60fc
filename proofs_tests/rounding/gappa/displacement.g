# The distance of a point from a segment, bounded in doubles: cross product over length, and distance from an end. A
# length errs by 4 roundings under the root, its root by one more; the quotient and the product with 1 -+ doubt by two.
#
# code: exactmesh.refinement.displacement._distance_bounds
#   | low = low / length * (1.0 - _DOUBT)
#   | return low, high / length * (1.0 + _DOUBT)
#   | return low, min(to_a, to_b) * (1.0 + _DOUBT)
# constant: 1b-49 = exactmesh.refinement.displacement._DOUBT
# control, a quarter of the doubt: 1b-49 => 1b-51

root = sqrt((1 + d1) * (1 + d2) * (1 + d3) * (1 + d4));
length = root * (1 + d5);
high = 1 / length * (1 + r1) * ((1 + 1b-49) * (1 + r2)) * (1 + r3);
low = 1 / length * (1 + r1) * ((1 - 1b-49) * (1 + r2)) * (1 + r3);
{ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53 /\ |d5| <= 1b-53
  /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53
  -> high >= 1 /\ low <= 1 /\ length * ((1 + 1b-49) * (1 + r2)) * (1 + r3) >= 1 }

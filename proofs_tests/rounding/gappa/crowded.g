# An edge whose square, rounded, is clear of that of the least edge is not shorter than it: four roundings each, and where
# that matters at all, two underflows. Scaled so that the rounded square is 1: S is the exact one, N that of the least
# edge times _CLEAR, and 2^-1074 is at most 2^-74 beside _TINY.
#
# code: exactmesh.refinement.judging.is_crowded
#   | if rules.min_edge == 0.0 or nearest > max(_CLEAR * rules.min_edge * rules.min_edge, _TINY):
# constant: 0x1.004189374bc6ap0 = exactmesh.refinement.judging._CLEAR
# constant: 1b-74 = 2^-1074 / exactmesh.refinement.judging._TINY
# control, no allowance for roundings: 0x1.004189374bc6ap0 => 0x1p0
# control, no guard against underflow: |f| <= 1b-74 => |f| <= 1b-9

S = (1 - f) / ((1 + d1) * (1 + d2) * (1 + d3) * (1 + d4));
limit = N * ((1 + r1) * (1 + r2)) + g;
{ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53
  /\ |f| <= 1b-74 /\ |g| <= 1b-74 /\ limit in [0, 1] -> 0x1.004189374bc6ap0 * S - N >= 0 }
N -> (limit - g) / ((1 + r1) * (1 + r2)) { (1 + r1) <> 0, (1 + r2) <> 0 };

# Of two positions, the one that is not farther is never left out: its computed squared distance is at most that of the
# other, times 1 + 2^-40, plus 2^-500. S is the smaller exact square; four roundings each, and three underflows, of
# 2^-1075 (and of differences of scaled coordinates, below 2^-1074 2^502).
# Beyond a cut, dx or dy is at least across: rounding is monotone, so that squared is not less than across * across, and
# what is not looked at is no candidate.
#
# code: exactmesh.verify.nearest.within_reach
#   | squared = dx * dx + dy * dy
#   | is_far_in_reach = across * across <= best * _RELATIVE + _ABSOLUTE
#   | elif squared <= reach:
# code: exactmesh.verify.nearest.find_nearest
#   | _, counts[i] = within_reach(points, order, x, y, best * _RELATIVE + _ABSOLUTE, stack, found[i])
# constant: 0x1.0000000001p0 = exactmesh.verify.nearest._RELATIVE
# constant: 1b-500 = exactmesh.verify.nearest._ABSOLUTE
# control, no relative slack: 0x1.0000000001p0 => 0x1p0
# control, no absolute slack: 1b-500 => 1b-560

nearer = S * (1 + d1) * (1 + d2) * (1 + d3) * (1 + d4) + f1;
farther = (S + more) * (1 + d5) * (1 + d6) * (1 + d7) * (1 + d8) + f2;
reach = ((farther * 0x1.0000000001p0) * (1 + g1) + f3 + 1b-500) * (1 + g2);
{ S in [0, 1b1004] /\ more in [0, 1b1004] /\ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53
  /\ |d5| <= 1b-53 /\ |d6| <= 1b-53 /\ |d7| <= 1b-53 /\ |d8| <= 1b-53 /\ |f1| <= 1b-560 /\ |f2| <= 1b-560 /\ |f3| <= 1b-1075
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 -> reach - nearer >= 0 }
reach - nearer -> more * ((1 + d5) * (1 + d6) * (1 + d7) * (1 + d8) * 0x1.0000000001p0 * (1 + g1) * (1 + g2))
  + S * ((1 + d5) * (1 + d6) * (1 + d7) * (1 + d8) * 0x1.0000000001p0 * (1 + g1) * (1 + g2)
    - (1 + d1) * (1 + d2) * (1 + d3) * (1 + d4))
  + ((f2 * 0x1.0000000001p0 * (1 + g1) + f3 + 1b-500) * (1 + g2) - f1);

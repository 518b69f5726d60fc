# The distance of x + tail from a double, above = (x - p) + tail. Where x and p are within a factor of two of each other,
# the difference is exact, and what errs is one sum. Otherwise the tail is below 2^-51 of the difference, which is
# scaled to 1. In both cases the error is below 2^-51 of the computed value, and the doubt is more than that and the error.
#
# code: exactmesh.verify.dual_passes.between_neighbours
#   | above = (x - math.nextafter(claimed, -math.inf)) + tail
#   | doubt = _SLACK * error + 2.0**-50 * (abs(above) + abs(below)) + 2.0**-1000
#   | if above > doubt and below > doubt:
#   | return NO if above < -doubt or below < -doubt else UNKNOWN
# constant: 0x1.00001p0 = exactmesh.verify.dual_passes._SLACK
# control, a quarter of the doubt: 1b-50 => 1b-52
# control, no slack: 0x1.00001p0 => 0x1p0

far = (1 + small) * (1 + r1);
FAR = (1 + r2) + small;
doubt = ((0x1.00001p0 * error * (1 + g1) + 1b-50 * (1 + g2)) * (1 + g3)) * (1 + g4);

{ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |small| <= 1b-51 /\ error in [0, 1b1000]
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-52 /\ |g3| <= 1b-53 /\ |g4| <= 1b-53
  -> |far - FAR| / (1 - 1b-50) <= 1b-51
  /\ doubt - (error + 1b-51) >= 0 }

far - FAR -> r1 - r2 + small * r1;
doubt - (error + 1b-51) -> error * (0x1.00001p0 * (1 + g1) * (1 + g3) * (1 + g4) - 1)
  + (1b-50 * (1 + g2) * (1 + g3) * (1 + g4) - 1b-51);

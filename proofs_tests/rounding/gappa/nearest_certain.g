# Whether x is the double nearest to every number within the error of x + tail: the sums with the computed margin,
# rounded, are beyond the exact tail + error. So x + (tail + margin) = x, in rounding, says that of every number between
# (rounding is monotone). Scaled to |tail| + error = 1; mirrored for tail - margin.
#
# code: exactkernel.crossing.is_nearest_certain
#   | margin = error + 4.0 * UNIT_ROUNDOFF * (abs(tail) + error)
#   | return bool(x + (tail + margin) == x and x + (tail - margin) == x)
# constant: 1b-53 = exactkernel.constants.UNIT_ROUNDOFF
# control, an eighth of the margin: 4 * 1b-53 => 1b-54
# control, the sum rounds twice as badly: |r4| <= 1b-53 => |r4| <= 1b-51

error = 1 - |tail|;
margin = (error + 4 * 1b-53 * (1 + r1) * (1 + r2)) * (1 + r3);
{ |tail| <= 1 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  -> (tail + margin) * (1 + r4) - (tail + error) >= 0 }
(tail + margin) * (1 + r4) - (tail + error) ->
  4 * 1b-53 * (1 + r1) * (1 + r2) * (1 + r3) * (1 + r4) + error * r3 * (1 + r4) + (tail + error) * r4;
$ tail in 8;

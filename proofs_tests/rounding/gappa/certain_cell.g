# The cell floor(x + 1/2) of every number within the error of x + tail: above = (x - floor x) + tail errs by u of itself
# (the difference is exact), and the margin exceeds the error by four times that. So above - 1/2 >= margin says that the
# exact number is past the half, above + margin < 3/2 that it is before the next, and so on below: in every case the
# exact number differs from floor x + above by less than the margin. Scaled to |above| + error = 1.
#
# code: exactmesh.crossings.crossing_points._certain_cell
#   | above = (x - cell) + tail  # the difference is exact
#   | margin = error + 2.0**-52 * (abs(above) + error)
#   | if above - 0.5 >= margin and above + margin < 1.5:
#   | return cell, bool(above + margin < 0.5 and above + 0.5 >= margin)
# control, an eighth of the margin: 1b-52 => 1b-55
# control, the sum rounds twice as badly: |r4| <= 1b-53 => |r4| <= 1b-51

above = 1 - error;
margin = (error + 1b-52 * (1 + r1)) * (1 + r2);
{ error in [0, 1] /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r4| <= 1b-53
  -> margin - (error + above * |r4|) >= 0 }
margin - (error + above * |r4|) -> 1b-52 * (1 + r1) * (1 + r2) + error * r2 - above * |r4|;
$ error in 8;

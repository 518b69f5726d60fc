# A step of refinement of a coordinate by the exact difference, rounded. 1. The difference is a quotient of two sums of
# expansions, which err by 4 u each. 2. rest = tail + difference errs by that and by one rounding, less than error.
# 3. rest -+ margin, rounded, are beyond rest -+ error. Scaled to |difference| + |rest| = 1, to |rest| + error = 1.
#
# code: exactkernel.centre._beyond
#   | difference = _estimate(total, n_total) / (2.0 * _estimate(cross, n_cross))
# code: exactkernel.centre._decided
#   | error = 2.0**-48 * abs(difference) + 2.0**-52 * abs(rest)
#   | margin = error + 2.0**-50 * (abs(rest) + error)
#   | low, high = x + (rest - margin), x + (rest + margin)
# control, a quarter of the allowance for the difference: 1b-48 => 1b-50
# control, an eighth of the margin: 1b-50 * (1 + r4) => 1b-53 * (1 + r4)

quotient = (1 + a) / (1 + b) * (1 + r1);
rest = 1 - difference;
error = (1b-48 * difference * (1 + r1) + 1b-52 * rest * (1 + r2)) * (1 + r3);
part = 1 - |whole|;
margin = (part + 1b-50 * (1 + r4) * (1 + r5)) * (1 + r6);
{ |a| <= 1b-51 /\ |b| <= 1b-51 /\ difference in [0, 1] /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53
  /\ |whole| <= 1 /\ |r4| <= 1b-53 /\ |r5| <= 1b-53 /\ |r6| <= 1b-53 /\ |r7| <= 1b-53
  -> |quotient - 1| <= 1b-49 /\ error - (1b-49 * difference + 1b-53 * rest) >= 0
  /\ (whole + margin) * (1 + r7) - (whole + part) >= 0 }
quotient - 1 -> (a - b + (1 + a) * r1) / (1 + b) { (1 + b) <> 0 };
error - (1b-49 * difference + 1b-53 * rest) -> difference * (1b-48 * (1 + r1) * (1 + r3) - 1b-49)
  + rest * (1b-52 * (1 + r2) * (1 + r3) - 1b-53);
(whole + margin) * (1 + r7) - (whole + part) ->
  1b-50 * (1 + r4) * (1 + r5) * (1 + r6) * (1 + r7) + part * r6 * (1 + r7) + (whole + part) * r7;

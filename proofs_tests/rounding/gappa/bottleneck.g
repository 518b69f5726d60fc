# 1. The distance of a vertex from a line (times the length): |V| is between head -+ error, with what is noted as the
# error, and rounded. Scaled so that the head is 1; its tail is below u; the bound of dd_cross is at least twice what
# errs, e. 2. The limit for a chain: the product of a distance and a length, which errs by less than 2^-51. 3. The bounds
# of the distance: head -+ noted, rounded (1.), over the length.
#
# code: exactmesh.verify.bottleneck.measure
#   | high, low, error = dd_cross(ux, uxt, py, pyt, uy, uyt, px, pxt)
#   | search.error[w] = error + abs(low) + 2.0**-50 * abs(high)
# code: exactmesh.verify.bottleneck.compare
#   | if search.high[v] + search.error[v] < search.high[w] - search.error[w]:
# code: exactmesh.verify.bottleneck.is_candidate
#   | return bool(search.high[w] - search.error[w] <= limit)
# code: exactmesh.verify.displaced.near_chains
#   | limits = np.maximum(scaled * lengths * (1.0 + _MARGIN), np.finfo(np.float64).tiny)
#   | bounds = np.stack([crosses[:, 0] - crosses[:, 1], crosses[:, 0] + crosses[:, 1]], axis=1) / lengths[:, None]
#   | bounds = np.ldexp(np.maximum(bounds * [1.0 - _MARGIN, 1.0 + _MARGIN], 0.0), -_exponent(mesh))
# constant: 1b-40 = exactmesh.verify.displaced._MARGIN
# control, no allowance for the head: 1b-50 => 1b-55
# control, no margin for the limit: 1b-40 => 1b-60

noted = ((2 * e + |low|) * (1 + r1) + 1b-50 * (1 + r2)) * (1 + r3);
limit = (1 + h) * (1 + r1) * (1 + 1b-40) * (1 + r2);
upper = 1 / (1 + h) * (1 + r1) * (1 + 1b-40) * (1 + r2);
lower = 1 / (1 + h) * (1 + r1) * (1 - 1b-40) * (1 + r2);
{ e in [0, 1b100] /\ |low| <= 1b-53 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53 /\ |h| <= 1b-51
  -> (1 + noted) * (1 + r4) - (1 + |low| + e) >= 0 /\ (1 - |low| - e) - (1 - noted) * (1 + r4) >= 0
  /\ limit - 1 >= 0 /\ upper - 1 >= 0 /\ lower - 1 <= 0 }
(1 + noted) * (1 + r4) - (1 + |low| + e) -> e * (2 * (1 + r1) * (1 + r3) * (1 + r4) - 1)
  + (|low| * ((1 + r1) * (1 + r3) * (1 + r4) - 1) + (1b-50 * (1 + r2) * (1 + r3) * (1 + r4) + r4));
(1 - |low| - e) - (1 - noted) * (1 + r4) -> e * (2 * (1 + r1) * (1 + r3) * (1 + r4) - 1)
  + (|low| * ((1 + r1) * (1 + r3) * (1 + r4) - 1) + (1b-50 * (1 + r2) * (1 + r3) * (1 + r4) - r4));

# The error of a + n / det, given bounds of the errors of n and det (the last at most 2^-10 of det). Scaled so that the
# heads of n and det are 1: n = 1 + v and det = 1 + w are the pairs, D = det + z the exact one.
# 1. A bound of the error of n counts 1 / D, less than 9/8 as often. 2. So does that of det, times the quotient.
# 3. The computed quotient errs by less than 24 u^2 from that of the pairs. The first rounding is r1, the product with
# det errs by p (8 u^2) in all and by m in its head; n - m is exact, as the two are nearly equal.
#
# code: exactkernel.centre.quotient_offset
#   | high = n / det
#   | m, m_tail = dd_multiply(det, det_tail, high, 0.0)
#   | q, q_tail = fast_two_sum(high, ((n - m) + (n_tail - m_tail)) / det)
#   | error = n_error / abs(det) + abs(q) * (det_error / abs(det) + DD_BOUND)
#   | return x, x_tail, _SLACK * (error + DD_BOUND * abs(x))
# code: exactkernel.crossing._coordinate
#   | q, q_tail = fast_two_sum(high, ((p - m) + (p_tail - m_tail)) / det)
#   | error = num_error * abs(u / det) + abs(q) * (det_error / abs(det) + DD_BOUND)
#   | return x, x_tail, _SLACK * (error + DD_BOUND * abs(x))
# code: exactkernel.crossing.crossing_in_pairs
#   | if det_error > _SMALL * abs(det):
# code: exactkernel.centre.circumcentre_in_pairs
#   | if det_error > _SMALL * abs(det) or det == 0.0:
# code: exactkernel.bisector.bisector_crossing
#   | if det == 0.0 or det_error > _SMALL * abs(det):
# constant: 1b-10 = exactkernel.centre._SMALL
# constant: 1b-10 = exactkernel.crossing._SMALL
# constant: 1b-10 = exactkernel.bisector._SMALL
# constant: 0x1.2p0 = exactkernel.centre._SLACK
# constant: 0x1.2p0 = exactkernel.crossing._SLACK
# constant: 0x1p-100 = exactkernel.constants.DD_BOUND
# control, a denominator that errs by a quarter: |z| <= 1b-10 => |z| <= 1b-2
# control, no slack: 0x1.2p0 => 0x1p0
# control, a sixteenth of the bound: 0x1p-100 => 0x1p-104

D = (1 + w) + z;
high = 1 + r1;
product = (1 + w) * high * (1 + p);
m = product * (1 + h);
tails = (v - (product - m)) * (1 + r2);
step = ((1 - m) + tails) * (1 + r3) * (1 + r4);
pair = high + step;
slack = 0x1.2p0 * (1 - 1b-48);

{ |v| <= 1b-53 /\ |w| <= 1b-53 /\ |z| <= 1b-10 /\ |p| <= 0x8.001p-106 /\ |h| <= 1b-53
  /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  -> 1 / D - slack <= 0 /\ (1 + v) / ((1 + w) * D) / (1 - 1b-50) - slack <= 0
  /\ |pair * (1 + w) - (1 + v)| / (1 + w) + 0xB.001p-106 - 0x1p-100 <= 0 }

pair * (1 + w) - (1 + v) -> ((1 + w) * high - (1 + v)) * (1 - (1 + w) * (1 + r3) * (1 + r4))
  - (1 + w) * (1 + r3) * (1 + r4) * ((1 + w) * high * p - (v - (product - m)) * r2);

# The filter of nearer: the difference of two lifts, relative to their sum. A lift errs by two differences (squared), a
# product and a sum, all of one sign: d1 ... d4. Scaled to left + right = 1.
#
# code: exactkernel.bisector.nearer_adaptive
#   | to_p, to_q = ux * ux + uy * uy, vx * vx + vy * vy
#   | error = _NEARER_BOUND * (to_p + to_q)
#   | if to_p - to_q > error:
#   | if to_q - to_p > error:
# constant: 0x1.0000000000004p-51 = exactkernel.bisector._NEARER_BOUND
# control, no second-order term: 0x1.0000000000004p-51 => 0x1p-51
# control, the comparison is left out: /\ w - K >= 0 => 

C = 0x1.0000000000004p-51;
t = (1 + w) / 2; s = (1 - w) / 2;
L = t * ((1 + d1) * (1 + d2) * (1 + d3) * (1 + d4)); R = s * ((1 + d5) * (1 + d6) * (1 + d7) * (1 + d8));
K = C * (1 + g2) * (1 + g3) / (1 + g1);

{ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53
  /\ |d5| <= 1b-53 /\ |d6| <= 1b-53 /\ |d7| <= 1b-53 /\ |d8| <= 1b-53
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ w in [0, 1] /\ w - K >= 0 -> L - R >= 1b-107 }

w -> (w - K) + K;
L - R -> w + (t * ((1 + d1) * (1 + d2) * (1 + d3) * (1 + d4) - 1)
  - s * ((1 + d5) * (1 + d6) * (1 + d7) * (1 + d8) - 1));
$ w in (0x4p-53, 0x5p-53, 0x8p-53);

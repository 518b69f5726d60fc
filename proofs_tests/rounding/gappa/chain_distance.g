# 1. across: the cross product is head + tail, wrong by at most error; the bounds are head -+ doubt. Scaled so that
# head + error + |tail| = 1; the roundings of the doubt and of the sums are r.
# 2. beside: an inner product of differences, relative to its permanent: positive for certain. Scaled to |p| + |q| = 1.
#
# code: exactmesh.crossings.chain_distance.across
#   | doubt = 2.0 * (error + abs(tail)) + 4.0 * UNIT_ROUNDOFF * abs(cross)
#   | return max(abs(cross) - doubt, 0.0), abs(cross) + doubt
# code: exactmesh.crossings.chain_distance.beside
#   | doubt = 16.0 * UNIT_ROUNDOFF
#   | return bool(p + q > doubt * (abs(p) + abs(q)) and r + t > doubt * (abs(r) + abs(t)))
# constant: 1b-53 = exactkernel.constants.UNIT_ROUNDOFF
# control, no doubt about the head: 4 * 1b-53 => 1b-55
# control, an eighth of the doubt: 16 * 1b-53 => 2 * 1b-53

both = 1 - head;
doubt = (2 * both * (1 + r1) + 4 * 1b-53 * head * (1 + r2)) * (1 + r3);
y = 1 - |x|;
inner = x + sigma * y;
INNER = x * (1 + d) + sigma * y * (1 + e);
K = 16 * 1b-53 * (1 + g2) * (1 + g3) / (1 + g1);

{ head in [0, 1] /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  /\ |x| <= 1 /\ |sigma| <= 1 /\ |d| <= 0x3.001p-53 /\ |e| <= 0x3.001p-53
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ inner - K >= 0
  -> (head + doubt) * (1 + r4) - (head + both) >= 0 /\ (head - both) - (head - doubt) * (1 + r4) >= 0
  /\ INNER >= 1b-52 }

(head + doubt) * (1 + r4) - (head + both) ->
  both * (2 * (1 + r1) * (1 + r3) * (1 + r4) - 1) + head * (4 * 1b-53 * (1 + r2) * (1 + r3) * (1 + r4) + r4);
(head - both) - (head - doubt) * (1 + r4) ->
  both * (2 * (1 + r1) * (1 + r3) * (1 + r4) - 1) + head * (4 * 1b-53 * (1 + r2) * (1 + r3) * (1 + r4) - r4);
INNER -> (inner - K) + K + (x * d + sigma * y * e);
$ x in 4;

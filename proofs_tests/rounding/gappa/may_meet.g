# Whether a segment may meet a pixel under a node: what is rejected, is missed for certain. Scaled so that
# ux (|y| + |ay|) + uy (|x| + |ax|) = 1: t and s are the summands. across errs by the differences ux, uy (a), the middle
# of the box and its difference (b), and its own roundings (c). The reach of pixels is H + W; it errs alike, and is at
# most 2 where anything is rejected, because |across| is at most 1 and some u.
#
# code: exactmesh.crossings.hot_pixels._may_meet
#   | across = ux * (y - ay) - uy * (x - ax) if rises else ux * (y - ay) + uy * (x - ax)
#   | reach = ux * (y - box[node, 1] + 1.0) + uy * (x - box[node, 0] + 1.0)  # half a unit more than the pixels
#   | doubt = 32.0 * UNIT_ROUNDOFF * (ux * (abs(y) + abs(ay)) + uy * (abs(x) + abs(ax)))
#   | return bool(abs(across) <= reach + doubt)
# constant: 1b-53 = exactkernel.constants.UNIT_ROUNDOFF
# control, a quarter of the doubt: 32 * 1b-53 => 8 * 1b-53
# control, the comparison is left out: /\ across - bound >= 0 =>

#@ -Eno-auto-dichotomy
s = 1 - t;
across = (t * p * (1 + c1) + s * q * (1 + c2)) * (1 + c3);
ACROSS = t * (1 + a1) * (p + b1) + s * (1 + a2) * (q + b2);
reach = (H * (1 + c4) + W * (1 + c5)) * (1 + c6);
REACH = H * (1 + a3) + W * (1 + a4) + b3;
bound = (reach + 32 * 1b-53 * (1 + d1)) * (1 + d2);

{ t in [0, 1] /\ |p| <= 1 /\ |q| <= 1 /\ H in [0, 2] /\ W in [0, 2] /\ |a1| <= 1b-53 /\ |a2| <= 1b-53
  /\ |a3| <= 0x4.001p-53 /\ |a4| <= 0x4.001p-53 /\ |b1| <= 0x2.001p-53 /\ |b2| <= 0x2.001p-53 /\ |b3| <= 1b-53
  /\ |c1| <= 1b-53 /\ |c2| <= 1b-53 /\ |c3| <= 1b-53 /\ |c4| <= 1b-53 /\ |c5| <= 1b-53 /\ |c6| <= 1b-53
  /\ |d1| <= 1b-50 /\ |d2| <= 1b-53 /\ reach in [0, 1.01] /\ H + W in [0, 1.02]
  /\ across - bound >= 0 -> ACROSS - REACH >= 1b-52 }

ACROSS - REACH -> (across - bound) + (ACROSS - across) + (bound - reach) - (REACH - reach);
ACROSS - across -> t * ((1 + a1) * (p + b1) - p * (1 + c1) * (1 + c3)) + s * ((1 + a2) * (q + b2) - q * (1 + c2) * (1 + c3));
(1 + a1) * (p + b1) - p * (1 + c1) * (1 + c3) -> p * ((1 + a1) - (1 + c1) * (1 + c3)) + (1 + a1) * b1;
(1 + a2) * (q + b2) - q * (1 + c2) * (1 + c3) -> q * ((1 + a2) - (1 + c2) * (1 + c3)) + (1 + a2) * b2;
bound - reach -> reach * d2 + 32 * 1b-53 * (1 + d1) * (1 + d2);
REACH - reach -> (H + W) * (a3 - c6) + W * (a4 - a3) + b3 - (H * c4 + W * c5) * (1 + c6);

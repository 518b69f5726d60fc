# Shewchuk's bound, relative to the computed permanent: where |det| > C (|left| + |right|), the sign of det is right.
# For left > right > 0, scaled to left + right = 1, w = left - right (the other cases mirror this one, or add two
# numbers of one sign). A difference errs by d1, d2 (d4, d5), a product by d3 (d6); det, the sum and its product with C
# by g1, g2, g3.
#
# code: exactkernel.orient2d.orient2d_filter
#   | error = bound * (abs(left) + abs(right))
#   | return 1 if det > error else (-1 if -det > error else 0)
# code: exactkernel.diametral.diametral_filter
#   | error = bound * (abs(left) + abs(right))
#   | return 1 if det > error else (-1 if -det > error else 0)
# code: exactkernel.bisector.along_adaptive
#   | left, right = wx * dx, wy * dy
#   | error = ORIENT2D_BOUND * (abs(left) + abs(right))
#   | if left + right > error:
#   | if -(left + right) > error:
# code: exactmesh.verify.bottleneck.is_ahead
#   | left, right = ux * dx, uy * dy
#   | error = ORIENT2D_BOUND * (abs(left) + abs(right))
#   | if left + right > error:
#   | if -(left + right) > error:
# code: exactmesh.cavity.is_nearer
#   | if k.orient2d_bound == math.inf or abs(difference) > k.orient2d_bound * (abs(left) + abs(right)):
# constant: 0x1.8000000000004p-52 = exactkernel.constants.ORIENT2D_BOUND
# control, half of the second-order term: 0x1.8000000000004p-52 => 0x1.8000000000002p-52
# control, the comparison is left out: /\ w - K >= 0 => 

C = 0x1.8000000000004p-52;
t = (1 + w) / 2; s = (1 - w) / 2;
L = t * ((1 + d1) * (1 + d2) * (1 + d3)); R = s * ((1 + d4) * (1 + d5) * (1 + d6));
K = C * (1 + g2) * (1 + g3) / (1 + g1);

{ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53 /\ |d5| <= 1b-53 /\ |d6| <= 1b-53
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ w in [0, 1] /\ w - K >= 0 -> L - R >= 1b-107 }

w -> (w - K) + K;
L - R -> w + (t * ((1 + d1) * (1 + d2) * (1 + d3) - 1) - s * ((1 + d4) * (1 + d5) * (1 + d6) - 1));
$ w in (0x3p-53, 0x4p-53, 0x6p-53);

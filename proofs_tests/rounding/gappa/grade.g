# Whether a violation is rounding-sized, |D| <= C P for the exact D and P: the double-double value errs by at most
# 2^-100 P, the weight by 2^-48 of P. So 2^-40 of the threshold on either side decides. Scaled to P = 1; C is the smallest
# of the constants that it is asked about.
#
# code: exactmesh.verify.grading.grade
#   | threshold = bound * weight
#   | if value > threshold * (1.0 + _MARGIN):
#   | return ROUNDING_SIZED if value < threshold * (1.0 - _MARGIN) else UNKNOWN
# constant: 1b-40 = exactmesh.verify.grading._MARGIN
# constant: 0x1.8000000000004p-52 = exactkernel.constants.ORIENT2D_BOUND
# constant: 0x1p-100 = exactkernel.constants.DD_BOUND
# control, no margin: 1b-40 => 1b-60

C = 0x1.8000000000004p-52;
threshold = C * (1 + g) * (1 + r1);
above = threshold * (1 + 1b-40) * (1 + r2);
below = threshold * (1 - 1b-40) * (1 + r3);
{ |g| <= 1b-48 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |e| <= 0x1p-100
  -> above - e - C >= 1b-100 /\ C - (below + e) >= 1b-100 }

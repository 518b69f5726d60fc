# a + (b - a) n / det: the product p of the pair n with the exact difference d. Scaled to d = 1 (with its tail z):
# n errs by n_error, counted once and u; the product by 8 u^2 of itself, below DD_BOUND; 9/8 covers the roundings.
#
# code: exactkernel.bisector._nearest_coordinate
#   | p, p_tail = dd_multiply(n, n_tail, d, d_tail)
#   | error = n_error * abs(d) + DD_BOUND * abs(p)
#   | x, tail, error = quotient_offset(a, p, p_tail, 1.125 * error, det, det_tail, det_error)
# constant: 0x1p-100 = exactkernel.constants.DD_BOUND
# control, no factor for the roundings: 1.125 => 1
# control, an eighth of the bound: 0x1p-100 => 0x1p-104

bound = 1.125 * ((n_error * (1 + r1) + 0x1p-100 * |p| * (1 + r2)) * (1 + r3)) * (1 + r4);
{ n_error in [0, 1b500] /\ p in [-1b1000, 1b1000] /\ |z| <= 1b-53 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  -> bound - (n_error * (1 + z) + 0x9p-106 * |p|) >= 0 }
bound - (n_error * (1 + z) + 0x9p-106 * |p|) -> n_error * (1.125 * (1 + r1) * (1 + r3) * (1 + r4) - (1 + z))
  + |p| * (1.125 * 0x1p-100 * (1 + r2) * (1 + r3) * (1 + r4) - 0x9p-106);

# The double-double stages of degree 4: a sum of three terms (of two, for crossing_order: the third is 0) in pairs,
# against DD_BOUND times the permanent computed in doubles. Scaled so that the exact permanents of the terms sum to 1: t,
# r, q, filled to parts x, y, z. A term errs by at most 32 u^2 of its permanent: lift 8 + 3, cross product 8 + 3 (of
# its permanent), their product 8 u^2; the numerators of crossing_order 8 + 3 + 3. A sum errs by 3 u^2, the head by u;
# the permanent, of some 12 roundings and 4 rounded differences, by less than 2^-48.
#
# code: exactkernel.incircle.incircle_double_double
#   | u, ut = dd_multiply(u, ut, *lift_double_double(a, at, A, At))
#   | u, ut = dd_add(u, ut, v, vt)
#   | return dd_add(u, ut, w, wt)[0]
# code: exactkernel.incircle.incircle_slow
#   | bound = DD_BOUND * permanent
#   | if det > bound:
#   | if -det > bound:
# code: exactkernel.bisector._crossing_order_exact
#   | error = DD_BOUND * (nw_permanent * dv_permanent + nv_permanent * dw_permanent)
#   | if det > error:
#   | if -det > error:
# constant: 0x1p-100 = exactkernel.constants.DD_BOUND
# control, a quarter of the bound: 0x1p-100 => 0x1p-102
# control, the comparison is left out: /\ det - K >= 0 =>

C = 0x1p-100;
r = (1 - t) * v; q = (1 - t) * (1 - v);
det = (((t * (x + l) + r * (y + m)) * (1 + a) + q * (z + n)) * (1 + b)) * (1 + h);
DET = t * x + r * y + q * z;
K = C * (1 + g);

{ t in [0, 1] /\ v in [0, 1] /\ |x| <= 1 /\ |y| <= 1 /\ |z| <= 1
  /\ |l| <= 0x20p-106 /\ |m| <= 0x20p-106 /\ |n| <= 0x20p-106 /\ |a| <= 0x3.001p-106 /\ |b| <= 0x3.001p-106
  /\ |h| <= 1b-53 /\ |g| <= 1b-48 /\ det - K >= 0 -> DET >= 1b-103 }

DET -> ((det - K) + K) / ((1 + b) * (1 + h)) - (t * l + r * m + q * n) - (t * (x + l) + r * (y + m)) * a
  { (1 + b) <> 0, (1 + h) <> 0 };
$ t in 16, v in 16;

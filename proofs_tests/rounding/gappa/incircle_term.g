# One term of incircle, lift * (bC - cB), errs by at most 9 u + 72 u^2 relative to its computed permanent.
# Scaled so that the computed lift and |bC| + |cB| are 1: w = bC - cB; the true lift is (1 + l)^4; the true bC - cB is
# w + m, where m is a weighted mean of the errors (1 + d)^3 - 1 of two products. The rest are roundings.
# That the sum of three such terms errs by at most C times the sum of their permanents is out of Gappa's reach (interval
# arithmetic loses that the weights of the terms sum to 1); the calculus of rounding errors proves it.
#
# code: exactkernel.incircle.determinant_and_permanent
#   | det = lift_a * (bC - cB) + lift_b * (cA - aC) + lift_c * (aB - bA)
#   | (abs(bC) + abs(cB)) * lift_a + (abs(cA) + abs(aC)) * lift_b + (abs(aB) + abs(bA)) * lift_c
# control, nothing but the first order: 0x9.0000000000024p-53 => 0x9p-53
# control, a product errs by 2 u: |d3| <= 1b-53 => |d3| <= 1b-52

#@ -Eprecision=128
LIFT = (1 + l1) * (1 + l2) * (1 + l3) * (1 + l4);
m = (1 + d1) * (1 + d2) * (1 + d3) - 1;
term = w * (1 + g1) * (1 + g2);
size = (1 + g3) * (1 + g4);

{ |d1| <= 1b-53 /\ |d2| <= 1b-53 /\ |d3| <= 1b-53
  /\ |l1| <= 1b-53 /\ |l2| <= 1b-53 /\ |l3| <= 1b-53 /\ |l4| <= 1b-53
  /\ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53 /\ |g4| <= 1b-53 /\ w in [-1, 1]
  -> |(term - LIFT * (w + m)) / size| <= 0x9.0000000000024p-53 }

term - LIFT * (w + m) -> w * ((1 + g1) * (1 + g2) - LIFT) - LIFT * m;

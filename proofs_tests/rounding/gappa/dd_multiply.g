# The product of two pairs: relative error at most 8 u^2 (the literature has 7 u^2 with a finer argument, and less).
# Scaled so that ah bh = 1: al = e ah, bl = f bh. two_product is exact: ph = 1 + d and pl = -d.
#
# code: exactkernel.doubledouble.dd_multiply
#   | ph, pl = two_product(ah, bh)
#   | return fast_two_sum(ph, pl + (ah * bl + al * bh))
# control, six u^2 are too few for this argument: 0x8.001p-106 => 0x6p-106
# control, a tail that is no tail: |e| <= 1b-53 => |e| <= 1b-50

s = (-d + (f * (1 + r1) + e * (1 + r2)) * (1 + r3)) * (1 + r4);
pair = (1 + d) + s;
exact = (1 + e) * (1 + f);

{ |d| <= 1b-53 /\ |e| <= 1b-53 /\ |f| <= 1b-53 /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  -> |pair - exact| / |exact| <= 0x8.001p-106 /\ |s| <= 0x3.001p-53 }

pair - exact -> (f * r1 + e * r2) + (f * (1 + r1) + e * (1 + r2)) * r3
  + (-d + (f * (1 + r1) + e * (1 + r2)) * (1 + r3)) * r4 - e * f;

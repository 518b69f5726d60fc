# The filter in its static form, with nothing assumed but the size: for coordinates up to 1, of any exponent, subnormal
# ones included, the computed determinant errs by at most 2^-49. That is 16/3 times the shipped bound where its permanent
# is 1, and needs no argument about relative errors.
#
# code: exactkernel.orient2d.orient2d_filter
#   | left = (ax - cx) * (by - cy)
#   | right = (ay - cy) * (bx - cx)
#   | det = left - right
# control, half of it: 1b-49 => 1b-50
# control, larger coordinates: |ax| <= 1 => |ax| <= 2

@rnd = float<ieee_64, ne>;
ax = rnd(ax_); ay = rnd(ay_); bx = rnd(bx_); by = rnd(by_); cx = rnd(cx_); cy = rnd(cy_);
p rnd= ax - cx; q rnd= by - cy; r rnd= ay - cy; s rnd= bx - cx;
left rnd= p * q; right rnd= r * s; det rnd= left - right;
DET = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx);

{ |ax| <= 1 /\ |ay| <= 1 /\ |bx| <= 1 /\ |by| <= 1 /\ |cx| <= 1 /\ |cy| <= 1 -> |det - DET| <= 1b-49 }

# The grid stage of orient2d and diametral: where differences are multiples of the grid unit and at most GRID_STEPS of
# them, every operation is exact, and so is the sign, zero included. Angles (45 degrees and its multiples) are compared
# with sine and cosine -1, 0 or 1: a sum of two such values.
#
# code: exactkernel.orient2d.orient2d_slow
#   | det = p * q - r * s
#   | return GRID + (1 if det > 0.0 else (-1 if det < 0.0 else 0))
#   | if max(max(abs(p), abs(q)), max(abs(r), abs(s))) <= c.grid_limit:
# code: exactkernel.diametral.diametral_slow
#   | det = p * q - r * s
#   | if max(max(abs(p), abs(q)), max(abs(r), abs(s))) <= c.grid_limit:
# code: exactkernel.angle.corner_code
#   | return GRID + sign_of(angle.sine * dot - angle.cosine * cross)
#   | if angle.is_exact and max(max(abs(ux), abs(uy)), max(abs(vx), abs(vy))) <= k.grid_limit:
# code: exactkernel.measure.area_code
#   | if max(max(abs(ux), abs(uy)), max(abs(vx), abs(vy))) <= k.grid_limit:
# constant: 0x1p12 = exactkernel.constants.GRID_STEPS
# control, the limit is too large: <= 0x1p12 => <= 0x1p27
# control, differences off the grid: @FIX(p, 0) => @FIX(p, -50)

@rnd = float<ieee_64, ne>;
left rnd= p * q; right rnd= r * s; det rnd= left - right;
dots1 rnd= p * r; dots2 rnd= q * s; dot rnd= dots1 + dots2; turned rnd= dot - det;

{ @FIX(p, 0) /\ @FIX(q, 0) /\ @FIX(r, 0) /\ @FIX(s, 0)
  /\ |p| <= 0x1p12 /\ |q| <= 0x1p12 /\ |r| <= 0x1p12 /\ |s| <= 0x1p12
  -> det - (p * q - r * s) in [0, 0] /\ turned - ((p * r + q * s) - (p * q - r * s)) in [0, 0] }


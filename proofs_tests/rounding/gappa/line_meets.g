# Whether a line passes the inside of a pixel: 2 cross - reach in pairs. Scaled so that the heads 2 cross and reach sum to
# 1; the tails are at most u of their heads (those of ux and uy at most u of the reach), two_diff is exact, and the
# cross product errs by at most error, e, which counts twice. So 2 e and what low errs by are below the first part of the
# doubt, and the last rounding is below the second.
#
# code: exactmesh.crossings.hot_pixels._line_meets
#   | apart, apart_tail = two_diff(2.0 * cross, reach)
#   | apart += apart_tail + (2.0 * cross_tail - reach_tail - ux_tail - uy_tail)
#   | 4.0 * error + 32.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF * (2.0 * cross + reach) + 4.0 * UNIT_ROUNDOFF * abs(apart)
#   | if apart > doubt:
#   | return 1 if apart < -doubt else -1
# constant: 1b-53 = exactkernel.constants.UNIT_ROUNDOFF
# control, a thirty-second of the doubt: 32 * 1b-106 => 1b-106
# control, no allowance for the last rounding: 4 * (1 + g2) => 0x1p-1 * (1 + g2)

#@ -Eno-auto-dichotomy
tails = ((ct - rt) * (1 + r1) - xt) * (1 + r2) - yt;
inner = tails * (1 + r3);
low = (at + inner) * (1 + r4);

{ |at| <= 1b-53 /\ |ct| <= 1b-53 /\ |rt| <= 1b-53 /\ |xt| <= 1b-53 /\ |yt| <= 1b-53
  /\ e in [0, 1] /\ |r1| <= 1b-53 /\ |r2| <= 1b-53 /\ |r3| <= 1b-53 /\ |r4| <= 1b-53
  /\ |g1| <= 1b-52 /\ |g2| <= 1b-53 /\ |g3| <= 1b-52
  -> (4 * e + 32 * 1b-106) * (1 + g1) * (1 + g3) - (2 * e + |low - (at + (ct - rt - xt - yt))|) >= 0
  /\ 4 * (1 + g2) * (1 + g3) * (1 - 1b-52) - 1 >= 0 }

low - (at + (ct - rt - xt - yt)) -> ((ct - rt) * (r1 + r2 + r1 * r2) - xt * r2) * (1 + r3) + (ct - rt - xt - yt) * r3
  + (at + inner) * r4;
(4 * e + 32 * 1b-106) * (1 + g1) * (1 + g3) - (2 * e + |low - (at + (ct - rt - xt - yt))|) ->
  e * (4 * (1 + g1) * (1 + g3) - 2) + (32 * 1b-106 * (1 + g1) * (1 + g3) - |low - (at + (ct - rt - xt - yt))|);

# Below LARGEST_WEIGHT nothing overflows in the double-double stages of shapes: Veltkamp's split multiplies by 2^27 + 1.
#
# code: exactkernel.expansions.split
#   | c = SPLITTER * a
# code: exactkernel.angle.corner_code
#   | if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
# code: exactkernel.measure.area_code
#   | if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
# code: exactkernel.measure.length_code
#   | if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
# constant: 0x1p990 = exactkernel.constants.LARGEST_WEIGHT
# constant: 0x8000001p0 = exactkernel.constants.SPLITTER
# control, a limit that is too large: <= 0x1p990 => <= 0x1p998

@rnd = float<ieee_64, ne>;
c rnd= 0x8000001p0 * a; high rnd= c - rnd(c - a); sum rnd= a + b;
{ |a| <= 0x1p990 /\ |b| <= 0x1p990 -> |c| <= 1b1023 /\ |high| <= 1b1023 /\ |sum| <= 1b1023 }

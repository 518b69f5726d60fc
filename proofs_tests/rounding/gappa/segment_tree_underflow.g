# What underflow adds to segment_tree.g, whose errors are relative. Each scaled coordinate is off by d (half of the
# smallest double, and what is between two ends by no more), each product by h, that with the bound by k.
# 1. A box: the sum with _UNDERFLOW rounds by r. A box that is a whole segment's is widened by _UNDERFLOW alone; that
# rounds away where the coordinate is large, but then scaling was exact. 2. A cut: |a|, |b| <= 1; the two ends differ by
# four products, and low (g - f) is one more.
#
# code: exactmesh.crossings.segment_tree.box_pieces
#   | error = _UNDERFLOW
#   | error += _BOX_ERROR * (abs(a) + abs(b))
# code: exactmesh.crossings.segment_tree._projected
#   | return ax + ay, bx + by, _ERROR * (abs(ax) + abs(ay) + abs(bx) + abs(by)) + _UNDERFLOW
# constant: 1b-1060 = exactmesh.crossings.segment_tree._UNDERFLOW
# control, the smallest double: 1b-1060 => 1b-1074

box = 1b-1060 * (1 + r) - (|(1 - low) * d1 + low * d2| + |h1| * (1 + 1b-52) + |k| * (1 + 1b-52));
end = 2 * 1b-1075 + 2 * 1b-1075;
cut = 1b-1060 * (1 + r) - (end + 2 * end + |h1| + |k|) * (1 + 1b-50);
{ low in [0, 1] /\ |d1| <= 1b-1075 /\ |d2| <= 1b-1075 /\ |h1| <= 1b-1075 /\ |k| <= 1b-1075 /\ |r| <= 1b-53
  -> box >= 0 /\ cut >= 0 }

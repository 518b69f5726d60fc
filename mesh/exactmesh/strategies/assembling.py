"""How graphs of small integers become PSLGs: turned, moved, scaled and numbered anew, all of it exactly."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh.pslg import PSLG, Carve
from exactmesh.strategies.drawing import seeds, shuffled

__all__ = ["Cells", "Pairs", "assembled", "closed", "path"]

#: Points as integers of fewer than 40 bits, (n, 2), and pairs of rows of them, (s, 2).
Cells = npt.NDArray[np.int64]
Pairs = npt.NDArray[np.int64]

#: Of determinant 1 or -1: what is simple stays simple.
_MAPS = (((1, 0), (0, 1)), ((0, 1), (1, 0)), ((1, 1), (0, 1)), ((2, 1), (1, 1)), ((-1, 0), (3, 1)), ((5, -2), (-2, 1)))
_SHIFTS = (0, -7, 10**6, 2**30, -(2**45))
_EXPONENTS = (0, -1, -20, -300, 300)


def closed(rows: npt.NDArray[np.int64]) -> Pairs:
    """Return the segments of a ring."""
    return np.stack([rows, np.roll(rows, -1)], axis=1)


def path(rows: npt.NDArray[np.int64]) -> Pairs:
    """Return the segments of an open chain."""
    return np.stack([rows[:-1], rows[1:]], axis=1)


def assembled(
    draw: st.DrawFn,
    cells: Cells,
    segments: Pairs,
    *,
    holes: Sequence[tuple[int, int]] = (),
    rule: Carve = Carve.SEEDS,
) -> PSLG:
    """Return the graph, mapped and numbered in some way that draws four choices; as it is where these are simplest."""
    seed, matrix = draw(seeds), np.array(draw(st.sampled_from(_MAPS)))
    shift, exponent = draw(st.sampled_from(_SHIFTS)), draw(st.sampled_from(_EXPONENTS))

    def placed(integers: Cells) -> FloatArray:
        doubles: FloatArray = (integers @ matrix.T + shift).astype(np.float64)
        return np.ldexp(doubles, exponent)

    order = shuffled(seed, len(cells)).astype(np.int64)
    numbers = np.empty_like(order)
    numbers[order] = np.arange(len(order))
    ends = numbers[segments][shuffled(seed, len(segments)).astype(np.int64)]
    if seed % 2:
        ends = ends[:, ::-1]
    seeds_of_holes = placed(np.array(holes, dtype=np.int64).reshape(-1, 2))
    return PSLG(placed(cells[order]), ends, holes=seeds_of_holes, rule=rule)

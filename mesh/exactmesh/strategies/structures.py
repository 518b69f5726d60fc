"""Quad-edges in any state that splices lead to."""

from hypothesis import strategies as st

from exactmesh.quadedge import QuadEdge
from exactmesh.strategies.drawing import check_sizes, words

__all__ = ["quadedges"]


def quadedges(*, min_size: int = 1, max_size: int = 8) -> st.SearchStrategy[QuadEdge]:
    """Draw edge structures: isolated edges, spliced at random into a subdivision of orientable surfaces of any genus.

    Every state of the edge algebra can be reached so. No edge is in order, no face is a triangle, most are not planar.

    Args:
        min_size, max_size: how many edges.

    Returns:
        A strategy for :class:`exactmesh.QuadEdge`. It shrinks to edges that are not joined. Vertices and faces have no
        labels.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    Reference [Guibas 1985].

    >>> from hypothesis import find
    >>> from exactmesh.strategies import quadedges
    >>> find(quadedges(min_size=3), lambda structure: True).counts()  # vertices, edges, faces: nothing is joined
    (6, 3, 3)
    """
    check_sizes(min_size, max_size)
    return _spliced(min_size, max_size)


@st.composite
def _spliced(draw: st.DrawFn, low: int, high: int) -> QuadEdge:
    count = draw(st.integers(low, high))
    structure = QuadEdge()
    edges = [structure.make_edge() for _ in range(count)]
    ends = [end for edge in edges for end in (edge, edge.sym)]
    chosen = draw(words(0, 6 * high)).tolist()
    for first, second in zip(chosen[::2], chosen[1::2], strict=False):
        if ends and (first - second) % len(ends):
            structure.splice(ends[first % len(ends)], ends[second % len(ends)])
    return structure

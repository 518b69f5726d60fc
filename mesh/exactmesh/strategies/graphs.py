"""Planar straight line graphs of every family."""

from collections.abc import Callable

from hypothesis import strategies as st

from exactmesh.pslg import PSLG
from exactmesh.strategies.drawing import check_sizes
from exactmesh.strategies.lines import near_concurrent, slits, small_angles, t_junctions
from exactmesh.strategies.polygons import polygons, polygons_with_holes, shared_borders, spirals

__all__ = ["pslgs"]


def pslgs(*, min_size: int = 3, max_size: int = 20, crossings: bool = False) -> st.SearchStrategy[PSLG]:
    """Draw graphs of any family that has graphs of that many points.

    Args:
        min_size, max_size: how many points.
        crossings: whether there may be segments that cross inside of each other.

    Returns:
        A strategy for :class:`exactmesh.PSLG`. Its segments bound a domain, but for those of :func:`near_concurrent`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 3 points.

    >>> from hypothesis import given, settings
    >>> from exactmesh import constrained_delaunay, verify
    >>> from exactmesh.strategies import pslgs
    >>> @settings(max_examples=20, deadline=None)  # the first call may compile
    ... @given(pslgs(max_size=10))
    ... def test_mesher(graph):
    ...     mesh = constrained_delaunay(graph)
    ...     verify(mesh.points, mesh.triangles, domain=graph).raise_if_failed()
    >>> test_mesher()
    """
    check_sizes(min_size, max_size, 3)
    families: tuple[tuple[int, Callable[..., st.SearchStrategy[PSLG]]], ...] = (
        (3, polygons),
        (3, small_angles),
        (5, t_junctions),
        (6, slits),
        (4, shared_borders),
        (4, spirals),
        (7, polygons_with_holes),
        *([(4, near_concurrent)] if crossings else []),
    )
    return st.one_of([family(min_size=min_size, max_size=max_size) for least, family in families if least <= max_size])

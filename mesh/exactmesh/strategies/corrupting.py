"""Triangulations with one fault, at a place of one's choice."""

import numpy as np
from hypothesis import reject
from hypothesis import strategies as st

from exactmesh.errors import OptionError
from exactmesh.strategies.corruptions import Corrupted, Corruption
from exactmesh.strategies.meshes import PlainMesh, triangulations
from exactmesh.strategies.spoiling import SPOILERS, Spoiler

__all__ = ["corrupt", "corrupted_triangulations"]


def corrupt(mesh: PlainMesh, corruption: Corruption | str, choice: int = 0) -> Corrupted:
    """Return the mesh with one fault.

    Args:
        mesh: a triangulation of the convex hull of its points, all of them used; of any origin.
        corruption: what is to be wrong.
        choice: any number from 0; it chooses the place.

    Raises:
        OptionError: there is no such fault, or no place for it in this mesh, such as no inner edge.

    O(n^3) at worst: for small meshes. The given arrays stay as they are.

    >>> from exactmesh import verify
    >>> from exactmesh.strategies import PlainMesh, corrupt
    >>> square = PlainMesh(np.array([(0.0, 0), (2, 0), (2, 2), (0, 2)]), np.array([(0, 1, 2), (0, 2, 3)]))
    >>> spoilt = corrupt(square, "dropped", 1)
    >>> spoilt.triangles.tolist()
    [[0, 1, 2]]
    >>> verify(spoilt.points, spoilt.triangles).verdict(spoilt.corruption.breaks)
    <Verdict.FAILS: 'fails'>
    """
    if corruption not in tuple(Corruption):
        raise OptionError(f"{corruption!r} is no corruption; choose from {', '.join(Corruption)}")
    kind = Corruption(corruption)
    try:
        points, rows, segments, labels = SPOILERS[kind](Spoiler(mesh, choice))
    except LookupError:
        raise OptionError(f"there is no place for {kind} in a mesh of {len(mesh.triangles)} triangles") from None
    return Corrupted(
        points,
        np.array(rows, dtype=np.int32).reshape(-1, 3),
        kind,
        None if segments is None else np.array(segments, dtype=np.int32).reshape(-1, 2),
        None if labels is None else np.array(labels),
    )


def corrupted_triangulations(
    *, min_size: int = 3, max_size: int = 12, corruption: Corruption | str | None = None
) -> st.SearchStrategy[Corrupted]:
    """Draw triangulations with one fault, which they name; without it they are Delaunay.

    A verifier must refuse them for what :attr:`Corruption.breaks`, and accept what is legal.

    Args:
        min_size, max_size: how many points, before points are added.
        corruption: the kind of fault; None draws one.

    Returns:
        A strategy for :class:`Corrupted`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 3 points; no
            such corruption.

    >>> from hypothesis import given, settings
    >>> from exactmesh import Verdict, verify
    >>> from exactmesh.strategies import corrupted_triangulations
    >>> @settings(max_examples=20, deadline=None)  # the first call may compile
    ... @given(corrupted_triangulations(max_size=8, corruption="hanging_node"))
    ... def test_verifier(mesh):
    ...     assert verify(mesh.points, mesh.triangles).verdict("admissible") is Verdict.FAILS
    >>> test_verifier()
    """
    if corruption is not None and corruption not in tuple(Corruption):
        raise OptionError(f"corruption={corruption!r} is none; choose from {', '.join(Corruption)}")
    meshes = triangulations(min_size=min_size, max_size=max_size, delaunay=True)
    return _corrupted(meshes, st.sampled_from(tuple(Corruption)) if corruption is None else st.just(corruption))


@st.composite
def _corrupted(
    draw: st.DrawFn, meshes: st.SearchStrategy[PlainMesh], kinds: st.SearchStrategy[Corruption | str]
) -> Corrupted:
    mesh, kind, choice = draw(meshes), draw(kinds), draw(st.integers(0, 2**16))
    try:
        return corrupt(mesh, kind, choice)
    except OptionError:  # no place for it
        reject()

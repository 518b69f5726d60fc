"""What verify was given: arrays, or a mesh of some package with what comes with it."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.verify.domain import Domain
from exactmesh.verify.properties import Orientation, Property

__all__ = ["Extras", "Given", "numbers_of", "of_mesh"]


class Given(NamedTuple):
    """Points and cells, as they were given."""

    points: object
    triangles: npt.ArrayLike | None
    quads: npt.ArrayLike | None


class Extras(NamedTuple):
    """What comes with them; ``usual`` is what is claimed of meshes of this sort."""

    segments: npt.ArrayLike | None
    domain: Domain | None
    labels: npt.ArrayLike | None
    orientation: Orientation | str | None
    usual: tuple[Property, ...] | None = None


def of_mesh(mesh: object, extras: Extras) -> tuple[Given, Extras]:
    """Return the arrays of a mesh of some package, and what comes with it, unless something else was given."""
    from exactmesh.adapters import given_mesh  # arrays need none of it

    given = given_mesh(mesh)
    own_domain = extras.domain is None
    return Given(given.points, given.triangles, given.quads), Extras(
        given.segments if extras.segments is None else extras.segments,
        given.domain if own_domain else extras.domain,
        given.labels if extras.labels is None and own_domain else extras.labels,
        given.orientation if extras.orientation is None else extras.orientation,
        given.claims,
    )


def numbers_of(**bounds: npt.ArrayLike | None) -> dict[str, float | FloatArray]:
    """Return what was given, as doubles."""
    given = {name: np.asarray(bound, dtype=np.float64) for name, bound in bounds.items() if bound is not None}
    return {name: array if array.ndim else float(array) for name, array in given.items()}

"""Whether two contents are the same, bit for bit."""

from dataclasses import fields

import numpy as np
from proofs_tests.fuzzing.judging import require

from exactmesh.io import Mesh

__all__ = ["require_same_dictionaries", "require_same_meshes", "same"]


def same(a: object, b: object) -> bool:
    """Tell whether two arrays are the same in shape, type and bits, two other things equal."""
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()
    return type(a) is type(b) and bool(a == b)


def require_same_meshes(first: Mesh, second: Mesh, *, but: tuple[str, ...] = ()) -> None:
    """Demand that what was read and written is read again as the same."""
    for field in fields(Mesh):
        if field.name not in but:
            ours, theirs = getattr(first, field.name), getattr(second, field.name)
            require(same(ours, theirs), f"{field.name} was {ours!r} and is read again as {theirs!r}")


def require_same_dictionaries(first: object, second: object) -> None:
    """Demand the same keys and arrays."""
    assert isinstance(first, dict)
    assert isinstance(second, dict)
    require(first.keys() == second.keys(), f"keys {sorted(first)} are read again as {sorted(second)}")
    for key in first:
        require(same(first[key], second[key]), f"{key} was {first[key]!r} and is read again as {second[key]!r}")

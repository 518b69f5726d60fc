"""V2 for the records in which the verifier keeps what it found: nobody can change them."""

import pkgutil
import sys
from dataclasses import FrozenInstanceError, fields, is_dataclass
from fractions import Fraction
from importlib import import_module

import numpy as np
import pytest

from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.mesh import index_quads, index_triples
from exactmesh.verify.report import root_above
from exactmesh.verify.submesh import Submesh

PACKAGE = sys.modules["exactmesh.verify"]


def records() -> list[type]:
    """The data classes of all modules of the verifier."""
    modules = [import_module(f"{PACKAGE.__name__}.{found.name}") for found in pkgutil.iter_modules(PACKAGE.__path__)]
    things = [(module, thing) for module in modules for thing in vars(module).values()]
    return [
        thing
        for module, thing in things
        if isinstance(thing, type) and is_dataclass(thing) and thing.__module__ == module.__name__
    ]


@pytest.mark.obligation("G2", "what was found cannot be changed afterwards", method="enumeration", control_in="mutants")
class TestRecords:
    """No attribute of a data class of the verifier can be set, and none can be added. Those that hold arrays of the
    input are equal to nothing but themselves, and do not print them."""

    def test_all(self) -> None:
        assert root_above(Fraction(1)) == 1.0
        found = records()
        assert len(found) > 20
        for record in found:
            one: object = object.__new__(record)
            for field in fields(record):
                with pytest.raises(FrozenInstanceError):
                    setattr(one, field.name, None)
            with pytest.raises(AttributeError):  # whatever the class itself would say
                object.__setattr__(one, "another", None)

    def test_arrays(self) -> None:
        points, triangles, quads = (
            np.zeros((3, 2)),
            np.array([(0, 1, 2)], dtype=np.int64),
            np.empty((0, 4), dtype=np.int64),
        )
        mesh, other = (CheckedMesh(points, index_triples(triangles), index_quads(quads)) for _ in range(2))
        part, same = (Submesh(points, triangles, quads, (0, 1, 2), (0,)) for _ in range(2))
        assert len({mesh, other, part, same}) == 4
        assert "[" not in repr(mesh)
        assert "points=" in repr(part)

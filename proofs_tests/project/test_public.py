"""What a user meets first: the version, the names of the package, and signatures that can be read."""

import importlib
import inspect
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy.typing as npt
import pytest
from typer.testing import CliRunner

import exactkernel
import exactmesh
import exactmesh.triangle
from exactmesh.cli import app

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = (exactkernel, exactmesh, exactmesh.triangle)


def signatures() -> Iterator[tuple[str, str]]:
    """Yield (name, signature as help() shows it) of the public functions, and of the methods of classes."""
    for package in PACKAGES:
        for name in package.__all__:
            value = getattr(package, name)
            members = vars(value) if inspect.isclass(value) else {}
            methods = {f"{name}.{key}": getattr(member, "__func__", member) for key, member in members.items()}
            for called, function in {name: value, **methods}.items():
                if inspect.isfunction(function):
                    yield f"{package.__name__}.{called}", str(inspect.signature(function))


def is_readable(signature: str) -> bool:
    """Tell whether no alias is spelt out: those of numpy stand for classes of modules that nobody is to know."""
    return not re.search(r"\b_[a-z]\w*\.|\b_[A-Z]", signature)


class TestSignatures:
    """Law: help() shows the types of arguments by their names, ``ArrayLike`` and not what it stands for."""

    def test_they_can_be_read(self) -> None:
        assert [name for name, signature in signatures() if not is_readable(signature)] == []

    def test_the_most_important_ones_are_seen(self) -> None:
        seen = {name for name, _ in signatures()}
        names = (
            "delaunay",
            "refine",
            "voronoi",
            "PSLG.__init__",
            "PSLG.from_rings",
            "Triangulation.locate",
            "triangle.delaunay",
        )
        assert {f"exactmesh.{name}" for name in names} <= seen

    def test_control_an_alias_spelt_out_is_noticed(self) -> None:
        def spelt(points: npt.ArrayLike) -> None: ...

        assert not is_readable(str(inspect.signature(spelt)))


class TestVersion:
    """Law: there is one version, whoever is asked."""

    def test_the_command_and_the_packages_agree(self) -> None:
        assert re.fullmatch(r"\d+\.\d+\.\d+", exactmesh.__version__)
        assert CliRunner().invoke(app, ["--version"]).output == f"exactmesh {exactmesh.__version__}\n"
        assert exactmesh.triangle.__version__ == exactmesh.__version__

    def test_the_distribution_takes_it_from_the_package(self) -> None:
        project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
        assert project["project"]["dynamic"] == ["version"]
        assert "version" not in project["project"]
        assert project["tool"]["hatch"]["version"]["path"] == "mesh/exactmesh/__init__.py"


class TestNames:
    """Law: what is made of Voronoi cells is found in exactmesh, for there ``voronoi`` is the function."""

    @pytest.mark.parametrize("name", ["interpolate", "lloyd", "natural_neighbors", "NaturalNeighbors", "Relaxation"])
    def test_the_room_and_the_house_have_the_same(self, name: str) -> None:
        assert inspect.isfunction(exactmesh.voronoi)
        assert name in exactmesh.__all__
        assert getattr(exactmesh, name).__module__.startswith("exactmesh.voronoi.")

    def test_every_error_is_found_there_as_well(self) -> None:
        assert set(exactmesh.errors.__all__) <= set(exactmesh.__all__)

    def test_control_a_name_that_is_missing_is_noticed(self) -> None:
        assert not set(exactmesh.errors.__all__) <= set(exactmesh.__all__) - {"BoundError"}


class TestVerify:
    """Law: ``exactmesh.verify`` is the function, however the room of that name is imported, and its names are found by
    every spelling."""

    def test_import_of_the_room(self) -> None:
        found: dict[str, object] = {}
        exec("import exactmesh.verify\nimport exactmesh.verify as room\nfunction = exactmesh.verify", found)
        assert found["room"] is found["function"] is exactmesh.verify
        assert inspect.isfunction(exactmesh.verify)
        assert exactmesh.verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]).ok

    @pytest.mark.parametrize("name", sys.modules["exactmesh.verify"].__all__)
    def test_every_name_of_the_room(self, name: str) -> None:
        room = importlib.import_module("exactmesh.verify")
        assert getattr(exactmesh.verify, name) is getattr(room, name)

    def test_control_the_room_is_no_function(self) -> None:
        """The module itself, which only importlib and ``from exactmesh.verify import`` see."""
        room: object = importlib.import_module("exactmesh.verify")
        assert not inspect.isfunction(room)
        assert hasattr(room, "adjacency")
        assert not hasattr(exactmesh.verify, "adjacency")

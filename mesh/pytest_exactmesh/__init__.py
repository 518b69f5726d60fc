"""The pytest plugin of exactmesh: fixtures for assertions about meshes, and a suite for anybody's mesher.

It is loaded in every run of pytest where exactmesh is installed. So it lives outside of the package and imports nothing
of it before something of it is asked for.
"""

from __future__ import annotations

import functools
import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from exactmesh.conformance import Conformance

__all__ = [
    "assert_admissible",
    "assert_constrained_delaunay",
    "assert_delaunay",
    "mesher",
    "mesher_conformance",
    "pytest_addoption",
    "pytest_configure",
    "pytest_generate_tests",
]

_SUITE = "exactmesh.conformance"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options that name a mesher."""
    group = parser.getgroup("exactmesh", "conformance of a mesher")
    group.addoption(
        "--mesher",
        metavar="MODULE:FUNCTION",
        help="put this mesher, or a known one such as scipy, to the test: one test for each law",
    )
    group.addoption(
        "--mesher-kind",
        choices=("points", "segments", "domain"),
        default="points",
        help="what it takes and makes: points -> their Delaunay triangulation (default), (points, segments) -> the "
        "constrained one of their hull, or of the domain that the segments enclose",
    )
    group.addoption("--mesher-examples", type=int, default=100, help="inputs of each family (default: 100)")
    group.addoption("--mesher-deadline", type=float, default=120.0, help="seconds for all laws (default: 120)")
    group.addoption(
        "--mesher-allow-rounding", action="store_true", help="let laws pass that are broken by rounding only"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Collect the suite, if there is a mesher to test and the suite is not named already."""
    if config.getoption("--mesher") is None:
        return
    here = str(config.invocation_params.dir)
    if here not in sys.path:
        sys.path.insert(0, here)  # as python -m pytest has it, and the command exactmesh conformance
    package = importlib.util.find_spec(_SUITE)
    assert package is not None
    assert package.origin is not None
    suite = str(Path(package.origin).with_name("test_mesher.py"))
    if not any(_SUITE in argument or suite in argument for argument in config.args):
        config.args.append(suite)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each law of the mesher's kind."""
    if "mesher_law" in metafunc.fixturenames:
        from exactmesh.conformance import LAWS, Task

        laws = LAWS[Task(metafunc.config.getoption("--mesher-kind"))]
        metafunc.parametrize("mesher_law", [str(law) for law in laws])


@pytest.fixture(scope="session")
def mesher(request: pytest.FixtureRequest) -> Callable[..., object]:
    """The mesher that ``--mesher`` names, to be called in this process."""
    from exactmesh.conformance import Task, loaded

    return loaded(_name(request.config), Task(request.config.getoption("--mesher-kind")))


@pytest.fixture(scope="session")
def mesher_conformance(request: pytest.FixtureRequest) -> Conformance:
    """The verdicts on the mesher that ``--mesher`` names; it is put to the test once."""
    from exactmesh.conformance import check

    option = request.config.getoption
    return check(
        _name(request.config),
        kind=option("--mesher-kind"),
        max_examples=option("--mesher-examples"),
        deadline=option("--mesher-deadline"),
    )


def _name(config: pytest.Config) -> str:
    name = config.getoption("--mesher")
    if name is None:
        pytest.skip("which mesher? --mesher=module:function names it")
    return str(name)


@pytest.fixture
def assert_delaunay() -> Callable[..., None]:
    """:func:`exactmesh.conformance.assert_delaunay`."""
    return _assertion("assert_delaunay")


@pytest.fixture
def assert_constrained_delaunay() -> Callable[..., None]:
    """:func:`exactmesh.conformance.assert_constrained_delaunay`."""
    return _assertion("assert_constrained_delaunay")


@pytest.fixture
def assert_admissible() -> Callable[..., None]:
    """:func:`exactmesh.conformance.assert_admissible`."""
    return _assertion("assert_admissible")


@functools.cache
def _assertion(name: str) -> Callable[..., None]:
    from exactmesh.conformance import assertions

    found: Callable[..., None] = getattr(assertions, name)
    return found

"""Inputs on which meshers are known to fail: published ones, and some that were found here. All doubles in full."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.conformance.given import Given, IndexArray
from exactmesh.conformance.laws import Law, Outcome, Task
from exactmesh.errors import ChoiceError
from exactmesh.verify import Property

__all__ = ["CORPUS", "Case", "case_named"]


@dataclass(frozen=True, slots=True)
class Case:
    """One input, and who was seen to fail on it.

    Attributes:
        name: "1" to "10"; "7/5" is the bundle of the seed 5.
        title: what it is.
        task: what is to be made of it.
        make: makes it.
        failing: for each known mesher that fails, a law that it breaks, and how.
    """

    name: str
    title: str
    task: Task
    make: Callable[[], Given]
    failing: Mapping[str, tuple[Law, Outcome]] = field(default_factory=dict)

    @property
    def source(self) -> str:
        """What ``--input`` takes."""
        return f"corpus:{self.name}"


_GEOS_1286 = (
    (-1.3890020986020145e-10, 4.860466764224401),
    (-1.3889120965221466e-10, -5.531838081766228),
    (-1.388852095135568e-10, -12.460041312426647),
    (0.9999999999166641, -3.799787274101123),
)
_SIX = (
    (-0.6616708319446925, 0.043023726210314694),
    (1.3283374986113592, 0.242690559503971),
    (-0.029024421143340307, -0.7891819431100835),
    (0.6956910878100069, 1.074896228824369),
    (0.9996093546131575, -0.6028480693195775),
    (-0.3329426879464908, 0.888562355033863),
)
_THREE_SEGMENTS = ((0, 1), (2, 3), (4, 5))


def _random(seed: int, n: int, offset: float, scale: float = 1.0) -> Callable[[], Given]:
    return lambda: Given.of(np.random.default_rng(seed).random((n, 2)) * scale + offset)


def _tilted_grid() -> Given:
    """Column by column, each coordinate by two products and one sum."""
    turn = np.deg2rad(302.328)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(10.0), np.arange(10.0), indexing="ij"))
    cos, sin = np.cos(turn), np.sin(turn)
    return Given.of(np.stack([cos * x - sin * y, sin * x + cos * y], axis=1))


def _circle() -> Given:
    angles = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    return Given.of(np.stack([np.cos(angles), np.sin(angles)], axis=1))


def _bundle(seed: int) -> Given:
    """Three to seven segments through nearly one point."""
    rng = np.random.default_rng(seed)
    count, centre = int(rng.integers(3, 8)), rng.random(2)
    ends: list[FloatArray] = []
    for _ in range(count):
        angle = rng.random() * np.pi
        direction = np.array([np.cos(angle), np.sin(angle)])
        ends += [centre - rng.random() * direction, centre + rng.random() * direction]
    return Given.of(np.array(ends), _pairs(count))


def _pairs(count: int) -> IndexArray:
    return np.arange(2 * count, dtype=np.int64).reshape(-1, 2)


def _slanted() -> Given:
    return Given.of([(0.0, 0.0), (1.0, 0.1), (0.7, 1.3)], [(0, 1), (1, 2), (2, 0)])


def _wrong(law: Law) -> tuple[Law, Outcome]:
    return law, Outcome.WRONG


#: The cases by name.
CORPUS: dict[str, Case] = {
    case.name: case
    for case in (
        Case(
            "1",
            "GEOS issue 1286: four points, nearly on a line",
            Task.POINTS,
            lambda: Given.of(_GEOS_1286),
            {"geos": _wrong(Property.DELAUNAY)},
        ),
        Case(
            "2",
            "15 points near (10^6, 10^6)",
            Task.POINTS,
            _random(17, 15, 1e6),
            {"scipy": _wrong(Property.ADMISSIBLE)},
        ),
        Case(
            "3",
            "300 points near (10^6, 10^6)",
            Task.POINTS,
            _random(0, 300, 1e6),
            {"scipy": _wrong(Property.ALL_POINTS_USED)},
        ),
        Case(
            "4",
            "five points near (10^5, 10^5)",
            Task.POINTS,
            _random(15, 5, 1e5),
            {"scipy": _wrong(Property.DELAUNAY)},
        ),
        Case(
            "5",
            "a 10 x 10 grid turned by 302.328 degrees",
            Task.POINTS,
            _tilted_grid,
            {
                "scipy": _wrong(Property.COVERS_HULL),
                "matplotlib": _wrong(Property.COVERS_HULL),
                "geos": (Property.DELAUNAY, Outcome.ROUNDING),
            },
        ),
        Case(
            "6",
            "200 points on a circle",
            Task.POINTS,
            _circle,
            dict.fromkeys(("scipy", "matplotlib", "geos"), _wrong(Property.DELAUNAY)),
        ),
        Case(
            "7",
            "three segments through nearly one point",
            Task.SEGMENTS,
            lambda: Given.of(_SIX, _THREE_SEGMENTS),
            dict.fromkeys(("triangle", "meshpy"), _wrong(Property.ORIENTATION)),
        ),
        Case("8", "a triangle with slanted sides, whose midpoints are off them", Task.DOMAIN, _slanted),
        Case(
            "9",
            "200,000 uniform points",
            Task.POINTS,
            _random(0, 200_000, 0.0),
            {"gmsh": _wrong(Property.COVERS_HULL)},
        ),
        Case(
            "10",
            "50 points in a box of 10^-4",
            Task.POINTS,
            _random(0, 50, 0.0, 1e-4),
            {"startinpy": _wrong(Property.ALL_POINTS_USED)},
        ),
    )
}
#: The seeds of the bundles "7/0", "7/1", ...
BUNDLES = range(150)


def case_named(name: str) -> Case:
    """Return a case: "1" to "10", or "7/seed".

    Raises:
        ChoiceError: there is none of that name.

    >>> from exactmesh.conformance import case_named
    >>> case_named("7/5").make().segments.shape
    (6, 2)
    """
    if name in CORPUS:
        return CORPUS[name]
    number, _, seed = name.partition("/")
    if number == "7" and seed.isdecimal():
        return Case(name, f"the bundle of seed {seed}", Task.SEGMENTS, lambda: _bundle(int(seed)))
    raise ChoiceError(f"there is no case {name!r}; choose from {', '.join(CORPUS)}, or 7/0, 7/1, ...")

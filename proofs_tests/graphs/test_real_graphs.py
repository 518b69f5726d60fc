"""Real graphs: states and counties of the United States, with shared borders, islands, and borders that disagree."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import groupby

import numpy as np
import numpy.typing as npt
import pytest
from bokeh_sampledata import us_counties, us_states
from proofs_tests import oracles
from proofs_tests.mesh import constrained_oracle

from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray
from exactmesh import PSLG, Carve, CrossingError, Triangulation, constrained_delaunay, verify
from exactmesh.crossings import arrange, find_crossings

Rings = list[FloatArray]


def rings_of(lons: npt.ArrayLike, lats: npt.ArrayLike) -> Rings:
    """The rings of a state or county: NaN comes between two."""
    points = np.stack([lons, lats], axis=1).astype(np.float64)
    parts = np.split(points, np.flatnonzero(np.isnan(points[:, 0])))
    return [part[~np.isnan(part[:, 0])] for part in parts if (~np.isnan(part[:, 0])).any()]


def counties() -> Iterator[tuple[str, Rings]]:
    ordered = sorted(us_counties.data.values(), key=lambda county: str(county["state"]))
    for state, members in groupby(ordered, key=lambda county: str(county["state"])):
        yield state, [ring for county in members for ring in rings_of(county["lons"], county["lats"])]


STATES = {name: rings_of(state["lons"], state["lats"]) for name, state in us_states.data.items()}
COUNTIES = dict(counties())

#: Counties of these states agree on their borders, to the last bit; islands, lakes and corners among them.
AGREEING = ["as", "ct", "dc", "hi", "mi", "mp", "ny", "sc", "ut"] if COMPILED else ["as", "ct", "dc", "mp"]

#: Of these some overlap, or leave gaps: the borders that they share are not the same numbers. Some even cross.
CROSSING, DISAGREEING = ["va", "pr"], ["va", "pr", "me"] if COMPILED else ["me"]


def twice_area(points: FloatArray, loops: list[list[int]]) -> Fraction:
    exact = oracles.rationals(points.tolist())
    return sum((constrained_oracle.signed_area(exact, loop) for loop in loops), Fraction(0))


def shoelace(rings: Rings) -> Fraction:
    """Twice the area of rings that do not overlap."""
    return sum((abs(twice_area(ring, [list(range(len(ring)))])) for ring in rings), Fraction(0))


def check(mesh: Triangulation, rule: Carve) -> None:
    """Verified: the constrained Delaunay triangulation of the domain; and the boundary has its area, exactly."""
    assert mesh.domain is not None
    assert mesh.domain.rule is rule
    report = verify(mesh.points, mesh.triangles, domain=mesh.domain)
    assert report.ok, report.violations
    triangles = [t.tolist() for t in mesh.triangles]
    assert twice_area(mesh.points, [loop.tolist() for loop in mesh.boundary()]) == twice_area(mesh.points, triangles)


def cycle(points: list[list[float]]) -> tuple[tuple[float, ...], ...]:
    """A ring from its smallest corner on, in the direction that begins with the smaller neighbor."""
    rows = [tuple(p) for p in (points[:-1] if points[0] == points[-1] else points)]
    first = rows.index(min(rows))
    rows = rows[first:] + rows[:first]
    return tuple(min(rows, [rows[0], *rows[:0:-1]]))


@pytest.mark.obligation(
    "M5",
    "the states, islands and all, are triangulated: verified, with their exact area and rings",
    method="named cases",
    control_in="TestCounties",
)
@pytest.mark.parametrize("name", sorted(STATES) if COMPILED else ["CT", "KY", "RI"])
class TestStates:
    """Each state by itself: verified, its area is that of its rings to the last bit, and its boundary is its rings."""

    def test_state(self, name: str) -> None:
        rings = STATES[name]
        mesh = constrained_delaunay(PSLG.from_rings(rings))
        check(mesh, Carve.EVEN_ODD)
        loops = [loop.tolist() for loop in mesh.boundary()]
        assert twice_area(mesh.points, loops) == shoelace(rings)
        if not len(mesh.pslg.duplicates if mesh.pslg else ()):
            assert {cycle(mesh.points[loop].tolist()) for loop in loops} == {cycle(ring.tolist()) for ring in rings}


@pytest.mark.obligation(
    "M5",
    "counties with shared borders: one edge for two segments, the area of all to the last bit",
    method="named cases",
)
@pytest.mark.parametrize("name", AGREEING)
class TestCounties:
    """All counties of a state whose borders agree, as one graph of rings with points of their own: verified; the area
    is the sum of theirs, exactly; a border that two share is one edge, of two segments."""

    def test_counties(self, name: str) -> None:
        rings = COUNTIES[name]
        pslg = PSLG.from_rings(rings)
        assert len(pslg.points) == len(pslg.segments) == sum(len({tuple(p) for p in ring.tolist()}) for ring in rings)
        mesh = constrained_delaunay(pslg, carve=Carve.SEEDS)
        check(mesh, Carve.SEEDS)
        assert twice_area(mesh.points, [loop.tolist() for loop in mesh.boundary()]) == shoelace(rings)
        assert len(mesh.segment_incidence) >= len(pslg.segments)
        assert set(np.bincount(mesh.segment_incidence[:, 0])) <= {1, 2}

    def test_control_a_county_moved(self, name: str) -> None:
        """With one county moved by half a unit in the last place of its size, areas do not add up or borders cross."""
        rings = COUNTIES[name]
        if len(rings) < 3 or name in ("as", "hi", "mp"):  # islands may move
            return
        moved = [rings[0] + [0.015625, 0.0], *rings[1:]]
        try:
            mesh = constrained_delaunay(PSLG.from_rings(moved), carve=Carve.SEEDS)
        except CrossingError:
            return
        assert twice_area(mesh.points, [loop.tolist() for loop in mesh.boundary()]) != shoelace(moved)


@pytest.mark.obligation(
    "M5",
    "counties whose borders disagree are triangulated, or the crossings named and split",
    method="named cases",
    control_in="TestCounties",
)
@pytest.mark.parametrize("name", DISAGREEING)
class TestDisagreement:
    """Counties whose borders cross are refused with the pairs that do, and split on demand; where they only overlap,
    the parity of rings says what is covered once. All of it is verified."""

    def test_refused_or_verified(self, name: str) -> None:
        pslg = PSLG.from_rings(COUNTIES[name])
        if name in CROSSING:
            with pytest.raises(CrossingError) as caught:
                constrained_delaunay(pslg)
            exact = oracles.rationals(pslg.points.tolist())
            for i, j in caught.value.pairs.tolist():
                assert constrained_oracle.crosses(exact, pslg.segments[i].tolist(), pslg.segments[j].tolist())
        union = constrained_delaunay(pslg, carve=Carve.SEEDS, crossings="split")
        once = constrained_delaunay(pslg, crossings="split")
        check(union, Carve.SEEDS)
        check(once, Carve.EVEN_ODD)
        areas = [twice_area(m.points, [loop.tolist() for loop in m.boundary()]) for m in (once, union)]
        assert areas[0] < areas[1] < shoelace(COUNTIES[name])


@pytest.mark.obligation(
    "M5", "all states as one graph, crossings split", method="named cases", control_in="TestCounties"
)
class TestOneGraph:
    """All states as one graph of rings: borders are shared, and at one place cross; split, it is verified."""

    def test_states(self) -> None:
        rings = [
            ring for name, state in STATES.items() if COMPILED or name in ("NY", "CT", "RI", "MA") for ring in state
        ]
        pslg = PSLG.from_rings(rings)
        mesh = constrained_delaunay(pslg, carve=Carve.SEEDS, crossings="split")
        check(mesh, Carve.SEEDS)
        assert len(mesh.segments) < len(pslg.segments)
        for i in range(0, len(pslg.segments), 10):
            vertices = mesh.chain(i)
            assert len(vertices) >= 1
            ends = pslg.segments[i]
            assert [vertices[0, 0], vertices[-1, 1]] == mesh.representative[ends].tolist()


@pytest.mark.once
@pytest.mark.obligation(
    "M5",
    "all counties as one graph, borders shared, crossings split, by either rule",
    method="named cases",
    control_in="TestCounties",
)
class TestAllCounties:
    """All counties as one graph of rings (compiled; else those of Virginia), triangulated and verified."""

    @pytest.mark.parametrize("rule", Carve)
    def test_verified(self, rule: Carve) -> None:
        pslg = PSLG.from_rings([ring for name, rings in COUNTIES.items() if COMPILED or name == "va" for ring in rings])
        mesh = constrained_delaunay(pslg, carve=rule, crossings="split")
        assert mesh.domain is not None
        assert mesh.domain.rule is rule
        report = verify(mesh.points, mesh.triangles, domain=mesh.domain)
        assert report.ok, report.violations
        lost = verify(mesh.points, mesh.triangles[1:], domain=mesh.domain)  # the control
        assert not lost.ok


@pytest.mark.obligation(
    "ARR6",
    "the counties: borders that cross are noded, and all but a few points stay bit for bit",
    method="named cases",
    control_in="proofs_tests/graphs/test_crossings.py::TestArrangement",
)
class TestArrangedCounties:
    """All counties as one graph of rings (compiled; else those of Virginia): borders that nearly coincide creep when
    they are noded, and are snapped; all else stays where it was, and what comes out is noded."""

    def test_counties(self) -> None:
        pslg = PSLG.from_rings([ring for name, rings in COUNTIES.items() if COMPILED or name == "va" for ring in rings])
        assert len(find_crossings(pslg.points, pslg.segments)) > 0
        arranged = arrange(pslg)
        n = len(pslg.points)
        assert np.count_nonzero((arranged.pslg.points[:n] != pslg.points).any(axis=1)) < 20
        assert len(find_crossings(arranged.pslg.points, arranged.pslg.segments)) == 0
        limit = (Fraction(arranged.grid[0]) ** 2 + Fraction(arranged.grid[1]) ** 2) / 4
        farthest = arranged.max_distance_squared
        assert 0 < Fraction(int(farthest.numerator), int(farthest.denominator)) <= limit
        assert arrange(arranged.pslg).pslg == arranged.pslg

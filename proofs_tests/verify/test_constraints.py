"""V1: what a mesh is checked against is read as it is given, and everything else is refused by name."""

from itertools import product
from random import Random
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt
import pytest

from exactkernel import BoundError, NonFiniteError, ShapeError
from exactmesh.errors import ChoiceError, Fault, FaultKind, PSLGError
from exactmesh.verify.domain import Constraints, Domain, Outline, constraints_of, require_even_ends

POINTS = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 0.0)]
SEGMENTS = [(0, 1), (1, 2), (2, 0)]
INF = float("inf")


def domain_of(**changed: object) -> Domain:
    whole = {"points": POINTS, "segments": SEGMENTS, "holes": [], "regions": [], "rule": "seeds"}
    return SimpleNamespace(**{name: value for name, value in (whole | changed).items() if value is not None})


def read(labels: npt.ArrayLike | None = None, m: int = 3, within: float | None = None) -> Constraints:
    return constraints_of(None, domain_of(), labels, m, within)


def outline_of(**changed: object) -> Outline:
    outline = constraints_of(None, domain_of(**changed), None, 0).outline
    assert outline is not None
    return outline


@pytest.mark.obligation("V1", "constraints are read as they are given, or refused by name", method="named cases")
class TestConstraints:
    """Nothing that is given is changed; what is no number, no index or no rule is refused, and named."""

    def test_any(self) -> None:
        """Segments are there if they are the mesh's own or the domain's, be they none."""
        for segments, domain in product((None, [], SEGMENTS), (None, domain_of())):
            found = constraints_of(segments, domain, None, 0)
            assert found.any is (segments is not None or domain is not None)
            assert (found.segments is None, found.outline is None) == (segments is None, domain is None)
            assert (found.labels, found.within) == (None, None)

    def test_segments(self) -> None:
        """Those of the mesh are taken unchecked."""
        found = constraints_of([(0, 7), (-3, 3)], None, None, 0)
        assert found.segments is not None
        assert found.segments.tolist() == [[0, 7], [-3, 3]]

    @pytest.mark.parametrize(
        "labels",
        [[1, 2, 3], [1.5, -0.0, INF], [True, False, True], [[1], [2], [3]], np.array([1, 2, 3], dtype=np.uint8),
         [2**53, -(2**53), 2**60]],
    )  # fmt: skip
    def test_labels(self, labels: npt.ArrayLike) -> None:
        found = read(labels).labels
        assert found is not None
        assert found.dtype == np.float64
        assert found.tolist() == np.asarray(labels).ravel().tolist()

    @pytest.mark.parametrize(
        ("labels", "message"),
        [
            ([1, 2], r"labels has shape \(2,\) and dtype int64; expected 3 numbers"),
            ([[1, 2, 3]], r"labels has shape \(1, 3\)"),
            ([[1, 2], [3, 4], [5, 6]], r"labels has shape \(3, 2\)"),
            (["a", "b", "c"], r"labels has shape \(3,\) and dtype <U1; expected 3 numbers"),
            ([1j, 2, 3], "dtype complex128"),
            ([2**53 + 1, 0, 0], r"labels beyond 2\^53 would be rounded to doubles"),
            (np.array([0, 0, 2**53 + 1], dtype=np.uint64), r"labels beyond 2\^53 would be rounded to doubles"),
        ],
    )
    def test_control_labels(self, labels: npt.ArrayLike, message: str) -> None:
        """Not one a triangle, no numbers, or no doubles."""
        with pytest.raises(ShapeError, match=message):
            read(labels)

    @pytest.mark.parametrize("within", [0, 0.0, 3, 0.25, np.int32(2), np.float32(0.5), INF])
    def test_within(self, within: float) -> None:
        found = read(within=within).within
        assert found == within
        assert type(found) is float

    @pytest.mark.parametrize("within", [-1, -1e-300, float("nan"), "1", True, False, [1.0], np.array([1.0]), 1j])
    def test_control_within(self, within: float) -> None:
        """No distance."""
        with pytest.raises(BoundError, match="within is a distance, 0 or more, not "):
            read(within=within)

    def test_control_within_alone(self) -> None:
        """A distance too large, and one without a domain to be near to."""
        with pytest.raises(BoundError, match="within is a distance that is a double, not 1000"):
            read(within=10**400)
        with pytest.raises(ChoiceError, match="give domain="):
            constraints_of(SEGMENTS, None, None, 0, 1.0)


@pytest.mark.obligation("V1", "a domain is read as it is given, or refused by name", method="named cases")
class TestOutlines:
    """Points, segments, holes, regions and the rule come through; each of them can be refused."""

    def test_read(self) -> None:
        found = outline_of(holes=[(1.0, 2.0)])
        assert found.points.tolist() == [list(p) for p in POINTS]
        assert found.segments.tolist() == [list(s) for s in SEGMENTS]
        assert found.segments.dtype == np.intp
        assert found.holes.tolist() == [[1.0, 2.0]]
        assert (found.regions.shape, found.attributes.shape, found.areas.shape) == ((0, 2), (0,), (0,))
        assert not found.even_odd
        assert outline_of(rule="even-odd").even_odd

    @pytest.mark.parametrize(
        ("regions", "areas"),
        [
            ([(1, 2, 3)], [INF]),
            ([(1, 2, 3, 4), (5, 6, 7, 0), (8, 9, 10, -1), (11, 12, 13, 1e-300)], [4, INF, INF, 1e-300]),
            ([(1, 2, 3, 0.5, 99), (4, 5, 6, INF, 99)], [0.5, INF]),
        ],
    )
    def test_regions(self, regions: list[tuple[float, ...]], areas: list[float]) -> None:
        """x, y, the attribute, and an area that counts if it is positive."""
        found = outline_of(regions=regions)
        assert found.regions.tolist() == [list(row[:2]) for row in regions]
        assert found.attributes.tolist() == [row[2] for row in regions]
        assert found.areas.tolist() == areas

    @pytest.mark.parametrize("name", ["points", "segments", "holes", "regions", "rule"])
    def test_control_missing(self, name: str) -> None:
        """Each part of a domain in turn is missing."""
        with pytest.raises(ShapeError, match=r"domain: expected a PSLG, not a SimpleNamespace: make one with PSLG\("):
            outline_of(**{name: None})

    @pytest.mark.parametrize(
        ("domain", "remedy"),
        [
            (3, r"not a int: make one with PSLG\(points, segments\)"),
            (SimpleNamespace(domain=1), "give its .domain"),
            (SimpleNamespace(geom_type="Polygon"), "make one with PSLG.from_shapely"),
            ({"vertices": 1, "segments": 2}, r"make one with PSLG\(domain\['vertices'\], domain\['segments'\]\)$"),
            ({"vertices": 1, "holes": 2}, r"domain\['segments'\], holes=domain\['holes'\]\)$"),
            (
                {"vertices": 1, "holes": 2, "regions": 3},
                r"domain\['segments'\], holes=domain\['holes'\], regions=domain\['regions'\]\)$",
            ),
            ({"type": "Polygon"}, "make one with PSLG.from_geojson"),
            ({"vertices": 1, "type": "Polygon"}, r"PSLG\(domain\['vertices'\]"),
            ({"kind": 1}, r"not a dict: make one with PSLG\(points, segments\)"),
            (["vertices", "type"], r"not a list: make one with PSLG\(points, segments\)"),
        ],
    )
    def test_control_something_else(self, domain: Domain, remedy: str) -> None:
        """Something else than a domain: the message tells how to make one."""
        with pytest.raises(ShapeError, match=remedy):
            constraints_of(None, domain, None, 0)

    @pytest.mark.parametrize(
        ("changed", "error", "message"),
        [
            ({"rule": "odd"}, ChoiceError, "'odd' is no rule for a domain; choose from seeds, even-odd"),
            ({"points": [(0.0, INF)]}, NonFiniteError, "domain.points"),
            ({"points": [1.0, 2.0]}, ShapeError, "domain.points"),
            ({"segments": [(0, 1, 2)]}, ShapeError, "domain.segments"),
            ({"holes": [(1.0, 2.0, 3.0)]}, ShapeError, "domain.holes"),
            ({"regions": [(1.0, 2.0)]}, ShapeError, r"domain.regions has shape \(1, 2\); expected \(r, 3\) or more"),
            ({"regions": [1.0, 2.0, 3.0]}, ShapeError, r"domain.regions has shape \(3,\)"),
            ({"regions": [[[1.0, 2.0, 3.0]]]}, ShapeError, "domain.regions has shape"),
            ({"regions": [(INF, 2.0, 3.0)]}, NonFiniteError, "domain.regions"),
        ],
    )
    def test_control_refused(self, changed: dict[str, object], error: type[ValueError], message: str) -> None:
        """One part of a domain is something else."""
        with pytest.raises(error, match=message):
            outline_of(**changed)

    def test_faults(self) -> None:
        """Every segment without an end, and then every one without a length, at whatever index."""
        segments = [(0, 4), (0, 1), (1, 3), (-1, 0), (2, 2), (3, 0), (4, 4), (3, 2), (0, 0)]
        with pytest.raises(PSLGError) as caught:
            outline_of(segments=segments)
        nowhere = "segment #{} {} has an end that does not exist"
        assert caught.value.faults == (
            *(Fault(FaultKind.BAD_INDEX, (i,), nowhere.format(i, segments[i])) for i in (0, 3, 6)),
            *(Fault(FaultKind.ZERO_LENGTH, (i,), f"segment #{i} has no length") for i in (2, 4, 8)),
        )

    def test_ends(self) -> None:
        """Any index of a point will do: the first, the last; ends that agree in x or in y alone have a length."""
        assert outline_of(segments=[(0, 3), (3, 0), (0, 2), (1, 0)]).segments.tolist() == [
            [0, 3],
            [3, 0],
            [0, 2],
            [1, 0],
        ]


@pytest.mark.obligation("V1", "parity is refused just where an odd number of ends meets", method="property-based")
class TestEvenEnds:
    """An error names the first point of every position in which an odd number of segments ends; without any, none."""

    @pytest.mark.parametrize("seed", range(8))
    def test_counts(self, seed: int) -> None:
        random, seen = Random(seed), set()
        for _ in range(30):
            n = random.randrange(2, 7)
            places = [(float(random.randrange(3)), 7.5) for _ in range(n)]
            numbers = sorted({*places}, key=lambda p: (p[0] * 7 + seed) % 5)
            position = np.array([numbers.index(p) for p in places], dtype=np.intp)
            segments = [(random.randrange(n), random.randrange(n)) for _ in range(random.randrange(1, 4))]
            segments += random.choice(([], [(w, v) for v, w in segments]))
            ends = [places[v] for segment in segments for v in segment]
            odd = {places.index(p) for p in places if ends.count(p) % 2}
            outline = Outline(
                np.array(places), np.array(segments, dtype=np.intp), *(np.empty((0, 2)),) * 2, *(np.empty(0),) * 2, True
            )
            seen.add(len(odd))
            if not odd:
                require_even_ends(outline, position)
                continue
            with pytest.raises(PSLGError) as caught:
                require_even_ends(outline, position)
            assert {fault.kind for fault in caught.value.faults} == {FaultKind.INCONSISTENT_PARITY}
            told = {fault.indices: fault.sentence for fault in caught.value.faults}
            name = "an odd number of segments ends in point #{} ({!r}, 7.5)"
            assert told == {(v,): name.format(v, places[v][0]) for v in odd}
            assert len(caught.value.faults) == len(odd)
        assert {0, 2} <= seen

    def test_control_the_ring_closed(self) -> None:
        """A segment of a ring left out: with it there is nothing to refuse."""
        places, ring = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]), np.array([(0, 1), (1, 2), (2, 0)], dtype=np.intp)
        for segments in (ring, ring[:2]):
            outline = Outline(places, segments, *(np.empty((0, 2)),) * 2, *(np.empty(0),) * 2, True)
            if len(segments) == 3:
                require_even_ends(outline, np.arange(3))
                continue
            with pytest.raises(PSLGError):
                require_even_ends(outline, np.arange(3))

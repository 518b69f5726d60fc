"""V2 for what is asked of a mesh: which properties have a meaning for what was given, and what is claimed."""

from itertools import combinations, product

import numpy as np
import pytest

from exactkernel import ShapeError
from exactmesh import PSLG, adapters
from exactmesh.adapters import GivenMesh
from exactmesh.verify import ADMISSIBLE_MESH, ChoiceError, Orientation, Property, verify
from exactmesh.verify.given import Extras, numbers_of, of_mesh
from exactmesh.verify.properties import asked_properties, claimed_properties, decided_properties, default_claims

SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
BOUNDS = (Property.MIN_ANGLE, Property.MAX_ANGLE, Property.MAX_AREA, Property.MAX_LENGTH, Property.VORONOI_DUAL)
ON_LINES = {Property.SEGMENTS_PRESENT, Property.CONSTRAINED_DELAUNAY}
ON_DOMAINS = {Property.COVERS_DOMAIN, Property.DOMAIN_POINTS, Property.NO_NEW_POINTS, Property.REGION_AREAS}
OF_TRIANGLES = {
    *(Property.DELAUNAY, Property.CONSTRAINED_DELAUNAY, Property.WEAKLY_ACUTE, Property.ACUTE, Property.GABRIEL),
    *(Property.CIRCUMCENTRES_INSIDE, Property.REGION_AREAS, *BOUNDS),
}
ON_CLAIM = {Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE, Property.REGION_AREAS}


@pytest.mark.obligation(
    "V1", "a property is asked iff what was given has a meaning for it", method="exhaustive", control_in="mutants"
)
class TestAsked:
    """With and without segments, a domain, labels, quadrilaterals, and all sets of bounds."""

    @pytest.mark.parametrize(("segments", "domain", "labels", "quads"), [*product((False, True), repeat=4)])
    def test_all(self, segments: bool, domain: bool, labels: bool, quads: bool) -> None:
        for count in range(len(BOUNDS) + 1):
            for bounds in combinations(BOUNDS, count):
                if quads and bounds:
                    with pytest.raises(ChoiceError, match=r"=.* is about triangles, and there are quadrilaterals"):
                        asked_properties(segments=segments, domain=domain, labels=labels, bounds=bounds, quads=quads)
                    continue
                missing = {*BOUNDS} - {*bounds}
                missing |= set() if segments or domain else ON_LINES
                missing |= set() if domain else ON_DOMAINS
                missing |= set() if labels and (segments or domain) else {Property.REGIONS}
                missing |= OF_TRIANGLES if quads else {Property.CONVEX}
                found = asked_properties(segments=segments, domain=domain, labels=labels, bounds=bounds, quads=quads)
                assert found == tuple(property_ for property_ in Property if property_ not in missing)

    def test_decided(self) -> None:
        """Some only if they are claimed."""
        everything = tuple(Property)
        assert {*everything} - {*decided_properties(everything, ())} == ON_CLAIM
        for claim in ON_CLAIM:
            assert {*everything} - {*decided_properties(everything, (claim,))} == ON_CLAIM - {claim}
        assert decided_properties((Property.FINITE,), everything) == (Property.FINITE,)


@pytest.mark.obligation(
    "V1", "claims are those that were named, and every bound", method="named cases", control_in="mutants"
)
class TestClaims:
    """In the order of the definitions, however they are named; by default what is usual for what was given."""

    def test_named(self) -> None:
        asked = asked_properties(segments=False, domain=False, labels=False, bounds=(Property.MAX_AREA,))
        for claims in (["acute", "covers-hull"], {Property.COVERS_HULL, "acute"}, iter(["covers_hull", "acute"])):
            found = claimed_properties(claims, asked)  # type: ignore[arg-type]  # whatever yields names
            assert found == (Property.COVERS_HULL, Property.ACUTE, Property.MAX_AREA)
        assert claimed_properties("acute", asked) == (Property.ACUTE, Property.MAX_AREA)

    def test_lines(self) -> None:
        """With segments the same as without, but for them; with a domain what covers it."""
        plain, lines, domain = (
            asked_properties(segments=segments, domain=domain, labels=False)
            for segments, domain in ((False, False), (True, False), (False, True))
        )
        usual = {*claimed_properties(None, plain)}
        assert usual == {*Property} & {*[*Property][: [*Property].index(Property.DELAUNAY) + 1]} - {Property.CONVEX}
        assert {*claimed_properties(None, lines)} == usual - {Property.DELAUNAY} | ON_LINES
        covering = {Property.COVERS_DOMAIN, Property.DOMAIN_POINTS}
        assert {*claimed_properties(None, domain)} == {*ADMISSIBLE_MESH} | ON_LINES | covering

    def test_usual(self) -> None:
        """Of quadrilaterals, and of meshes of finite elements, with whatever comes with them."""
        for domain, quads in product((False, True), repeat=2):
            asked = asked_properties(segments=False, domain=domain, labels=False, quads=quads)
            more = [Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN, Property.DOMAIN_POINTS] if domain else []
            expected = {*ADMISSIBLE_MESH, *more, *([Property.CONVEX] if quads else [])}
            if quads:
                assert {*default_claims(asked)} == expected
            assert {*default_claims(asked, ADMISSIBLE_MESH)} == expected
            assert {*default_claims(asked, (Property.ACUTE,))} == expected - {*ADMISSIBLE_MESH} | {Property.ACUTE}

    @pytest.mark.parametrize(
        ("claims", "quads", "said"),
        [
            (["convex"], False, "convex cannot be claimed without quadrilaterals"),
            (["acute"], True, "acute cannot be claimed of quadrilaterals"),
            (["max-area"], True, "max_area cannot be claimed of quadrilaterals"),
            (["covers_domain"], True, "covers_domain cannot be claimed without a domain"),
            (["regions"], False, "regions cannot be claimed without labels, and segments or a domain"),
            (["finite", "neat"], False, "'neat' is no property; choose from finite, indices"),
            ([], False, "no claim"),
            (7, False, "claims=7 is no collection"),
        ],
    )
    def test_control_refused(self, claims: list[str], quads: bool, said: str) -> None:
        """Claims about what was not given."""
        asked = asked_properties(segments=False, domain=False, labels=False, quads=quads)
        with pytest.raises(ChoiceError, match=said):
            claimed_properties(claims, asked)


@pytest.mark.obligation("A1", "what is given goes before what a mesh brings along", method="exhaustive")
class TestGiven:
    """Segments, domain, labels and orientation: each from the call, or else from the mesh; but labels of a mesh belong
    to its own domain."""

    points, triangles = np.array(SQUARE), np.array(HALVES, dtype=np.int32)
    own, other = (PSLG(SQUARE, [(0, 1), (1, 2), (2, 3), (3, 0)], rule=rule) for rule in ("seeds", "even-odd"))

    @pytest.mark.parametrize("given", [*product((False, True), repeat=4)])
    def test_all(self, given: tuple[bool, ...], monkeypatch: pytest.MonkeyPatch) -> None:
        lines, labels, quads = np.array([(0, 1)], dtype=np.int32), np.zeros(2), np.empty((0, 4), dtype=np.int32)
        mesh = GivenMesh(
            self.points, self.triangles, quads, segments=lines, labels=labels, domain=self.own,
            orientation=Orientation.ANY, claims=ADMISSIBLE_MESH,
        )  # fmt: skip
        monkeypatch.setattr(adapters, "given_mesh", lambda thing: mesh if thing == "a mesh" else None)
        others = ([(1, 2)], self.other, [5, 6], "ccw")
        extras = Extras(*(thing if is_given else None for thing, is_given in zip(others, given, strict=True)))  # type: ignore[arg-type]  # one of each
        cells, found = of_mesh("a mesh", extras)
        assert cells == (self.points, self.triangles, quads)
        assert found.segments is (others[0] if given[0] else lines)
        assert found.domain is (others[1] if given[1] else self.own)
        assert found.labels is (others[2] if given[2] else None if given[1] else labels)
        assert found.orientation is (others[3] if given[3] else Orientation.ANY)
        assert found.usual == ADMISSIBLE_MESH

    def test_control_another_domain(self) -> None:
        """Labels that count the regions of a domain that is not the one given."""
        _, found = of_mesh((self.points, self.triangles), Extras(None, self.own, None, None))
        assert (found.domain, found.labels, found.segments) == (self.own, None, None)

    def test_numbers(self) -> None:
        """Numbers stay numbers, arrays arrays, all as doubles; what was not given is not there."""
        found = numbers_of(min_angle=20, max_angle=None, max_area=[1, 2], size=np.float32(0.5), within=np.inf)
        assert {name: type(value) for name, value in found.items()} == {
            "min_angle": float, "max_area": np.ndarray, "size": float, "within": float,
        }  # fmt: skip
        assert np.asarray(found["max_area"]).tolist() == [1.0, 2.0]
        assert (found["min_angle"], found["size"], found["within"]) == (20.0, 0.5, np.inf)


@pytest.mark.obligation("V1", "there is a label for each cell", method="named cases", control_in="mutants")
class TestLabels:
    """With m triangles and k quadrilaterals as many as m + k, and no other number."""

    @pytest.mark.parametrize(("m", "k"), [(2, 0), (0, 1), (1, 1)])
    def test_count(self, m: int, k: int) -> None:
        points = [*SQUARE, (4.0, 0.0), (4.0, 2.0)]
        triangles, quads = HALVES[: m if k == 0 else 0] + [(1, 4, 5)] * (m * k), [(0, 1, 2, 3)] * k
        for count in range(4):
            if count == m + k:
                assert verify(points, triangles, quads=quads, segments=[(0, 1)], labels=[1.0] * count) is not None
                continue
            with pytest.raises(ShapeError, match="labels"):
                verify(points, triangles, quads=quads, segments=[(0, 1)], labels=[1.0] * count)

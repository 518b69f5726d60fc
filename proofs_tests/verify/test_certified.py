"""V2 for certificates of everything that can be given: they hold again, and what is given otherwise is told."""

import json
import re
from itertools import product

import numpy as np
import pytest

from exactkernel import ShapeError
from exactmesh import PSLG
from exactmesh.errors import CertificateError
from exactmesh.verify import Report, check_certificate, read_certificate, verify

Place = tuple[float, float]
POINTS = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (4.0, 0.0), (4.0, 2.0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
RIGHT = [(1, 4, 5, 2)]
RINGS = [(0, 1), (1, 2), (2, 3), (3, 0)]
THINGS = {"segments": [(0, 1)], "domain": PSLG(POINTS[:4], RINGS), "labels": [1.0, 1.0]}
NOUNS = {"segments": "segments", "domain": "a domain", "labels": "labels"}


def turned(thing: object) -> object:
    """The same document, with the keys of all its objects in the opposite order."""
    if isinstance(thing, dict):
        return {key: turned(thing[key]) for key in reversed(thing)}
    return [turned(part) for part in thing] if isinstance(thing, list) else thing


@pytest.mark.obligation("V2", "a certificate holds again for what it was made of", method="named cases")
class TestAgain:
    """With bounds that are numbers and arrays mixed, with quadrilaterals and labels, with a domain of all sorts."""

    @pytest.mark.parametrize(
        ("area", "length", "angle"), [*product((None, 3.0, [2.0, 3.0]), (None, 4.0, [3.0, 4.0]), (None, 20.0))]
    )
    def test_bounds(
        self, area: float | list[float] | None, length: float | list[float] | None, angle: float | None
    ) -> None:
        text = verify(POINTS, HALVES, max_area=area, size=length, min_angle=angle).to_json()
        arrays = {name: bound for name, bound in (("max_area", area), ("size", length)) if isinstance(bound, list)}
        check = check_certificate(text, POINTS, HALVES, bounds=arrays, again=True)
        assert check.differences == ()
        assert isinstance(check.report, Report)
        for name in arrays:
            others = arrays | {name: [9.0, 9.0]}
            (difference,) = check_certificate(text, POINTS, HALVES, bounds=others).differences
            assert difference.startswith(f"{name} is another one: its sha256 is ")

    def test_quadrilaterals(self) -> None:
        labels = [1.0, 1.0, 2.0]
        text = verify(POINTS, HALVES, quads=RIGHT, segments=[(1, 2)], labels=labels).to_json()
        given = {"quads": RIGHT, "segments": [(1, 2)], "labels": labels}
        assert check_certificate(text, POINTS, HALVES, again=True, **given).differences == ()  # type: ignore[arg-type]  # by name
        given["labels"] = [1.0, 2.0, 2.0]
        (difference,) = check_certificate(text, POINTS, HALVES, again=True, **given).differences  # type: ignore[arg-type]  # by name
        assert difference.startswith("the labels are others: their sha256 is ")
        turned_quad = [(4, 5, 2, 1)]
        text = verify(POINTS, quads=RIGHT).to_json()
        assert check_certificate(text, POINTS, quads=RIGHT, again=True).differences == ()
        assert not check_certificate(text, POINTS, quads=turned_quad)

    @pytest.mark.parametrize("rule", ["seeds", "even-odd"])
    @pytest.mark.parametrize("regions", [[], [(1.0, 0.5, 7.0)], [(1.0, 0.5, 7.0, 1.5), (0.5, 1.5, 7.0, 0.0)]])
    def test_domains(self, rule: str, regions: list[tuple[float, ...]]) -> None:
        domain = PSLG(POINTS[:4], RINGS, regions=regions, rule=rule)
        claims = ["admissible", "covers_domain", *(["region_areas"] if regions else [])]
        report = verify(POINTS[:4], HALVES, domain=domain, claims=claims, within=0.5, orientation="any")
        check = check_certificate(report.to_json(), POINTS[:4], HALVES, domain=domain, again=True)
        assert check.differences == ()
        assert check.report == report

    def test_the_order_of_keys(self) -> None:
        """A program that read it and wrote it again may have sorted them otherwise."""
        kite = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]
        document = json.loads(verify(kite, HALVES).to_json())
        assert json.dumps(turned(document)) != json.dumps(document)
        assert check_certificate(json.dumps(turned(document)), kite, HALVES, again=True).differences == ()

    @pytest.mark.parametrize(
        "array", [["a"], [object()], "x", [[1.0], [1.0, 2.0]]], ids=["a word", "an object", "a string", "ragged"]
    )
    def test_control_no_numbers(self, array: object) -> None:
        """Bounds that no array of numbers can be made of."""
        text = verify(POINTS, HALVES, max_area=[2.0, 3.0]).to_json()
        with pytest.raises(ShapeError, match=re.escape("bounds['max_area'] is no array of numbers")):
            check_certificate(text, POINTS, HALVES, bounds={"max_area": array})  # type: ignore[dict-item]  # on purpose


@pytest.mark.obligation("V2", "what a certificate is not about is told by name", method="exhaustive")
class TestOtherThings:
    """Segments, a domain, labels, each given or not, to a certificate with or without it: no difference is found
    where all agree, and an error names the first that is too much or missing."""

    @pytest.mark.parametrize("inside", [*product((False, True), repeat=3)])
    def test_all(self, inside: tuple[bool, ...]) -> None:
        def given(chosen: tuple[bool, ...]) -> dict[str, object]:
            return {name: thing for (name, thing), there in zip(THINGS.items(), chosen, strict=True) if there}

        read = read_certificate(verify(POINTS[:4], HALVES, claims=["admissible"], **given(inside)).to_json())  # type: ignore[call-overload]  # by name
        for chosen in product((False, True), repeat=3):
            named = given(chosen)
            wrong = next((i for i in range(3) if inside[i] != chosen[i]), None)
            if wrong is None:
                assert check_certificate(read, POINTS[:4], HALVES, **named).differences == ()  # type: ignore[arg-type]  # by name
                continue
            name = [*THINGS][wrong]
            said = f"the certificate is {'' if inside[wrong] else 'not '}about {NOUNS[name]}: {name}"
            with pytest.raises(CertificateError, match=said):
                check_certificate(read, POINTS[:4], HALVES, **named)  # type: ignore[arg-type]  # by name

    @pytest.mark.parametrize("names", [["size"], ["within"], ["max_area", "size"], ["pretty"]])
    def test_control_other_bounds(self, names: list[str]) -> None:
        """Bounds that the certificate does not speak of, and those that are none: all are named."""
        text = verify(POINTS, HALVES, min_angle=20).to_json()
        said = f"bounds of the certificate and those given differ: {', '.join(names)}"
        with pytest.raises(CertificateError, match=f"{said}$"):
            check_certificate(text, POINTS, HALVES, bounds={name: np.ones(2) for name in reversed(names)})


@pytest.mark.obligation("V2", "a certificate can be read without its mesh", method="named cases", control_in="mutants")
class TestReading:
    """Whether all claims held, by which rule the domain is one, what was claimed: values, not methods."""

    @pytest.mark.parametrize("rule", ["seeds", "even-odd", None])
    def test_values(self, rule: str | None) -> None:
        domain = None if rule is None else PSLG(POINTS[:4], RINGS, rule=rule)
        for triangles, ok in ((HALVES, True), (HALVES[:1], False)):
            read = read_certificate(verify(POINTS[:4], triangles, domain=domain, min_angle=20).to_json())
            assert (read.ok, read.rule) == (ok, rule)
            assert {"admissible", "min_angle"} <= {*read.claims}
            assert read.bounds == {"min_angle": 20.0}
            assert read.mesh["triangles"] == len(triangles)
            assert read.answers()["min_angle"] == ("holds", 0)

    def test_nothing_is_verified_unasked(self) -> None:
        text = verify(POINTS[:4], HALVES).to_json()
        assert check_certificate(text, POINTS[:4], HALVES).report is None
        assert check_certificate(text, POINTS[:4], HALVES, again=True).report is not None

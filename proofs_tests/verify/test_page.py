"""The page of a report, in a real browser: what it lists, where it flies, what it draws, and that it needs no one."""

import base64
import re
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import cast

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests.verify.browser import Page, browser

from exactmesh import PSLG, constrained_delaunay, delaunay
from exactmesh.verify import Property, Report, verify

pytestmark = pytest.mark.once


HOSTILE = "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 2'>&amp;"
KITE = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]
HALVES = [(0, 1, 2), (0, 2, 3)]


def broken() -> Report:
    """A mesh with a few faults."""
    mesh = delaunay(np.random.default_rng(3).random((300, 2)))
    triangles = np.delete(mesh.triangles, [200, 201], axis=0)
    triangles[[10, 50]] = triangles[[10, 50]][:, [0, 2, 1]]
    points = mesh.points.copy()
    points[30] += 0.06
    return verify(points, triangles)


def array_of(page: str, name: str, dtype: str) -> npt.NDArray[np.generic]:
    """Read an array of the page as the browser does."""
    found = re.search(rf'<script type="text/plain" id="{name}">([^<]*)</script>', page)
    assert found is not None
    raw = np.frombuffer(zlib.decompress(base64.b64decode(found[1])) if found[1] else b"", dtype=np.uint8)
    size = np.dtype(dtype).itemsize
    return np.ascontiguousarray(raw.reshape(size, -1).T).reshape(-1).view(dtype)


class TestDocument:
    """Law: the page holds the mesh bit by bit, lists every violation, and text stays text."""

    def test_the_arrays(self) -> None:
        rng = np.random.default_rng(1)
        points = rng.standard_normal((50, 2)) * 10.0 ** rng.integers(-99, 99, (50, 2))
        triangles = rng.integers(0, 50, (80, 3))
        page = verify(points, triangles, quads=rng.integers(0, 50, (3, 4))).to_html()
        assert array_of(page, "points", "<f8").tolist() == points.ravel().tolist()
        assert array_of(page, "triangles", "<u4").tolist() == triangles.ravel().tolist()
        assert len(array_of(page, "quads", "<u4")) == 12

    def test_indices_that_are_none_and_points_that_are_nowhere(self) -> None:
        page = verify([(0, 0), (1, np.nan), (0, 1)], [(0, 1, -1), (2, 3, 0)]).to_html()
        assert array_of(page, "triangles", "<u4").tolist() == [0, 1, 2**32 - 1, 2, 2**32 - 1, 0]
        assert np.isnan(array_of(page, "points", "<f8")[3].item())

    @pytest.mark.parametrize("exponent", [-1070, -600, 600, 1020])
    def test_extreme_coordinates_are_scaled_exactly(self, exponent: int) -> None:
        page = verify(np.ldexp(np.array(KITE), exponent), HALVES).to_html()
        largest = abs(array_of(page, "points", "<f8").astype(np.float64)).max()
        assert 0.5 <= largest < 1
        found = re.search(r'"exponent":(-?\d+)', page)
        assert found is not None
        restored = np.ldexp(array_of(page, "points", "<f8").astype(np.float64), int(found[1]))
        assert restored.tolist() == np.ldexp(np.array(KITE), exponent).ravel().tolist()

    def test_text_is_escaped(self) -> None:
        page = verify(KITE, HALVES).to_html(HOSTILE)
        assert "&lt;script&gt;window.broken" in page
        assert "<img" not in page
        assert page.count("</script>") == page.count("<script")

    def test_the_hash_is_that_of_the_certificate(self) -> None:
        report = verify(KITE, HALVES)
        found = re.search(r'"sha256": "([0-9a-f]{64})"', report.to_json())
        assert found is not None
        assert found[1] in report.to_html()

    def test_a_report_without_its_mesh(self) -> None:
        whole = verify(KITE, HALVES)
        report = Report(whole.findings, whole.claims, 4, 2, whole.stages)
        with pytest.raises(ValueError, match="does not have its mesh"):
            report.to_html()

    def test_the_boundary(self) -> None:
        page = verify(KITE, HALVES).to_html()
        edges = array_of(page, "boundary", "<u4").reshape(-1, 2).tolist()
        assert sorted(edges) == [[0, 1], [0, 3], [1, 2], [2, 3]]


@pytest.fixture(scope="module")
def chromium() -> Iterator[Page]:
    with browser() as page:
        yield page


def pixels(page: Page) -> npt.NDArray[np.int64]:
    """Return the colours of the picture, on a grid of 60 x 60."""
    script = """
    const canvas = document.getElementById("picture");
    const { width, height } = canvas;
    const copy = Object.assign(document.createElement("canvas"), { width, height });
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const data = context.getImageData(0, 0, width, height).data;
    const places = [...Array(60).keys()].map((i) => (i + 0.5) / 60);
    return places.flatMap((y) => places.map((x) => {
      const at = 4 * (Math.floor(y * height) * width + Math.floor(x * width));
      return [...data.slice(at, at + 3)];
    }));
    """
    return np.array(page.run(script))


def colours(page: Page) -> int:
    return len({tuple(colour) for colour in pixels(page).tolist()})


def number(page: Page, script: str, *arguments: object) -> float:
    found = page.run(f"return {script}", *arguments)
    assert isinstance(found, int | float)
    return found


@pytest.mark.obligation("V3", "the page shows mesh and violations in a browser, with no request", method="named cases")
class TestBrowser:
    """Law: the page works by itself: no request, no complaint; every violation is listed; a click flies there; the
    picture shows the mesh, at every scale."""

    def test_loads_alone(self, chromium: Page, tmp_path: Path) -> None:
        report = broken()
        chromium.open(report.to_html(HOSTILE), tmp_path)
        assert number(chromium, "document.querySelectorAll('#list .place').length") == sum(
            len(report.findings[claim].violations) for claim in report.claims
        )
        assert chromium.run("return document.querySelector('h1').textContent") == HOSTILE
        assert chromium.run("return window.broken ?? null") is None
        assert chromium.complaints() == []
        assert chromium.requests() == []
        assert colours(chromium) > 4

    def test_control_requests_and_complaints_are_noticed(self, chromium: Page, tmp_path: Path) -> None:
        """A page that asks for a picture, and complains."""
        page = verify(KITE, HALVES).to_html().replace("img-src data:", "img-src *")
        page = page.replace("<aside", '<img src="http://127.0.0.1:9/nothing.png" alt=""><aside')
        chromium.open(page.replace('"use strict";', '"use strict"; console.error("oh");'), tmp_path)
        chromium.run("")
        assert any("oh" in told for told in chromium.complaints())
        assert chromium.requests() == ["http://127.0.0.1:9/nothing.png"]

    def test_a_click_flies(self, chromium: Page, tmp_path: Path) -> None:
        report = broken()
        chromium.open(report.to_html(), tmp_path)
        before = number(chromium, "exactmesh.view.scale")
        chromium.run("document.querySelectorAll('#list .place')[2].click()")
        assert number(chromium, "exactmesh.chosen") == 2
        assert number(chromium, "exactmesh.view.scale") > 2 * before
        box = cast("list[float]", chromium.run("return exactmesh.report.violations[2].box"))
        x, y = number(chromium, "exactmesh.view.x"), number(chromium, "exactmesh.view.y")
        reach = number(chromium, "exactmesh.view.width / exactmesh.view.scale")
        assert abs(x - (box[0] + box[2]) / 2) < reach / 2
        assert abs(y - (box[1] + box[3]) / 2) < reach / 2
        message = chromium.run("return document.getElementById('sentence').textContent")
        assert message == chromium.run("return exactmesh.report.violations[2].message")
        digits = cast("str", chromium.run("return document.getElementById('vertices').textContent"))
        vertex = cast("int", chromium.run("return exactmesh.report.violations[2].vertices[0]"))
        assert report.mesh is not None
        assert repr(float(report.mesh.points[vertex, 0])) in digits
        chromium.run("document.getElementById('dismiss').click()")
        assert number(chromium, "exactmesh.chosen") == -1
        assert chromium.run("return document.getElementById('details').hidden") is True

    def test_pins_are_where_the_places_are(self, chromium: Page, tmp_path: Path) -> None:
        chromium.open(verify(KITE, HALVES, claims=["delaunay"]).to_html(), tmp_path)
        chromium.run(
            """
            const { x, y, ox, oy, scale, width, height } = exactmesh.view;
            const canvas = document.getElementById("picture");
            const { left, top } = canvas.getBoundingClientRect();
            const clientX = left + width / 2 + (3 - x - ox) * scale;
            const clientY = top + height / 2 - (0 - y - oy) * scale;
            const options = { clientX, clientY, pointerId: 1, bubbles: true, isPrimary: true };
            canvas.setPointerCapture = () => {};
            canvas.dispatchEvent(new PointerEvent("pointerdown", options));
            canvas.dispatchEvent(new PointerEvent("pointerup", options));
            """
        )
        assert number(chromium, "exactmesh.chosen") == 0

    def test_wheel_keys_and_buttons(self, chromium: Page, tmp_path: Path) -> None:
        chromium.open(broken().to_html(), tmp_path)
        scales = [number(chromium, "exactmesh.view.scale")]
        for script in (
            "document.getElementById('closer').click()",
            """document.getElementById('picture').dispatchEvent(
                new WheelEvent('wheel', { deltaY: -120, clientX: 700, clientY: 300, cancelable: true }))""",
            "document.getElementById('picture').dispatchEvent(new KeyboardEvent('keydown', { key: '+' }))",
        ):
            chromium.run(script)
            scales.append(number(chromium, "exactmesh.view.scale"))
        assert scales == sorted(set(scales))
        chromium.run("document.getElementById('picture').dispatchEvent(new KeyboardEvent('keydown', { key: 'n' }))")
        assert number(chromium, "exactmesh.chosen") == 0
        chromium.run("exactmesh.choose(-1); document.getElementById('fit').click()")
        assert number(chromium, "exactmesh.view.scale") == pytest.approx(scales[0])

    def test_filters(self, chromium: Page, tmp_path: Path) -> None:
        report = broken()
        chromium.open(report.to_html(), tmp_path)
        chromium.run("document.querySelector('[data-property=orientation]').click()")
        expected = len(report.findings[Property.ORIENTATION].violations)
        assert number(chromium, "document.querySelectorAll('#list .place').length") == expected
        chromium.run("for (const chip of document.querySelectorAll('.chip[aria-pressed=true]')) chip.click()")
        assert number(chromium, "document.querySelectorAll('#list .place').length") == 0
        assert chromium.run("return document.getElementById('nothing').hidden") is False

    def test_what_was_not_claimed_is_no_fault(self, chromium: Page, tmp_path: Path) -> None:
        chromium.open(verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]).to_html(), tmp_path)  # it is not acute
        assert number(chromium, "document.querySelectorAll('#list .place').length") == 0
        assert "not can be switched on" in str(chromium.run("return document.getElementById('nothing').textContent"))
        chromium.run("document.querySelector('.chip').click()")
        assert number(chromium, "document.querySelectorAll('#list .place.not_claimed').length") == 1

    def test_light_and_dark(self, chromium: Page, tmp_path: Path) -> None:
        chromium.open(broken().to_html(), tmp_path)
        light = pixels(chromium).mean()
        chromium.open(broken().to_html(), tmp_path, dark=True)
        assert pixels(chromium).mean() < light / 2

    def test_narrow(self, chromium: Page, tmp_path: Path) -> None:
        chromium.open(broken().to_html(), tmp_path, size=(400, 800))
        assert number(chromium, "document.documentElement.scrollWidth") <= 400
        assert number(chromium, "exactmesh.view.width") == 400
        assert colours(chromium) > 4

    def test_every_sort_of_mesh(self, chromium: Page, tmp_path: Path) -> None:
        """Quadrilaterals, segments, a domain, points that are nowhere, nothing at all."""
        lake = PSLG([(0, 0), (9, 0), (9, 9), (0, 9)], [(0, 1), (1, 2), (2, 3), (3, 0)])
        mesh = constrained_delaunay(lake)
        reports = (
            verify(KITE, [], quads=[(0, 1, 2, 3), (0, 2, 1, 3)]),
            verify(KITE, HALVES, segments=[(1, 3)]),
            verify(mesh.points, mesh.triangles[:1], domain=lake),
            verify([(0, np.nan), (1, 1), (2, 1)], [(0, 1, 2), (1, 2, 9)]),
            verify([], []),
            verify([(7, 7)], []),
            verify(np.array(KITE) * 2.0**1000, HALVES),
            verify(np.array(KITE) * 5e-324, HALVES),
        )
        for report in reports:
            chromium.open(report.to_html(), tmp_path)
            chromium.run(
                "for (let i = 0; i < Math.min(5, exactmesh.report.violations.length); i++) exactmesh.choose(i)"
            )
            assert chromium.complaints() == []
            assert number(chromium, "exactmesh.view.scale") > 0

    def test_the_last_bit(self, chromium: Page, tmp_path: Path) -> None:
        """A vertex one ulp below the edge between two far ones: above the edge and below the vertex there is mesh, and
        between them there is none."""
        ulp = 2.0**-53
        points = [(0.0, 1.0), (1.0, 1.0), (0.5, 2.0), (0.5, 1.0 - ulp), (0.0, 0.0), (1.0, 0.0)]
        chromium.open(verify(points, [(0, 1, 2), (4, 5, 3)]).to_html(), tmp_path)
        chromium.run("exactmesh.look(given[0])", [0.5 - ulp, 1.0 - 2 * ulp, 0.5 + ulp, 1.0 + 2 * ulp])
        picture = pixels(chromium).sum(axis=1).reshape(60, 60)
        assert chromium.run("return exactmesh.mode") == "paths"
        assert number(chromium, "exactmesh.view.scale") > 1e18
        above, gap, below = (np.median(picture[rows, 28:32]) for rows in (slice(3, 27), slice(32, 43), slice(50, 58)))
        assert above == below < gap
        assert chromium.complaints() == []

    def test_a_million_triangles(self, chromium: Page, tmp_path: Path) -> None:
        """It becomes ready, shows pixels first, paths near by, and the main thread is never held up for long."""
        side = 708
        y, x = np.divmod(np.arange(side * side), side)
        points = np.stack([x + 0.3 * np.sin(y), y + 0.3 * np.cos(x)], axis=1)
        v = np.flatnonzero((x < side - 1) & (y < side - 1))
        lower, upper = np.stack([v, v + 1, v + side + 1], axis=1), np.stack([v, v + side + 1, v + side], axis=1)
        triangles = np.concatenate([lower, upper])
        triangles[[5, 777_777]] = triangles[[5, 777_777]][:, ::-1]
        text = verify(points, triangles, claims=["orientation"]).to_html()
        assert len(text) < 25_000_000
        chromium.open(text, tmp_path)
        assert chromium.run("return exactmesh.mode") == "pixels"
        assert colours(chromium) > 20
        chromium.run("exactmesh.choose(1)")
        assert chromium.run("return exactmesh.mode") == "paths"
        assert colours(chromium) > 4
        assert chromium.complaints() == []
        assert chromium.requests() == []

"""M2: the exact potential of every flip that any algorithm does."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from proofs_tests.mesh import flips
from proofs_tests.recording import Record

from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray
from exactmesh.connectivity import rings_of
from exactmesh.edgealgebra import EdgeArray, swap

Swap = Callable[[EdgeArray, EdgeArray, int], None]
ROOT = Path(__file__).parents[2]


def nothing(_ring: EdgeArray, _org: EdgeArray, _e: int) -> None:
    """Flip nothing."""


@pytest.fixture(scope="module")
def lines() -> list[str]:
    """What the flips of each algorithm came to; compiled code cannot be watched, so it runs interpreted in a child."""
    if not COMPILED:
        return [flips.described(name) for name in flips.ALGORITHMS]
    child = subprocess.run(
        [sys.executable, "-m", "proofs_tests.mesh.flips"],
        cwd=ROOT,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        timeout=600,
        check=True,
    )
    return child.stdout.splitlines()


@pytest.mark.obligation("M2", "every flip of every algorithm lowers 6 Phi by exactly incircle", method="enumeration")
class TestEveryFlip:
    """Insertion, Lawson, segments, the builder and refinement: each flip of the diagonal ac of a, b, c, d, as the rings
    stand before and after, changes 6 Phi by -incircle(a, b, c, d); where flips seek the Delaunay triangulation they
    lower it, or a tie's slopes; and Lawson's flips are all that changes it."""

    def test_nothing_is_wrong(self, lines: list[str], record_property: Record) -> None:
        assert [line.partition(":")[0] for line in lines] == list(flips.ALGORITHMS)
        for line in lines:
            assert line.endswith("wrong: nothing")
        record_property(
            "cases",
            sum(int(word.strip(",")) for line in lines for word in line.partition(";")[0].split() if word[0].isdigit()),
        )

    def test_lawson_is_nothing_but_flips(self, lines: list[str]) -> None:
        assert "; of the fall of 6 Phi all;" in next(line for line in lines if line.startswith("Lawson"))

    @pytest.mark.parametrize(
        "caller",
        [f"{module.removeprefix('exactmesh.')}.{name}" for module in flips.CALLERS for name in flips.CALLERS[module]],
    )
    def test_every_caller_is_seen(self, caller: str, lines: list[str]) -> None:
        assert any(f" {caller} " in line for line in lines)

    def test_all_callers_are_watched(self) -> None:
        """Whatever module imports the compiled swap is in the list."""
        found = {
            ".".join(path.relative_to(ROOT / "mesh").with_suffix("").parts)
            for path in (ROOT / "mesh" / "exactmesh").rglob("*.py")
            if any(
                "swap(" in line and not line.startswith("def ") and ".swap(" not in line and "_swap(" not in line
                for line in path.read_text(encoding="utf-8").splitlines()
                if not line.lstrip().startswith(("#", '"'))
            )
        }
        assert found - {"exactmesh.quadedge"} == set(flips.CALLERS)

    @pytest.mark.parametrize(
        ("height", "does", "broken"), [(3.0, swap, ""), (1.0, swap, "descent"), (3.0, nothing, "potential")]
    )
    def test_control_a_wrong_flip_is_found(
        self, height: float, does: Swap, broken: str, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """A flip away from the Delaunay triangulation, and one that leaves the triangles as they are; a right one."""
        xy = np.array([-2.0, 0.0, 0.0, -1.0, 2.0, 0.0, 0.0, height])
        ring, org, _ = rings_of(
            *(np.array(rows, dtype=np.int32) for rows in ([(3, 0, 1), (1, 2, 3)], [(-1, 1, -1), (-1, 0, -1)]))
        )
        monkeypatch.setattr(flips, "swap", does)
        ledger = flips.Ledger()
        watched = flips.replacement(ledger, "exactmesh.lawson", {"flip_until_delaunay": True})
        e = next(e for e in range(0, 20, 4) if {int(org[e >> 1]), int(org[(e ^ 2) >> 1])} == {1, 3})
        flip_until_delaunay(watched, xy, ring, org, e)
        assert ledger.flips == {"lawson.flip_until_delaunay": 1}
        assert {law for law, n in ledger.wrong.items() if n} - {"descent"} <= {broken}
        assert bool(ledger.wrong[broken]) is bool(broken)


def flip_until_delaunay(watched: Swap, xy: FloatArray, ring: EdgeArray, org: EdgeArray, e: int) -> None:
    """Stands in for the function of that name, whose variables the watcher reads."""
    assert xy.ndim == 1
    watched(ring, org, e)

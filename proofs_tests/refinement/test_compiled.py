"""J1 for refinement: compiled equals interpreted; no fused multiply-add; Ctrl-C ends a compiled run."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from proofs_tests.kernel.test_compiled import FUSED, in_a_child, machine_code
from proofs_tests.refinement import digest as refine_digest

from exactmesh import PSLG, refine
from exactmesh.refinement import ruppert

ROOT = Path(__file__).parents[2]


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1", "refinement returns the same bits compiled and interpreted, and accounts for the same", method="bit for bit"
)
class TestLanes:
    """Angles, areas, sizes and circles of right and small angles, holes, regions and extreme coordinates: the same
    points in the same order, for the same reasons, compiled and interpreted."""

    def test_interpreted(self) -> None:
        here = "".join(f"{name}: {digest}\n" for name, digest in refine_digest.digests().items())
        assert in_a_child("-m", "proofs_tests.refinement.digest", NUMBA_DISABLE_JIT="1") == here

    def test_control_the_digest_sees_one_bit(self) -> None:
        """One coordinate moved by one unit in the last place."""
        domain = refine_digest.domains()["star"]
        points = domain.points.copy()
        points[5, 0] = np.nextafter(points[5, 0], 9.0)
        moved = PSLG(points, domain.segments)
        one, other, same = (refine_digest.digest_of(refine(d, max_steiner=20)) for d in (domain, moved, domain))
        assert one == same != other


@pytest.mark.bounds
@pytest.mark.compiled
class TestBounds:
    """No routine leaves an array: with NUMBA_BOUNDSCHECK=1 it would raise."""

    def test_all(self) -> None:
        assert len(refine_digest.digests()) == 4 * len(refine_digest.domains())


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1",
    "there is no fused multiply-add in the machine code of refinement",
    method="machine code",
    control_in="proofs_tests/mesh/test_compiled.py::TestMachineCode",
)
class TestMachineCode:
    """The loop that refines contains no fused multiply-add in the filters that were copied into it."""

    def test_loop(self) -> None:
        refine(refine_digest.domains()["plate"], max_area=4.0)
        function = ruppert.run
        signatures = getattr(function, "signatures")  # noqa: B009  # a name of numba's
        listing = machine_code(function, signatures[0], fastmath=False)
        assert "mulsd" in listing or "fmul" in listing
        assert not FUSED.findall(listing)


LONG_RUN = """
import signal
from exactmesh import PSLG, refine

signal.signal(signal.SIGINT, signal.default_int_handler)  # which a job in the background lacks
square = PSLG([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
before = refine(square, max_area=0.01).triangulation
told = []

def progress(done, total):
    told.append(done)
    if len(told) == 1:
        print("running", flush=True)

try:
    refine(square, max_area=1e-8, progress=progress)
    print("finished")
except KeyboardInterrupt:
    print("interrupted", told[-1] < 100_000_000, refine(square, max_area=0.01).triangulation == before, flush=True)
"""


@pytest.mark.compiled
@pytest.mark.skipif(os.name == "nt", reason="no SIGINT for a child process")
@pytest.mark.obligation(
    "J1",
    "Ctrl-C ends a long refinement, and the library works on",
    method="named cases",
    control_in="proofs_tests/mesh/test_compiled.py::TestInterrupt",
)
class TestInterrupt:
    """SIGINT in the middle of a run that would make a hundred million points ends it with KeyboardInterrupt; what is
    computed afterwards is what it would have been."""

    def test_interrupt(self) -> None:
        paths = os.pathsep.join(path for path in sys.path if path)
        with subprocess.Popen(
            [sys.executable, "-c", LONG_RUN],
            env={**os.environ, "PYTHONPATH": paths},
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        ) as child:
            assert child.stdout is not None
            assert child.stdout.readline() == "running\n"
            child.send_signal(signal.SIGINT)
            try:
                output, errors = child.communicate(timeout=60)
            except subprocess.TimeoutExpired:
                child.kill()
                raise
        assert output == "interrupted True True\n", errors

"""J1 for the mesh: compiled equals interpreted; no fused multiply-add; Ctrl-C ends a compiled run."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from proofs_tests.kernel.test_compiled import FUSED, HAS_FUSED, in_a_child, machine_code
from proofs_tests.mesh import digest as mesh_digest
from proofs_tests.mesh.enumeration import grid

from exactkernel.incircle import determinant_and_permanent
from exactmesh import PSLG, constrained_delaunay, delaunay, lawson

ROOT = Path(__file__).parents[2]


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1",
    "the mesh algorithms return the same bits compiled and interpreted, and do the same work",
    method="bit for bit",
)
class TestLanes:
    """Insertion, flips, location, order, quad-edge and segments return the same bits compiled, in this process and a
    later one, and interpreted; the predicates were decided by the same stages."""

    @pytest.mark.parametrize("disable", ["1", "0"])
    def test_child(self, disable: str) -> None:
        here = "".join(f"{name}: {digest}\n" for name, digest in mesh_digest.digests().items())
        assert in_a_child("-m", "proofs_tests.mesh.digest", NUMBA_DISABLE_JIT=disable) == here

    def test_control_the_digest_sees_one_bit(self) -> None:
        """One coordinate moved by one unit in the last place."""
        points = mesh_digest.inputs()["uniform"]
        moved = points.copy()
        moved[7, 0] = np.nextafter(moved[7, 0], 2.0)
        assert mesh_digest._mesh(delaunay(points)) != mesh_digest._mesh(delaunay(moved))
        assert mesh_digest._mesh(delaunay(points)) == mesh_digest._mesh(delaunay(points.copy()))


@pytest.mark.bounds
@pytest.mark.compiled
class TestBounds:
    """No routine leaves an array on any of the inputs of the digest: with NUMBA_BOUNDSCHECK=1 it would raise."""

    def test_all(self) -> None:
        assert len(mesh_digest.digests()) == 9 * len(mesh_digest.inputs()) + 2


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1",
    "there is no fused multiply-add in the machine code of insertion, flips, location and segments",
    method="machine code",
)
class TestMachineCode:
    """No loop over the mesh contains a fused multiply-add in the filters that were copied into it."""

    LOOPS = (
        ("exactmesh.delaunay", "insert_range"),
        ("exactmesh.lawson", "flip_until_delaunay"),
        ("exactmesh.locate", "_walk_all"),
        ("exactmesh.constrain", "constrain_range"),
        ("exactmesh.cavity", "fill_by_chance"),
    )

    @pytest.mark.parametrize(("module", "name"), LOOPS)
    def test_loop(self, module: str, name: str) -> None:
        lawson(grid(3, 3), delaunay(grid(3, 3)).triangles).locate([(0.5, 0.5)])
        curve = [(-9.0, 0.0), (9.0, 0.0), *((x / 100, 1 + x * x / 1e4) for x in range(-100, 100))]
        constrained_delaunay(PSLG(curve, [(0, 1)]), carve=False)
        function = getattr(sys.modules[module], name)
        if not function.signatures:
            pytest.skip("from the cache, as a part of its caller: only a process that compiles it knows its types")
        listing = machine_code(function, function.signatures[0], fastmath=False)
        assert "mulsd" in listing or "fmul" in listing
        assert not FUSED.findall(listing)

    @pytest.mark.skipif(not HAS_FUSED, reason="this processor has no fused multiply-add")
    def test_control_contraction_is_seen(self) -> None:
        """The determinant that is copied into the loops, compiled with contraction."""
        listing = machine_code(determinant_and_permanent, (numba.types.float64,) * 6, fastmath={"contract"})
        assert FUSED.findall(listing)


LONG_RUN = """
import signal
import sys
import numpy as np
from exactmesh import delaunay, lawson, verify

signal.signal(signal.SIGINT, signal.default_int_handler)  # which a job in the background lacks
few = np.ldexp(np.random.default_rng(0).random((30, 2)), np.arange(-600, 600, 20).reshape(30, 2))  # no window
mesh = delaunay(few)
lawson(few, mesh.triangles)
mesh.locate(few)
random = np.random.default_rng(0)
many = np.concatenate([random.random((400_000, 2)) * 2.0**-700, few])  # every predicate is rational
line = np.repeat(np.ldexp(1.0, np.arange(-700, 700, 2)), 2000)
told = []

def progress(done, total):
    told.append(done)
    if len(told) == 1:
        print("running", flush=True)

try:
    if sys.argv[1] == "insertion":
        delaunay(many, progress=progress)
    else:
        print("running", flush=True)
        if sys.argv[1] == "search":
            delaunay(np.stack([line, line], axis=1))
        else:
            mesh.locate(many)
    print("finished")
except KeyboardInterrupt:
    assert not told or told[-1] < len(many)
    print("interrupted", delaunay(few) == mesh, flush=True)
"""


@pytest.mark.compiled
@pytest.mark.skipif(os.name == "nt", reason="no SIGINT for a child process")
@pytest.mark.obligation("J1", "Ctrl-C ends a long compiled run, and the library works on", method="named cases")
class TestInterrupt:
    """SIGINT in the middle of a run that would take minutes ends it with KeyboardInterrupt; what is computed
    afterwards is what it would have been."""

    @pytest.mark.parametrize("run", ["insertion", "search", "location"])
    def test_interrupt(self, run: str) -> None:
        paths = os.pathsep.join(path for path in sys.path if path)
        with subprocess.Popen(
            [sys.executable, "-c", LONG_RUN, run],
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
        assert output == "interrupted True\n", errors

    def test_control_without_a_signal_it_goes_on(self) -> None:
        """The same source, cut short to few points, says that it finished."""
        source = LONG_RUN.replace("400_000", "40").replace("2000", "2")
        assert in_a_child("-c", source, "location").splitlines() == ["running", "finished"]

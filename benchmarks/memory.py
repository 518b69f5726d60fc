"""How far the verifier lets the memory of a process grow: in a fresh process that does nothing else."""

import multiprocessing
import resource
import tempfile
import time
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np

__all__ = ["bytes_per_triangle"]


def _build(folder: str, size: int) -> None:
    from exactmesh import delaunay

    mesh = delaunay(np.random.default_rng(1).random((size, 2)))
    np.save(Path(folder) / "points.npy", mesh.points)
    np.save(Path(folder) / "triangles.npy", mesh.triangles)


def _verify(folder: str, pipe: Connection) -> None:
    from exactmesh import delaunay, verify

    small = delaunay(np.random.default_rng(1).random((1000, 2)))
    verify(small.points, small.triangles).raise_if_failed()  # loads the compiled code
    points, triangles = np.load(Path(folder) / "points.npy"), np.load(Path(folder) / "triangles.npy")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.perf_counter()
    verify(points, triangles).raise_if_failed()
    seconds = time.perf_counter() - start
    growth = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024
    pipe.send((len(triangles), growth / len(triangles), seconds))


def bytes_per_triangle(size: int) -> tuple[int, float, float]:
    """Return how many triangles the mesh of so many uniform points has, how much memory verifying it takes for each
    of them, and the seconds of that one run."""
    context = multiprocessing.get_context("spawn")
    with tempfile.TemporaryDirectory() as folder:
        builder = context.Process(target=_build, args=(folder, size))
        builder.start()
        builder.join()
        pipe, other = context.Pipe()
        verifier = context.Process(target=_verify, args=(folder, other))
        verifier.start()
        other.close()
        answer: tuple[int, float, float] = pipe.recv()
        verifier.join()
    return answer

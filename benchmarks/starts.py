"""The first call ever (compilation) and every later process start, in fresh interpreters."""

import os
import subprocess
import sys
import tempfile
import time
from statistics import median

__all__ = ["first_call_seconds", "later_start_seconds"]

_CALL = """
import time; start = time.perf_counter()
import numpy as np
from exactmesh import delaunay
points = np.random.default_rng(0).random((100, 2))
delaunay(points)
print(time.perf_counter() - start)
"""


def _run(cache: str) -> tuple[float, float]:
    """Return (seconds from the first import to the result, seconds of the whole process)."""
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", _CALL],
        env={**os.environ, "NUMBA_CACHE_DIR": cache},
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout), time.perf_counter() - start


def first_call_seconds() -> float:
    """Return the time of import and first call with an empty cache."""
    with tempfile.TemporaryDirectory() as cache:
        return _run(cache)[0]


def later_start_seconds(runs: int = 7) -> tuple[float, float]:
    """Return the medians of a later process: import plus a 100-point call, and the whole process."""
    with tempfile.TemporaryDirectory() as cache:
        _run(cache)
        times = [_run(cache) for _ in range(runs)]
    return median(inside for inside, _ in times), median(whole for _, whole in times)

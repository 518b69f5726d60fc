"""The only place where numba is configured.

``jit`` compiles lazily, caches on disk, and never allows fast-math: a contracted multiply-add would destroy the
error-free transforms. numba's cache notices changes of a function's own file only, so the cache lives in a folder named
after *all* the sources: a new version, or an edit of an imported function, can never meet stale machine code.
"""

import hashlib
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numba
from numba.core import config as _numba_config

#: numba's settings; their names are made at run time, out of reach of a type checker.
_config: Any = _numba_config

__all__ = ["COMPILED", "cache_directory", "is_cache_warm", "jit", "jit_inline"]

P = ParamSpec("P")
R = TypeVar("R")

#: False under ``NUMBA_DISABLE_JIT=1``: the same source runs interpreted, for coverage, mutation testing and stepping.
COMPILED: bool = not _config.DISABLE_JIT

_UNUSED_AFTER_SECONDS = 30 * 24 * 3600


def _sources() -> list[Path]:
    """Every source file of the two packages that stand side by side with this one (exactmesh may be elsewhere)."""
    kernel = Path(__file__).resolve().parent
    roots = [kernel]
    for folder in (kernel.parent / "exactmesh", kernel.parent.parent / "mesh" / "exactmesh"):
        if folder.is_dir():
            roots.append(folder)
    return sorted(path for root in roots for path in root.rglob("*.py"))


def _stamp() -> str:
    digest = hashlib.sha256(f"{sys.version_info} {numba.__version__}".encode())
    for path in _sources():
        status = path.stat()
        digest.update(f"{path}|{status.st_mtime_ns}|{status.st_size};".encode())
    return digest.hexdigest()[:16]


def _writable_base() -> Path:
    """The user's cache folder; the temporary folder where that cannot be written."""
    if os.environ.get("NUMBA_CACHE_DIR"):
        candidates = [Path(os.environ["NUMBA_CACHE_DIR"])]
    else:
        home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
        candidates = [Path(home) / "exactmesh"]
    user = os.getuid() if hasattr(os, "getuid") else "user"
    candidates.append(Path(tempfile.gettempdir()) / f"exactmesh-{user}")
    for base in candidates:
        try:
            base.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(base, os.W_OK):
            return base
    return Path(tempfile.mkdtemp(prefix="exactmesh-"))


def _open_cache() -> Path:
    base = _writable_base()
    folder = base / _stamp()
    if not folder.exists():
        folder.mkdir(exist_ok=True)
        for other in base.iterdir():  # what earlier versions left behind
            marker = other / "used"
            if marker.exists() and time.time() - marker.stat().st_mtime > _UNUSED_AFTER_SECONDS:
                shutil.rmtree(other, ignore_errors=True)
    (folder / "used").touch()
    return folder


_CACHE: Path | None = _open_cache() if COMPILED else None


def cache_directory() -> Path | None:
    """Return the folder of the compiled functions, or None when nothing is compiled."""
    return _CACHE


def is_cache_warm() -> bool:
    """Tell whether some function of this version was compiled on this machine before."""
    return _CACHE is None or any(_CACHE.rglob("*.nbi"))


def _compile(function: Callable[P, R], *, always_inline: bool) -> Callable[P, R]:
    if not COMPILED:
        return function
    decorate = numba.njit(  # type: ignore[call-overload]  # numba's types leave out _nrt
        cache=True, fastmath=False, _nrt=False, forceinline=always_inline
    )
    before = _config.CACHE_DIR
    _config.CACHE_DIR = str(_CACHE)
    try:
        compiled: Callable[P, R] = decorate(function)
    finally:
        _config.CACHE_DIR = before
    return compiled


def jit(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function`` on its first call and keep the machine code for later processes.

    numba's run-time memory manager is left out (``_nrt=False``): arrays are borrowed from the caller. Counting
    references to them took half of the time of the insertion loop; and a heap allocation inside a compiled function is
    now an error when it is compiled.
    """
    return _compile(function, always_inline=False)


def jit_inline(function: Callable[P, R]) -> Callable[P, R]:
    """Compile as :func:`jit` does, and copy the code to each place of call: for the filters, which are short and hot."""
    return _compile(function, always_inline=True)

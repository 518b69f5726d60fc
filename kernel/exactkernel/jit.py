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
import numpy as np
from numba.core import config as _numba_config

#: numba's settings; their names are made at run time, out of reach of a type checker.
_config: Any = _numba_config

__all__ = ["COMPILED", "cache_directory", "is_cache_warm", "jit", "jit_inline"]

P = ParamSpec("P")
R = TypeVar("R")

#: False under ``NUMBA_DISABLE_JIT=1``: the same source runs interpreted, for coverage, mutation testing and stepping.
COMPILED: bool = not _config.DISABLE_JIT

if not COMPILED:  # pragma: no branch
    # numpy's scalars warn of an overflow to infinity, which machine code lets pass, as the filters expect.
    np.seterr(over="ignore", invalid="ignore")

_STAMP_LENGTH = 16
_UNUSED_AFTER_SECONDS = 30 * 24 * 3600


def _sources() -> list[Path]:
    """Return every source file of the two packages, as far as they stand side by side."""
    kernel = Path(__file__).resolve().parent
    meshes = (kernel.parent / "exactmesh", kernel.parent.parent / "mesh" / "exactmesh")
    roots = [kernel, *(folder for folder in meshes if folder.is_dir())]
    return sorted(path for root in roots for path in root.rglob("*.py"))


def _stamp() -> str:
    digest = hashlib.sha256(f"{sys.version_info} {numba.__version__}".encode())
    for path in _sources():
        status = path.stat()
        digest.update(f"{path}|{status.st_mtime_ns}|{status.st_size};".encode())
    return digest.hexdigest()[:_STAMP_LENGTH]


def _bases() -> list[Path]:
    """Where the cache may live, best first: the user's cache folder, then the temporary folder."""
    user = os.getuid() if hasattr(os, "getuid") else "user"
    temporary = Path(tempfile.gettempdir()) / f"exactmesh-{user}"
    if os.environ.get("NUMBA_CACHE_DIR"):
        return [Path(os.environ["NUMBA_CACHE_DIR"]) / "exactmesh", temporary]
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return [Path(home) / "exactmesh", temporary]


def _is_foreign(folder: Path) -> bool:
    """Tell whether another user could have put machine code into the folder."""
    return hasattr(os, "getuid") and folder.stat().st_uid not in (os.getuid(), 0)


def _remove_unused(base: Path) -> None:
    """Remove what earlier versions left behind."""
    for other in base.glob("[0-9a-f]" * _STAMP_LENGTH):
        marker = other / "used"
        if marker.exists() and time.time() - marker.stat().st_mtime > _UNUSED_AFTER_SECONDS:
            shutil.rmtree(other, ignore_errors=True)


def _open_cache() -> Path:
    """Return a writable folder of this version's own; a temporary one where nothing else can be written."""
    stamp = _stamp()
    for base in _bases():
        folder = base / stamp
        try:
            new = not folder.exists()
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if _is_foreign(base) or _is_foreign(folder):
                continue
            (folder / "used").touch()
            if new:
                _remove_unused(base)
        except OSError:  # read-only, full, or cleared by another process in this moment
            continue
        return folder
    return Path(tempfile.mkdtemp(prefix="exactmesh-"))


_CACHE: Path | None = _open_cache() if COMPILED else None


def cache_directory() -> Path | None:
    """Return the folder of the compiled functions, or None when nothing is compiled."""
    return _CACHE


def is_cache_warm(*functions: Callable[..., object]) -> bool:
    """Tell whether these functions, or some function if none is given, of this version were compiled here before."""
    if _CACHE is None:
        return True
    patterns = [f"*.{function.__name__}-*.nbi" for function in functions] or ["*.nbi"]
    return all(any(_CACHE.rglob(pattern)) for pattern in patterns)


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
    """Compile as :func:`jit` does, and copy the code to each place of call: for the short, hot filters."""
    return _compile(function, always_inline=True)

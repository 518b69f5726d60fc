"""The cache of machine code: one folder for each state of the sources, in a place that nobody else can write."""

import os
import tempfile
import time
from pathlib import Path

import numba
import numpy as np
import pytest

from exactkernel import jit, rational


@pytest.mark.obligation(
    "J1",
    "stale or foreign machine code is never loaded; a folder that cannot be written is no error",
    method="named cases",
)
class TestCacheFolder:
    """The folder's name depends on every source; it is the user's own; where none can be written, a new one is made."""

    def test_the_stamp_depends_on_every_source(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        names = {path.name for path in jit._sources()}
        assert {"expansions.py", "jit.py", "delaunay.py"} <= names
        (tmp_path / "a.py").write_text("x = 1\n")
        monkeypatch.setattr(jit, "_sources", lambda: [tmp_path / "a.py"])
        before = jit._stamp()
        assert jit._stamp() == before
        (tmp_path / "a.py").write_text("x = 11\n")
        assert jit._stamp() != before

    def test_opened_where_asked(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "deep" / "down"))
        folder = jit._open_cache()
        assert folder.parent == tmp_path / "deep" / "down" / "exactmesh"
        assert jit._open_cache() == folder

    def test_the_users_cache_by_default(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
        assert jit._bases()[0] == tmp_path / "exactmesh"

    def test_falls_back(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        blocked = tmp_path / "file"
        blocked.write_text("a file where the folder should be")
        monkeypatch.setattr(jit, "_bases", lambda: [blocked, tmp_path / "second"])
        assert jit._open_cache().parent == tmp_path / "second"
        monkeypatch.setattr(jit, "_bases", lambda: [blocked])
        monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
        assert jit._open_cache().name.startswith("exactmesh-")

    @pytest.mark.skipif(not hasattr(os, "getuid"), reason="no user ids on this platform")
    def test_a_folder_of_another_user_is_not_trusted(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.setattr(jit, "_bases", lambda: [tmp_path])
        monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
        assert jit._open_cache().parent == tmp_path
        monkeypatch.setattr(jit, "_is_foreign", lambda _: True)
        assert jit._open_cache().name.startswith("exactmesh-")

    def test_what_is_long_unused_is_removed(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        base = tmp_path / "exactmesh"
        old, recent, other, foreign = (base / name for name in ("0" * 16, "f" * 16, "e" * 16, "precious"))
        long_ago = time.time() - 40 * 24 * 3600
        for folder in (old, recent, foreign):
            folder.mkdir(parents=True)
            (folder / "used").touch()
        for folder in (old, foreign):
            os.utime(folder / "used", (long_ago, long_ago))
        other.mkdir()
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
        jit._open_cache()
        assert not old.exists()
        assert recent.exists()
        assert other.exists()
        assert foreign.exists()  # no name that the cache would give

    def test_warm_means_that_something_is_compiled(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.setattr(jit, "_CACHE", tmp_path)
        assert not jit.is_cache_warm()
        (tmp_path / "f.nbi").touch()
        assert jit.is_cache_warm()
        assert jit.cache_directory() == tmp_path
        assert not jit.is_cache_warm(_increment)
        (tmp_path / "module._increment_other-3.py311.nbi").touch()
        assert not jit.is_cache_warm(_increment)
        (tmp_path / "module._increment-3.py311.nbi").touch()
        assert jit.is_cache_warm(_increment)
        monkeypatch.setattr(jit, "_CACHE", None)
        assert jit.is_cache_warm()

    def test_control_other_sources_other_folder(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        """A source that is not among those of the stamp: the folder stays the same, and the code would be stale."""
        for name in ("a.py", "b.py"):
            (tmp_path / name).write_text("x = 1\n")
        monkeypatch.setattr(jit, "_sources", lambda: [tmp_path / "a.py"])
        before = jit._stamp()
        (tmp_path / "b.py").write_text("x = 11\n")
        assert jit._stamp() == before


def _increment(x: float) -> float:
    return x + 1.0


@pytest.mark.obligation("J1", "jit and the callbacks work the same in both lanes", method="named cases")
class TestBothLanes:
    """What jit returns computes what its source computes, whether it compiles or not."""

    @pytest.mark.parametrize("compiled", [False, True])
    def test_jit(self, compiled: bool, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.setattr(jit, "COMPILED", compiled)
        monkeypatch.setattr(jit, "_CACHE", tmp_path)
        assert jit.jit(_increment)(1.0) == jit.jit_inline(_increment)(1.0) == 2.0
        assert (jit.jit(_increment) is _increment) or jit.COMPILED

    @pytest.mark.parametrize("compiled", [False, True])
    def test_register(self, compiled: bool, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(rational, "COMPILED", compiled)
        mailbox = np.zeros(2, dtype=np.int64)
        ask = rational._register("exactmesh_test_register", lambda *_: 1, 6)
        if compiled:
            ask = rational._keep_alive.pop()  # type: ignore[assignment]  # a ctypes function
        ask(mailbox.ctypes.data, 3, 0, *[0.0] * 6)
        assert mailbox.tolist() == [0, 3 * 4 + 3]

    @pytest.mark.compiled
    def test_control_fast_mathematics_is_another_function(self) -> None:
        """A function compiled with other options than those of jit."""

        def zero(a: float, b: float) -> float:
            return ((a + b) - a) - b

        loose = numba.njit(fastmath=True)(zero)
        assert zero(1.0, 2.0**-60) != 0.0
        assert loose(1.0, 2.0**-60) == 0.0

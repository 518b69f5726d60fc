"""The cache of machine code: one folder for each state of the sources, in a place that nobody else can write."""

import os
import stat
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import NoReturn

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


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no user ids on this platform")
@pytest.mark.obligation(
    "J1",
    "machine code is taken from one's own folders only, and thrown away when 30 days unused",
    method="named cases",
    control_in="mutants",
)
class TestCacheRules:
    """Who is trusted, what is kept, and where the folders are."""

    @pytest.mark.parametrize(("owner", "is_foreign"), [(1000, False), (0, False), (1, True), (1001, True)])
    def test_owners(self, owner: int, is_foreign: bool, monkeypatch: pytest.MonkeyPatch) -> None:
        """One's own folders and root's are trusted."""
        monkeypatch.setattr(os, "getuid", lambda: 1000)
        folder = SimpleNamespace(stat=lambda: SimpleNamespace(st_uid=owner))
        assert jit._is_foreign(folder) is is_foreign  # type: ignore[arg-type]  # as far as it is asked, a path

    @pytest.mark.parametrize("depth", [0, 1])
    def test_one_foreign_folder_suffices(self, depth: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        """The base or the folder in it: the next base is taken."""
        bases = [tmp_path / "first", tmp_path / "second"]
        foreign = [bases[0], bases[0] / jit._stamp()][depth]
        monkeypatch.setattr(jit, "_bases", lambda: bases)
        monkeypatch.setattr(jit, "_is_foreign", lambda path: path == foreign)
        assert jit._open_cache().parent == bases[1]

    def test_nobody_else_may_look(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.setattr(jit, "_bases", lambda: [tmp_path])
        assert stat.S_IMODE(jit._open_cache().stat().st_mode) == 0o700

    def test_thirty_days(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        now, days = 2_000_000_000, 30 * 86400
        monkeypatch.setattr(time, "time", lambda: float(now))
        ages = {"a": days + 1, "b": days, "c": days - 600, "d": 0}
        for name, age in ages.items():
            (tmp_path / (name * 16)).mkdir()
            (tmp_path / (name * 16) / "used").touch()
            os.utime(tmp_path / (name * 16) / "used", (now - age, now - age))
        (tmp_path / ("e" * 16)).mkdir()  # being made by another process
        jit._remove_unused(tmp_path)
        assert sorted(path.name[0] for path in tmp_path.iterdir()) == ["b", "c", "d", "e"]

    def test_what_cannot_be_removed_is_left(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        def refused(*_: object, **__: object) -> NoReturn:
            raise PermissionError

        folder = tmp_path / ("a" * 16)
        folder.mkdir()
        (folder / "used").touch()
        os.utime(folder / "used", (0, 0))
        with monkeypatch.context() as blocked:
            blocked.setattr(os, "rmdir", refused)
            blocked.setattr(os, "unlink", refused)
            jit._remove_unused(tmp_path)
        assert folder.exists()

    def test_places(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
        temporary = tmp_path / "temporary" / f"exactmesh-{os.getuid()}"
        monkeypatch.setenv("HOME", str(tmp_path / "home"))
        monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
        monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
        assert jit._bases() == [tmp_path / "home" / ".cache" / "exactmesh", temporary]
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
        assert jit._bases() == [tmp_path / "xdg" / "exactmesh", temporary]
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "numba"))
        assert jit._bases() == [tmp_path / "numba" / "exactmesh", temporary]


def _increment(x: float) -> float:
    return x + 1.0


@pytest.mark.obligation(
    "J1",
    "compiled without fast-math and without heap; interpreted where numba is told so",
    method="named cases",
    control_in="mutants",
)
class TestSettings:
    """What numba is asked for, and in which folder."""

    @pytest.mark.parametrize(("decorator", "is_inlined"), [(jit.jit, False), (jit.jit_inline, True)])
    @pytest.mark.parametrize("compiled", [False, True])
    def test_settings(
        self,
        decorator: Callable[[Callable[[float], float]], Callable[[float], float]],
        is_inlined: bool,
        compiled: bool,
        monkeypatch: pytest.MonkeyPatch,
        tmp_path: Path,
    ) -> None:
        asked: list[dict[str, object]] = []

        def njit(**settings: object) -> Callable[[object], object]:
            def decorate(function: object) -> object:
                asked.append(settings | {"folder": jit._config.CACHE_DIR})
                return function

            return decorate

        before = jit._config.CACHE_DIR
        monkeypatch.setattr(jit, "COMPILED", compiled)
        monkeypatch.setattr(jit, "_CACHE", tmp_path)
        monkeypatch.setattr(numba, "njit", njit)
        assert decorator(_increment) is _increment
        settings = {"cache": True, "fastmath": False, "_nrt": False, "forceinline": is_inlined}
        assert asked == [settings | {"folder": str(tmp_path)}] * compiled
        assert before == jit._config.CACHE_DIR

    def test_lane(self) -> None:
        """Interpreted, nothing is cached, and what overflows to infinity does so in silence, as in machine code."""
        is_interpreted = os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")
        assert jit.COMPILED is not is_interpreted
        assert (jit.cache_directory() is None) is is_interpreted
        if is_interpreted:
            assert (np.geterr()["over"], np.geterr()["invalid"]) == ("ignore", "ignore")


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

"""The law of the readers: a right result, or a typed error, whatever the bytes. Without atheris: changed seeds."""

import random
import sys
from collections.abc import Callable, Sequence

import pytest
from proofs_tests.fuzzing.judging import Breach, Target, judged, require
from proofs_tests.fuzzing.minimising import minimised, mutated
from proofs_tests.fuzzing.targets import TARGETS, UnknownTargetError, target_named
from proofs_tests.fuzzing.triangle_files import contents_of_files

from exactkernel.jit import COMPILED
from exactmesh.errors import ExactMeshError
from exactmesh.io import csv, npz
from exactmesh.io.text import TextFile

#: Changed seeds of each target: compiled, the slow ones are left to the interpreted lane's limits of time.
MUTANTS = 300
SLOW = {"pslg": 60, "rings": 100, "dictionary": 100, "verify": 100, "objects": 100, "foreign": 150}


def breaches(target: Target, inputs: Sequence[bytes]) -> list[tuple[bytes, Breach]]:
    found = [(data, judged(target, data)) for data in inputs]
    return [(data, breach) for data, breach in found if breach is not None]


def changed(target: Target, count: int) -> list[bytes]:
    chance = random.Random(target.name)
    seeds = target.seeds()
    return [mutated(seeds, target.words, chance) for _ in range(count)]


@pytest.mark.obligation(
    "P5",
    "seeds with one to four changes are read, and read again as the same, or refused by a typed error",
    method="fuzzing",
)
class TestEveryReader:
    """Seeds, and seeds with one to four changes: a right result, which is read again as the same when it is written, or
    an ExactMeshError that says what is wrong; no other exception, no warning, no hang, no memory without need."""

    @pytest.mark.parametrize("name", TARGETS)
    def test_changed_seeds(self, name: str, record_property: Callable[[str, object], None]) -> None:
        target = TARGETS[name]
        for seed in target.seeds():  # compiled functions are compiled here, outside of the limits
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr("proofs_tests.fuzzing.judging.SECONDS", 600.0)
                assert judged(target, seed) is None
        count = min(MUTANTS, SLOW.get(name, MUTANTS)) if COMPILED else MUTANTS
        record_property("cases", count + len(target.seeds()))
        assert not breaches(target, changed(target, count))

    @pytest.mark.parametrize("name", TARGETS)
    def test_the_seeds_are_valid(self, name: str) -> None:
        """At least half of the seeds are read: changes begin with what is right."""
        target, refused = TARGETS[name], 0
        seeds = target.seeds()
        for seed in seeds:
            try:
                target.run(seed)
            except ExactMeshError:
                refused += 1
        assert refused <= len(seeds) // 2 or name == "features"

    def test_control_a_reader_that_lets_an_error_through(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """csv's errors are not translated: an exception of another type comes out."""

        monkeypatch.setattr(TextFile, "number", lambda _, text, field, __: field(text))
        target = TARGETS["csv"]
        found = breaches(target, changed(target, 600))
        assert {breach.kind for _, breach in found} >= {"ValueError"}

    def test_control_a_reader_that_reads_something_else(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Numbers are read a little larger: the round trip finds it, the types of errors do not."""
        monkeypatch.setattr(csv, "fast_table", lambda *_: None)
        monkeypatch.setattr(TextFile, "number", lambda _, text, field, __: field(float(text) * (1 + 2**-40)))
        found = breaches(TARGETS["csv"], TARGETS["csv"].seeds()[:1])
        assert [breach.kind for _, breach in found] == ["WrongResultError"]

    def test_wrong_results_of_two_kinds_are_two_findings(self) -> None:
        def wrong(data: bytes) -> None:
            if data == b"1":
                require(False, "one law")
            require(False, "another")

        first, again, other = (judged(Target("wrong", wrong, list), data) for data in (b"1", b"1", b"2"))
        assert first is not None
        assert again is not None
        assert other is not None
        assert first.signature == again.signature != other.signature

    def test_control_an_archive_that_is_taken_at_its_word(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The errors of numpy's header are no longer expected: what fuzzing found first is found again."""
        monkeypatch.setattr(npz, "_BROKEN", (ValueError,))
        found = breaches(TARGETS["members"], changed(TARGETS["members"], 900))
        assert found

    def test_control_an_endless_reader(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A reader that never ends is stopped, and that is a breach."""
        monkeypatch.setattr("proofs_tests.fuzzing.judging.SECONDS", 0.05)

        def endless(data: bytes) -> None:
            while data:
                pass

        breach = judged(Target("endless", endless, list), b"1")
        assert breach is not None
        assert breach.kind == "Hang"

    @pytest.mark.skipif(sys.platform != "linux", reason="the limit of memory is that of Linux")
    def test_control_a_greedy_reader(self) -> None:
        """A reader that takes eight gigabytes is refused them, and that is a breach."""
        breach = judged(Target("greedy", lambda _: require(bytearray(8 << 30), ""), list), b"")
        assert breach is not None
        assert breach.kind == "MemoryError"


class TestMinimising:
    """What is minimised is as bad as before, and no single byte of it can be left out; changes are deterministic."""

    def test_no_byte_can_be_left_out(self) -> None:
        smallest = minimised(bytes(range(200)), lambda data: b"\x10" in data and b"\x90" in data)
        assert smallest == b"\x10\x90"

    def test_a_limit_on_tries(self) -> None:
        asked: list[bytes] = []

        def is_bad(data: bytes) -> bool:
            asked.append(data)
            return b"a" in data

        assert minimised(b"abc" * 50, is_bad, 7)
        assert len(asked) == 7

    def test_the_same_changes_again(self) -> None:
        target = TARGETS["geojson"]
        assert changed(target, 20) == changed(target, 20)
        assert len(set(changed(target, 20))) > 10


class TestTargets:
    """Each has a name; another name is refused by a message that has them all."""

    def test_unknown(self) -> None:
        with pytest.raises(UnknownTargetError, match="'nodes' is no target; there are node, ele"):
            target_named("nodes")

    def test_the_seeds_come_from_the_writers(self) -> None:
        kinds = {kind for files in contents_of_files() for kind in files}
        assert kinds == {"node", "ele", "poly", "neigh", "edge", "area"}

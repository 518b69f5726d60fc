"""The conformance suite: planted faults are found, known failures are found, right meshers pass."""

import numpy as np
import pytest
from proofs_tests.conformance.planted_meshers import PLANTED, PLANTED_DOMAINS, PLANTED_SEGMENTS

from exactmesh import PSLG, Property, verify
from exactmesh.conformance import (
    CORPUS,
    KNOWN,
    LAWS,
    MAX_EXAMPLES,
    MAX_SIZE,
    Behaviour,
    Case,
    Given,
    Outcome,
    Task,
    check,
    retry,
)
from exactmesh.conformance.families import families
from exactmesh.conformance.hunt import explore
from exactmesh.conformance.process import Limits, MesherProcess
from exactmesh.conformance.reference import resolved
from exactmesh.conformance.trial import Clock, Trial

pytestmark = pytest.mark.once


PLACE = "proofs_tests.conformance.planted_meshers"
FAULTS = [
    pytest.param(task, name, law, outcome, id=name)
    for task, planted in zip(Task, (PLANTED, PLANTED_SEGMENTS, PLANTED_DOMAINS), strict=True)
    for name, (law, outcome) in planted.items()
]


class Until(Clock):
    """Time enough, until the trial has the evidence."""

    def __init__(self, trial: Trial, law: str, outcome: str) -> None:
        super().__init__(600.0)
        self.trial, self.law, self.outcome = trial, law, outcome

    @property
    def left(self) -> float:
        return 0.0 if self.found else super().left

    @property
    def found(self) -> bool:
        wanted = next(law for laws in LAWS.values() for law in laws if law == self.law)
        return any(evidence.fault.outcome == self.outcome for evidence in self.trial.worst(wanted))


def is_found(task: Task, name: str, law: str, outcome: str) -> bool:
    """Tell whether the default inputs show the fault: family after family, as ``check`` goes through them."""
    limits = Limits(seconds=1.5 if outcome == Outcome.HANGS else 60.0)  # however busy the machine is
    with MesherProcess(f"{PLACE}:{name}", limits, segments=task is not Task.POINTS) as process:
        trial = Trial(process, task, "ccw")
        clock = Until(trial, law, outcome)
        for family, strategy in families(task, MAX_SIZE).items():
            explore(trial, family, strategy, clock, MAX_EXAMPLES, seed=0)
        return clock.found


@pytest.mark.compiled  # nothing of it is: once is enough
@pytest.mark.obligation(
    "B1", "the conformance suite finds every planted fault within its default budget", method="named cases"
)
class TestPlantedFaults:
    """Law: within its default budget the suite finds the fault of each of thirty faulty meshers, and tells it by its
    name; it finds none in a mesher that has none."""

    @pytest.mark.parametrize(("task", "name", "law", "outcome"), FAULTS)
    def test_is_found(self, task: Task, name: str, law: str, outcome: str) -> None:
        assert is_found(task, name, law, outcome)

    @pytest.mark.parametrize("name", ["right", "noisy"])
    def test_control_no_fault_is_found_where_there_is_none(self, name: str) -> None:
        """A right mesher, and one that prints, in place of those with faults: both are acquitted."""
        result = check(f"{PLACE}:{name}", max_size=12, max_examples=60, deadline=600.0, timeout=60.0)
        assert result.ok, str(result)
        assert result.complete
        assert result.tried > 300

    @pytest.mark.parametrize("task", Task)
    def test_control_exactmesh_has_none(self, task: Task) -> None:
        """exactmesh in place of those with faults: it is acquitted."""
        result = check("exactmesh", kind=task, max_size=20, max_examples=40, deadline=600.0, timeout=60.0)
        assert result.ok, str(result)
        assert result.complete


@pytest.mark.obligation(
    "B2",
    "what was found is told by a small input, which shows the same when it is tried again",
    method="named cases",
)
class TestCounterexamples:
    """Law: of a law that is broken the worst breach is told, by an input from which nothing can be left out, and which,
    tried again by the code or the line that is printed, breaks the law again."""

    @pytest.mark.parametrize(
        ("name", "law", "size"),
        [
            ("drops_a_hull_triangle", "covers_hull", 3),
            ("drops_a_point", "all_points_used", 9),
            ("exits", "answers", 13),
        ],
    )
    def test_is_the_smallest(self, name: str, law: str, size: int) -> None:
        result = check(f"{PLACE}:{name}", properties=[law], max_examples=3, max_size=16, timeout=60.0)
        ruling = next(ruling for known, ruling in result.rulings.items() if known == law)
        assert ruling.counterexample is not None
        given = ruling.counterexample.given
        assert len(given.points) == size
        assert given.points.max() <= 100, given.literal
        again = retry(f"{PLACE}:{name}", given.points)
        assert again.outcome(law) is ruling.outcome

    def test_control_a_larger_input_is_not_the_smallest(self) -> None:
        """An input of ten points, which shows the same fault as the smallest."""
        result = retry(
            f"{PLACE}:drops_a_point", [(0, 0), (1, 0), (0, 1), (5, 5), (7, 3), (2, 9), (3, 3), (8, 1), (9, 9), (4, 0)]
        )
        assert result.outcome("all_points_used") is Outcome.WRONG  # ten points, where nine would do

    def test_the_code_and_the_line_try_it_again(self, capsys: pytest.CaptureFixture[str]) -> None:
        points = [(0.1, -0.0), (1e-300, 0.30000000000000004), (2.0, 5e-324)]
        result = retry(f"{PLACE}:drops_a_hull_triangle", points)
        example = result.rulings[Property.COVERS_HULL].counterexample
        assert example is not None
        exec(example.code, {})
        assert capsys.readouterr().out.strip() == str(result)
        assert example.command.endswith(f'--input "{points}"')

    def test_the_worst_is_told(self) -> None:
        """A mesher that is wrong by rounding on some inputs and grossly on others is told by the others."""
        result = check(f"{PLACE}:float_predicates", properties=["delaunay"], max_examples=25, max_size=12, timeout=60.0)
        assert result.outcome("delaunay") is Outcome.WRONG
        assert not result.ok_but_for_rounding

    def test_rounding_is_kept_apart(self) -> None:
        pytest.importorskip("shapely")
        gentle = retry("geos", CORPUS["5"].make().points)
        assert gentle.outcome("delaunay") is Outcome.ROUNDING
        assert not gentle.ok
        assert gentle.ok_but_for_rounding

    def test_the_same_seed_finds_the_same(self) -> None:
        runs = [check(f"{PLACE}:drops_a_point", properties=["delaunay"], max_examples=10, seed=3) for _ in range(2)]
        literals = [run.rulings[Property.DELAUNAY].counterexample for run in runs]
        assert literals[0] is not None
        assert literals[1] is not None
        assert literals[0].given.literal == literals[1].given.literal
        assert runs[0].tried == runs[1].tried


def failures(cases: dict[str, Case]) -> list[object]:
    return [
        pytest.param(
            case,
            name,
            *failure,
            id=f"{case.name}-{name}",
            marks=[
                pytest.mark.skipif(not KNOWN[name].version, reason=f"needs {KNOWN[name].package}"),
                *([pytest.mark.compiled] if case.name == "9" else []),  # 200,000 points
            ],
        )
        for case in cases.values()
        for name, failure in case.failing.items()
    ]


@pytest.mark.obligation(
    "B3", "the known failures of other meshers are found; exactmesh has none of them", method="named cases"
)
class TestCorpus:
    """Law: the verifier finds every failure of the corpus, and none in exactmesh's answers to the same inputs."""

    @pytest.mark.parametrize(("case", "name", "law", "outcome"), failures(CORPUS))
    def test_is_found(self, case: Case, name: str, law: str, outcome: Outcome) -> None:
        given = case.make()
        result = retry(name, given.points, given.segments, kind=case.task, source=case.source, timeout=120.0)
        assert result.outcome(law) is outcome, str(result)
        assert f"--input {case.source}" in str(result)

    @pytest.mark.parametrize("task", Task)
    def test_control_exactmesh_does_not_fail(self, task: Task) -> None:
        """exactmesh on the same inputs: it is acquitted."""
        cases = [case for case in CORPUS.values() if case.task is task and case.name != "9"]
        with MesherProcess(resolved("exactmesh", task)[0], Limits(60.0), segments=task is not Task.POINTS) as process:
            trial = Trial(process, task, "ccw")
            trial.clock = Clock(600.0)
            for case in cases:
                faults = trial.judgement(case.make())
                assert faults
                assert not any(faults.values()), faults

    def test_every_case_but_one_has_somebody_who_fails(self) -> None:
        assert [case.name for case in CORPUS.values() if not case.failing] == ["8"]

    def test_midpoints_of_slanted_sides_are_off_them(self) -> None:
        """Case 8: Steiner points in doubles. Strictly, the union is not the triangle; within 10^-15 it is."""
        given = CORPUS["8"].make()
        assert given.segments is not None
        middles = (given.points + given.points[[1, 2, 0]]) / 2
        points = np.concatenate([given.points, middles])
        quarters = [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]
        domain = PSLG(given.points, given.segments)
        strict = verify(points, quarters, domain=domain)
        assert not strict.ok
        near = verify(points, quarters, domain=domain, within=1e-15)
        assert near.ok
        assert near.distance is not None
        assert 0 < near.distance < 1e-15

    def test_what_the_cases_are(self) -> None:
        """Counts that were published with them."""
        assert [len(case.make().points) for case in CORPUS.values()] == [4, 15, 300, 5, 100, 200, 6, 3, 200_000, 50]
        assert CORPUS["5"].make().traits == frozenset()


class TestExcuses:
    """Law: an exception is an answer where there is no triangulation, and only there."""

    @pytest.mark.parametrize(
        ("points", "segments", "task", "outcome"),
        [
            ([(0, 0), (1, 1), (2, 2)], None, Task.POINTS, Outcome.HOLDS),
            ([(0, 0), (0, 0), (0, 0)], None, Task.POINTS, Outcome.HOLDS),
            ([(0, 0), (2, 2), (0, 2), (2, 0)], [(0, 1), (2, 3)], Task.SEGMENTS, Outcome.HOLDS),
            ([(0, 0), (1, 0), (0, 1)], None, Task.POINTS, Outcome.REFUSES),
            ([(0, 0), (0, 0), (1, 0), (0, 1)], None, Task.POINTS, Outcome.REFUSES),
            ([(0, 0), (2, 0), (0, 2), (1, 0)], [(0, 1), (0, 3)], Task.SEGMENTS, Outcome.REFUSES),
            ([(0, 0), (5e-324, 0), (0, 1e308)], None, Task.POINTS, Outcome.REFUSES),
        ],
    )
    def test_an_exception(
        self, points: list[tuple[float, float]], segments: list[tuple[int, int]] | None, task: Task, outcome: Outcome
    ) -> None:
        mesher = "refuses_segments" if segments else "refuses"
        result = retry(f"{PLACE}:{mesher}", points, segments, kind=task, timeout=60.0)
        assert result.outcome(Behaviour.ANSWERS) is outcome

    def test_an_empty_domain_excuses(self) -> None:
        """A ring twice: no face is odd."""
        ring = [(0, 1), (1, 2), (2, 0)]
        corners = [(0, 0), (1, 0), (0, 1)]
        given = Given.of(corners * 2, [*ring, *((a + 3, b + 3) for a, b in ring)])
        result = retry(f"{PLACE}:refuses_segments", given.points, given.segments, kind=Task.DOMAIN)
        assert result.ok
        once = retry(f"{PLACE}:refuses_segments", corners, ring, kind=Task.DOMAIN)  # control
        assert once.outcome(Behaviour.ANSWERS) is Outcome.REFUSES

    def test_of_coincident_points_one_will_do(self) -> None:
        assert retry(f"{PLACE}:right", [(0, 0), (1, 0), (0, 1), (0, 0), (-0.0, 1)]).ok
        assert not retry(f"{PLACE}:keeps_duplicates", [(0, 0), (1, 0), (0, 1), (0, 0)]).ok  # control

    def test_a_segment_may_end_in_the_other_of_two_coincident_points(self) -> None:
        given = Given.of([(0, 0), (3, -1), (6, 0), (3, 1), (6, 0)], [(0, 4)])
        assert retry("exactmesh", given.points, given.segments).ok
        assert not retry(f"{PLACE}:ignores_segments", given.points, given.segments).ok  # control

"""The conformance suite: planted faults are found, right meshers pass, whatever a mesher does to its process."""

import pytest
from proofs_tests.planted_meshers import PLANTED, PLANTED_DOMAINS, PLANTED_SEGMENTS

from exactmesh.conformance import LAWS, MAX_EXAMPLES, MAX_SIZE, Task, check
from exactmesh.conformance.families import families
from exactmesh.conformance.hunt import explore
from exactmesh.conformance.process import Limits, MesherProcess
from exactmesh.conformance.trial import Clock, Trial

PLACE = "proofs_tests.planted_meshers"
FAULTS = [
    pytest.param(task, name, law, outcome, id=name)
    for task, planted in zip(Task, (PLANTED, PLANTED_SEGMENTS, PLANTED_DOMAINS), strict=True)
    for name, (law, outcome) in planted.items()
]


def found_within_budget(task: Task, name: str, law: str, outcome: str) -> bool:
    """Tell whether the default inputs show the fault: family after family, as ``check`` goes through them."""
    wanted = next(known for known in LAWS[task] if known == law)
    with MesherProcess(f"{PLACE}:{name}", Limits(seconds=1.0), segments=task is not Task.POINTS) as process:
        trial = Trial(process, task, "ccw")
        for family, strategy in families(task, MAX_SIZE).items():
            explore(trial, family, strategy, Clock(60.0), MAX_EXAMPLES, seed=0)
            if any(evidence.fault.outcome == outcome for evidence in trial.worst(wanted)):
                return True
    return False


@pytest.mark.compiled  # the conformance suite is not: once is enough
@pytest.mark.obligation("X2", "the conformance suite finds each planted fault within its default budget")
class TestPlantedFaults:
    """Law: within its default budget the suite finds the fault of each of three dozen faulty meshers, and tells it by
    its name; it finds none in a mesher that has none."""

    @pytest.mark.parametrize(("task", "name", "law", "outcome"), FAULTS)
    def test_is_found(self, task: Task, name: str, law: str, outcome: str) -> None:
        assert found_within_budget(task, name, law, outcome)

    @pytest.mark.parametrize("name", ["right", "noisy"])
    def test_control_no_fault_is_found_where_there_is_none(self, name: str) -> None:
        result = check(f"{PLACE}:{name}", max_size=12)
        assert result.ok, str(result)
        assert result.complete
        assert result.tried > 5 * MAX_EXAMPLES

    @pytest.mark.parametrize("task", Task)
    def test_control_exactmesh_has_none(self, task: Task) -> None:
        result = check("exactmesh", kind=task, max_size=20)
        assert result.ok, str(result)

"""The hunt: hypothesis draws inputs, family after family; what breaks a law is shrunk to the smallest that does."""

from collections.abc import Callable, Mapping
from random import Random

from hypothesis import HealthCheck, Phase, Verbosity, find, settings
from hypothesis.errors import NoSuchExample
from hypothesis.strategies import SearchStrategy

from exactmesh.conformance.given import Given
from exactmesh.conformance.laws import Law
from exactmesh.conformance.reduction import reduced
from exactmesh.conformance.trial import Clock, Evidence, Trial

__all__ = ["explore", "smallest"]

_PATIENCE = 3  # times that a mesher may hang in one family: each takes as long as a hundred answers
_SHRUNK = 3  # pieces of evidence for one law that are shrunk, the smallest ones


def _find(
    strategy: SearchStrategy[Given], wanted: Callable[[Given], bool], max_examples: int, seed: int
) -> Given | None:
    """Return the smallest input that is wanted, as far as hypothesis can shrink; the same inputs for the same seed."""
    chosen = settings(
        max_examples=max_examples,
        phases=(Phase.generate, Phase.shrink),
        database=None,
        deadline=None,
        verbosity=Verbosity.quiet,
        suppress_health_check=list(HealthCheck),
    )
    try:
        return find(strategy, wanted, settings=chosen, random=Random(seed))
    except NoSuchExample:
        return None


def explore(
    trial: Trial, family: str, strategy: SearchStrategy[Given], clock: Clock, max_examples: int, seed: int
) -> bool:
    """Try the inputs of one family; what they show is kept in the trial. Return whether all had their turn."""
    trial.begin(family, clock, patience=_PATIENCE)

    def never(given: Given) -> bool:
        trial.judgement(given)
        return False

    _find(strategy, never, max_examples, seed)
    return trial.patient


def smallest(
    trial: Trial, law: Law, sources: Mapping[str, SearchStrategy[Given]], max_examples: int, seed: int
) -> Evidence | None:
    """Return the smallest input that breaks a law as badly as any that was found; None if none was.

    First hypothesis shrinks within a family: it draws the same inputs again, whose judgement is known, and goes on from
    the first that is wanted. Then whatever is left is taken away from the arrays. When the trial's clock has run down,
    the smallest found so far is returned.
    """
    found = trial.worst(law)
    if not found:
        return None
    outcome = found[0].fault.outcome

    def breaks(given: Given) -> bool:
        return trial.outcome(given, law) is outcome

    budget = trial.clock
    seeking = [family for family in dict.fromkeys(evidence.source for evidence in found) if family in sources][:_SHRUNK]
    for step, family in enumerate(seeking):
        trial.begin(family, budget.part(1 / (len(seeking) + 1 - step)))
        _find(sources[family], breaks, max_examples, seed)
    for step, evidence in enumerate(trial.worst(law)[:_SHRUNK]):
        trial.begin(evidence.source, budget.part(1 / (_SHRUNK - step)))
        reduced(evidence.given, trial.is_legal, breaks)
    return trial.worst(law)[0]

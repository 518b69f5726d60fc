"""The scoreboard: every known mesher, every law, every case of the corpus, as a page in Markdown."""

import datetime
import math
import platform
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping

from exactmesh.conformance.checking import check, retry
from exactmesh.conformance.corpus import BUNDLES, CORPUS, Case, case_named
from exactmesh.conformance.known import KNOWN, Known
from exactmesh.conformance.laws import LAWS, Outcome, Task
from exactmesh.conformance.process import Limits, MesherProcess
from exactmesh.conformance.reference import resolved
from exactmesh.conformance.result import Conformance, Counterexample
from exactmesh.conformance.trial import Clock, Trial
from exactmesh.errors import MesherError

__all__ = ["scoreboard"]

_TITLES = {
    Task.POINTS: "Points: Delaunay triangulations",
    Task.SEGMENTS: "Segments: constrained Delaunay triangulations of the hull",
    Task.DOMAIN: "Domains: constrained Delaunay triangulations of what segments enclose",
}
_CORPUS_SECONDS, _BUNDLE_SECONDS = 120.0, 5.0
_INTRODUCTION = """# Scoreboard

What the meshers that Python has do with the inputs of [conformance](conformance.md), as the verifier judges it.
`holds` means: on all inputs that were tried. `rounding` is broken by no more than doubles resolve, `refuses` is an
exception though there is a triangulation, `wrong` everything else that is returned, `hangs` is no answer within
{seconds:g} seconds, `dies` is the end of the process. The worst that was found is told, with the smallest input that
was found for it. In brackets stands what is special about that input, where no ordinary one did the same: `duplicates`,
`extreme` (coordinates beyond 2^250 or below 2^-250), `overlap` or `crossing` of segments, `flat` (all points on one
line). Where the time was up before all families had their turn, `holds` says less.

Made by `exactmesh conformance --all --output docs/scoreboard.md` on {date}, on {system}. A mesher is
called as its documentation shows first; how exactly, `exactmesh/conformance/meshers.py` tells. A bound in its
documentation on what it takes is not looked at: all finite doubles are put in.
"""
_FAULTLESS, _EXCUSED = "no fault", "exception"
_BUNDLE_KINDS = (_FAULTLESS, _EXCUSED, *(str(outcome) for outcome in Outcome if outcome is not Outcome.HOLDS))

Tell = Callable[[str], None]


def scoreboard(*, deadline: float = 60.0, timeout: float = 10.0, seed: int = 0, tell: Tell = lambda _what: None) -> str:
    """Return the page. Meshers that are not installed are left out.

    Args:
        deadline: seconds for each mesher and task.
        timeout: seconds for one call.
        seed: the same seed, the same inputs.
        tell: called with what is being done.
    """
    there = {name: known for name, known in KNOWN.items() if known.version}
    parts = [
        _INTRODUCTION.format(
            seconds=timeout,
            date=datetime.datetime.now(datetime.UTC).date().isoformat(),
            system=f"{platform.system()}, {platform.machine()}, Python {platform.python_version()}",
        ),
        _table(("mesher", "package", "version"), ([k.title, k.package, k.version] for k in there.values())),
    ]
    for task in Task:
        results = {}
        for name, known in there.items():
            if task in known.functions:
                tell(f"{known.title}: {task}")
                results[name] = _checked(name, task, deadline, timeout, seed)
        parts.append(_section(task, {name: result for name, result in results.items() if result is not None}))
    parts += [_corpus(there, tell), _bundles(there, tell)]
    return "\n".join(parts)


def _checked(name: str, task: Task, deadline: float, timeout: float, seed: int) -> Conformance | None:
    try:
        return check(name, kind=task, deadline=deadline, timeout=timeout, seed=seed)
    except MesherError:  # it is there, and cannot be imported
        return None


def _table(headings: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    titles = list(headings)
    lines: list[Iterable[str]] = [titles, ["---"] * len(titles), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n"


def _section(task: Task, results: Mapping[str, Conformance]) -> str:
    laws = LAWS[task]
    heading = ["law", *(KNOWN[name].title for name in results)]
    rows = [[f"`{law}`", *(_verdict(result, law) for result in results.values())] for law in laws]
    tried = ["inputs tried", *(f"{r.tried}{'' if r.complete else ', time was up'}" for r in results.values())]
    lines = [f"## {_TITLES[task]}", "", _table(heading, [*rows, tried])]
    for name, result in results.items():
        if examples := list(_examples(result)):
            lines += [f"### {KNOWN[name].title}, {task}", "", *examples]
    return "\n".join(lines)


def _verdict(result: Conformance, law: str) -> str:
    ruling = next(ruling for known, ruling in result.rulings.items() if known == law)
    traits = "" if ruling.counterexample is None else ", ".join(sorted(ruling.counterexample.given.traits))
    shown = str(ruling.outcome) if ruling.outcome is Outcome.HOLDS else f"**{ruling.outcome}**"
    return f"{shown} ({traits})" if traits else shown


def _examples(result: Conformance) -> Iterator[str]:
    """Yield for each input that breaks something what that is, and the line that tries it again."""
    seen: dict[bytes, tuple[Counterexample, list[str]]] = {}
    for law, ruling in result.rulings.items():
        example = ruling.counterexample
        if example is not None:
            said = f"- `{law}` {ruling.outcome}: {_plain(example.sentence)}"
            seen.setdefault(example.given.key, (example, []))[1].append(said)
    for example, sentences in seen.values():
        yield "\n".join([*sentences, "", "```sh", example.command, "```", ""])


def _plain(sentence: str) -> str:
    """Return a sentence of any origin so that Markdown shows it as it is."""
    return f"`{sentence.replace('`', chr(39))}`"


def _corpus(there: Mapping[str, Known], tell: Tell) -> str:
    names = [name for name in there if any(case.task in there[name].functions for case in CORPUS.values())]
    rows = []
    for case in CORPUS.values():
        cells = []
        for name in names:
            tell(f"{case.source}: {there[name].title}")
            cells.append(_on_case(name, there[name], case))
        rows.append([f"{case.name}: {case.title}", *cells])
    return "\n".join(
        [
            "## Corpus",
            "",
            "Inputs on which some mesher is known to fail. `exactmesh conformance MESHER --input corpus:1` tries one",
            "again, with `--segments` for the seventh, with `--domain` for the eighth.",
            "",
            _table(["case", *(there[name].title for name in names)], rows),
        ]
    )


def _on_case(name: str, known: Known, case: Case) -> str:
    if case.task not in known.functions:
        return ""
    given = case.make()
    result = retry(name, given.points, given.segments, kind=case.task, source=case.source, timeout=_CORPUS_SECONDS)
    broken = [f"{law}: {ruling.outcome}" for law, ruling in result.rulings.items() if ruling.counterexample is not None]
    return f"**{'; '.join(broken)}**" if broken else "holds"


def _bundles(there: Mapping[str, Known], tell: Tell) -> str:
    """Count what becomes of segments through nearly one point."""
    rows = []
    for name, known in there.items():
        if Task.SEGMENTS in known.functions:
            tell(f"bundles: {known.title}")
            counts = Counter(_on_bundles(name, known))
            rows.append([known.title, *(str(counts[kind]) for kind in _BUNDLE_KINDS)])
    return "\n".join(
        [
            "### Bundles",
            "",
            f"`corpus:7/0` to `corpus:7/{BUNDLES[-1]}`: three to seven segments through nearly one point. They cross,",
            "so that an exception is an answer; but what comes back has to be a mesh.",
            "",
            _table(["mesher", *_BUNDLE_KINDS], rows),
        ]
    )


def _on_bundles(name: str, known: Known) -> Iterator[str]:
    """Yield what becomes of each bundle, tried in one process."""
    reference, _ = resolved(name, Task.SEGMENTS)
    with MesherProcess(reference, Limits(seconds=_BUNDLE_SECONDS), segments=True) as process:
        trial = Trial(process, Task.SEGMENTS, known.orientation)
        trial.clock = Clock(math.inf)
        for seed in BUNDLES:
            judgement = trial.judgement(case_named(f"7/{seed}").make())
            broken = [fault.outcome for fault in judgement.values() if fault is not None]
            if broken:
                yield str(max(broken, key=tuple(Outcome).index))
            else:
                yield _FAULTLESS if len(judgement) > 1 else _EXCUSED

"""Refinement: all refiners on all cases, the growth on a star, and what a Python callback costs."""

import math
from collections.abc import Sequence

from benchmarks.refining import CALLBACKS, DESCRIPTION, REFINERS
from benchmarks.refining_cases import CASES
from benchmarks.tables import Section, cell
from benchmarks.workers import Outcome, race

__all__ = ["run"]

_STARS = (2_500, 5_000, 10_000, 20_000, 40_000)


def _case_rows(title: str, outcomes: dict[str, Outcome]) -> list[list[str]]:
    own = outcomes["exactmesh-refine"]
    rows = []
    for key, outcome in outcomes.items():
        time = outcome.failure or f"{outcome.median:.2f} s"
        ratio = "" if outcome.failure or own.failure else f"{outcome.median / own.median:.2f}"
        told = outcome.description or [""] * len(DESCRIPTION)
        rows.append([title, REFINERS[key].name, time, ratio, *told])
    return rows


def _growth(before: Outcome | None, now: Outcome) -> str:
    """Return the exponent of the time by the triangles, from row to row."""
    if before is None or before.failure or now.failure or now.count == before.count:
        return ""
    return f"{math.log(now.median / before.median) / math.log(now.count / before.count):.2f}"


def _growth_rows(sizes: Sequence[int], rounds: int) -> list[list[str]]:
    rows = []
    last: dict[str, Outcome] = {}
    for size in sizes:
        outcomes = race(["exactmesh-refine", "triangle-refine"], "star-30", size=size, rounds=rounds)
        own = outcomes["exactmesh-refine"]
        row = [f"{size:,}"]
        for key, outcome in outcomes.items():
            row += [f"{outcome.count:,}", cell(outcome, own).split(",")[0], _growth(last.get(key), outcome)]
        rows.append(row)
        last = outcomes
    return rows


def _callback_rows(size: int | None, rounds: int) -> list[list[str]]:
    outcomes = race(list(CALLBACKS), "square-20", size=size, rounds=rounds)
    built_in = outcomes["by-area"]
    rows = []
    for key, outcome in outcomes.items():
        if outcome.failure or built_in.failure:
            rows.append([CALLBACKS[key].name, outcome.failure, "", "", ""])
            continue
        ratio = outcome.median / built_in.median
        a_triangle = ratio * built_in.count / outcome.count
        times = [f"{outcome.median:.2f} s", f"{ratio:.2f}", f"{a_triangle:.2f}"]
        rows.append([CALLBACKS[key].name, f"{outcome.count:,}", *times])
    return rows


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Race all refiners and write the section ``refine``; a quick run is a hundredth, and not written."""
    section = Section("refine", "Refinement")
    rows = []
    for name, (_, size, title) in CASES.items():
        outcomes = race(list(REFINERS), name, size=size // 100 if quick else None, rounds=rounds)
        rows += _case_rows(title, outcomes)
        print("\n".join(" | ".join(row) for row in rows[-len(outcomes) :]), flush=True)
    section.table(["input", "mesher", "median", "ratio", *DESCRIPTION], rows)
    section.text("What is timed: " + "; ".join(f"{m.name}: {m.note}" for m in REFINERS.values()) + ".")
    section.text(
        "Below the bound: triangles with a smaller angle, compared exactly; at small angles of the input they are "
        "unavoidable. Admissible, Delaunay: by the verifier, with the edges that the mesher calls constrained. Covers "
        "exactly: no point of a segment was rounded off it."
    )
    section.text("Growth on the star, with the exponents of the time by the triangles, from row to row.")
    sizes = _STARS[:2] if quick else _STARS
    head = ["vertices", "exactmesh: triangles", "median", "exponent", "Triangle: triangles", "median", "exponent"]
    section.table(head, _growth_rows(sizes, rounds))
    section.text(
        "The same bound asked in Python: " + "; ".join(f"{m.name}: {m.note}" for m in CALLBACKS.values()) + "."
    )
    head = ["unit square, 20 degrees", "triangles", "median", "ratio", "ratio a triangle"]
    section.table(head, _callback_rows(8_000 if quick else None, rounds))
    if not quick:
        section.write()

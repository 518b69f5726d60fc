"""Constrained Delaunay triangulations: all meshers on all graphs, and the growth with the number of crossings."""

from benchmarks import crossings
from benchmarks.constraining import CONSTRAINERS
from benchmarks.graphs import GRAPHS
from benchmarks.tables import Section, cell
from benchmarks.workers import race

__all__ = ["run"]


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Race all meshers on all graphs and write the section; a quick run is a hundredth, and not written."""
    section = Section("constrained", "Constrained Delaunay triangulations of planar straight line graphs")
    rows = []
    for name, (_, size, title) in GRAPHS.items():
        outcomes = race(list(CONSTRAINERS), name, size=size // 100 if quick else None, rounds=rounds)
        rows.append([title, *(cell(outcome, outcomes["exactmesh-constrained"]) for outcome in outcomes.values())])
        print(" | ".join(rows[-1]), flush=True)
    section.table(["input", *(mesher.name for mesher in CONSTRAINERS.values())], rows)
    section.text("What is timed: " + "; ".join(f"{m.name}: {m.note}" for m in CONSTRAINERS.values()) + ".")
    section.text(
        "Crossings: random segments, with the exponents of the growth from row to row, by segments and meetings."
    )
    section.table(crossings.HEAD, crossings.cells(crossings.random_rows(quick=quick, rounds=rounds), growth=True))
    if not quick:
        section.text("And what breaks simpler searches.")
        section.table(crossings.HEAD, crossings.cells(crossings.hard_rows(rounds=rounds), growth=False))
        section.write()

"""Voronoi diagrams: all peers on all inputs, and what is made of a diagram."""

from benchmarks.diagrams import DIAGRAMS, USES
from benchmarks.inputs import INPUTS
from benchmarks.tables import Section, cell
from benchmarks.workers import race

__all__ = ["run"]


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Race all peers and write the section ``voronoi``; a quick run is a hundredth, and not written."""
    section = Section("voronoi", "Voronoi diagrams")
    rows = []
    for name, (_, size, title) in INPUTS.items():
        outcomes = race(list(DIAGRAMS), name, size=size // 100 if quick else None, rounds=rounds)
        own = outcomes["exactmesh-voronoi"]
        rows.append([title, *(cell(outcome, own).split(",")[0] for outcome in outcomes.values())])
        print(" | ".join(rows[-1]), flush=True)
    section.table(["input", *(mesher.name for mesher in DIAGRAMS.values())], rows)
    section.text("What is timed: " + "; ".join(f"{m.name}: {m.note}" for m in DIAGRAMS.values()) + ".")
    section.text("What is made of the diagram of 1,000,000 uniform points.")
    outcomes = race(list(USES), "uniform", size=10_000 if quick else None, rounds=rounds)
    uses = [[USES[key].name, cell(outcome, outcome), USES[key].note] for key, outcome in outcomes.items()]
    section.table(["what", "median", "what is timed"], uses)
    if not quick:
        section.write()

"""Delaunay triangulations of points: all meshers on all inputs, growth, memory, stages, starts."""

import math

from benchmarks.inputs import INPUTS, points_of
from benchmarks.peers import PEERS
from benchmarks.starts import first_call_seconds, later_start_seconds
from benchmarks.tables import Section, cell
from benchmarks.workers import race
from exactkernel import Stage

__all__ = ["run"]


def _stages(section: Section, quick: bool) -> None:
    from exactmesh import delaunay

    rows = []
    for name, (_, size, title) in INPUTS.items():
        work = delaunay(points_of(name, size // 100 if quick else None)).work
        for label, counts in (("orient2d", work.orient2d), ("incircle", work.incircle)):
            rows.append([title if label == "orient2d" else "", label, *(f"{counts[stage]:,}" for stage in Stage)])
    section.text("How often each stage decided (rational: gmpy2, by callback).")
    section.table(["input", "predicate", *(stage.name.lower().replace("_", "-") for stage in Stage)], rows)


def _growth(section: Section, quick: bool) -> None:
    sizes = [10_000, 100_000] if quick else [10_000, 100_000, 1_000_000, 10_000_000]
    outcomes = {
        size: race(["exactmesh", "triangle"], "uniform", size=size, rounds=3 if size > 10**6 else 5) for size in sizes
    }
    rows = []
    for key in ("exactmesh", "triangle"):
        done = {size: outcome[key] for size, outcome in outcomes.items() if outcome[key].seconds}
        first, last = min(done), max(done)
        exponent = math.log(done[last].median / done[first].median) / math.log(last / first)
        rows.append(
            [
                PEERS[key].name,
                *(f"{outcome[key].median:.3f} s" for outcome in outcomes.values()),
                f"{exponent:.3f}",
                f"{done[last].bytes_per_point:.0f}",
            ]
        )
    section.text("Growth on uniform points: the exponent between the first and the last size, and peak memory.")
    section.table(["mesher", *(f"{size:,}" for size in sizes), "exponent", "peak bytes per point"], rows)


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Race all meshers on all inputs and write the section; a quick run is a hundredth, and not written."""
    section = Section("delaunay", "Delaunay triangulations of points")
    rows = []
    for name, (_, size, title) in INPUTS.items():
        outcomes = race(list(PEERS), name, size=size // 100 if quick else None, rounds=rounds)
        rows.append([title, *(cell(outcome, outcomes["exactmesh"]) for outcome in outcomes.values())])
        print(" | ".join(rows[-1]), flush=True)
    section.table(["input", *(peer.name for peer in PEERS.values())], rows)
    section.text("What is timed: " + "; ".join(f"{peer.name}: {peer.note}" for peer in PEERS.values()) + ".")
    _stages(section, quick)
    _growth(section, quick)
    inside, whole = later_start_seconds()
    section.text(
        f"First call ever on a machine, compilation included: {first_call_seconds():.1f} s. Import and a 100-point "
        f"call in a later process: {inside:.2f} s ({whole:.2f} s for the whole process)."
    )
    if not quick:
        section.write()

"""The verifier against the time it takes to build the mesh that it verifies."""

from benchmarks.tables import Section
from benchmarks.verifying import VERIFIERS
from benchmarks.workers import race

__all__ = ["run"]


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Verify the mesh of a million uniform points beside building it with Triangle; write the section ``verify``."""
    section = Section("verify", "Verifying a mesh of 2,000,000 triangles")
    outcomes = race(["triangle", *VERIFIERS], "uniform", size=10_000 if quick else None, rounds=rounds)
    build = outcomes["triangle"]
    rows = [["Triangle builds it", f"{build.median:.3f} s", "1.00"]]
    for key, verifier in VERIFIERS.items():
        outcome = outcomes[key]
        if outcome.failure:
            rows.append([verifier.name, outcome.failure, ""])
        else:
            rows.append([verifier.name, f"{outcome.median:.3f} s", f"{outcome.median / build.median:.2f}"])
    section.table(["what", "median", "ratio to building"], rows)
    section.text("Everything up to Delaunay is claimed and proven; acuteness is decided and reported as well.")
    if not quick:
        section.write()

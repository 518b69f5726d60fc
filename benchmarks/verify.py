"""The verifier against the time it takes the peers to build the mesh that it verifies, and its memory."""

from collections.abc import Mapping, Sequence

from benchmarks.constraining import CONSTRAINERS
from benchmarks.memory import bytes_per_triangle
from benchmarks.peers import PEERS, Mesher
from benchmarks.tables import Section
from benchmarks.verifying import CONSTRAINED_VERIFIERS, VERIFIERS
from benchmarks.workers import race

__all__ = ["run"]

_BUILDERS = ("exactmesh", "triangle", "cgal", "cdt")
_CONSTRAINED_BUILDERS = tuple(f"{name}-constrained" for name in _BUILDERS)

#: title, input, its size, and what races.
_RACES: tuple[tuple[str, str, int, Sequence[str], Mapping[str, Mesher]], ...] = (
    ("1,000,000 uniform points", "uniform", 1_000_000, _BUILDERS, VERIFIERS),
    (
        "500,000 random segments that do not cross",
        "scattered",
        500_000,
        _CONSTRAINED_BUILDERS,
        CONSTRAINED_VERIFIERS,
    ),
    ("one segment across 1,000,000 points", "across", 1_000_000, _CONSTRAINED_BUILDERS, CONSTRAINED_VERIFIERS),
)
_SIZES = (1_000_000, 2_500_000, 5_000_000, 10_000_000)  # points, half as many as triangles


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Verify meshes of two million triangles beside building them, then larger ones; write the section ``verify``."""
    section = Section("verify", "Verifying a mesh of 2,000,000 triangles")
    meshers = {**PEERS, **CONSTRAINERS}
    for title, name, size, builders, verifiers in _RACES:
        outcomes = race([*builders, *verifiers], name, size=size // 100 if quick else size, rounds=rounds)
        peers = [outcomes[key].median for key in builders[1:] if not outcomes[key].failure]
        rows = []
        for key in (*builders, *verifiers):
            outcome = outcomes[key]
            label = verifiers[key].name if key in verifiers else f"{meshers[key].name} builds it"
            if outcome.failure:
                rows.append([label, outcome.failure, ""])
            else:
                ratio = f"{outcome.median / min(peers):.2f}" if peers else ""
                rows.append([label, f"{outcome.median:.3f} s", ratio])
        section.table([title, "median", "ratio to the fastest peer"], rows)
    section.text(
        "Claimed and proven: all up to Delaunay, with segments all up to constrained Delaunay; the other properties "
        "that need no more input are decided and reported as well, acuteness with witnesses."
    )
    rows = []
    for size in _SIZES[: 1 if quick else None]:
        triangles, growth, seconds = bytes_per_triangle(size // 100 if quick else size)
        rows.append([f"{triangles:,}", f"{growth:.0f}", f"{seconds:.2f} s"])
    section.table(["triangles", "bytes a triangle", "one run"], rows)
    section.text(
        "Bytes: growth of the process's peak memory during `verify`, beside the arrays that are verified, which are 20 "
        "bytes a triangle (float64 points, int32 triangles)."
    )
    if not quick:
        section.write()

"""docs/mutation.md: the score of each file, and the survivors under the reasons why they survive."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from proofs_tests.mutation.campaign import Result
from proofs_tests.mutation.survivors import Survivors, described

__all__ = ["page"]

_HEAD = """\
# Mutation testing

Can the tests fail? One place of the source is changed at a time, on a copy: a sign, a comparison, a constant, a
condition. The tests that run the changed line, interpreted, must notice. The mutants are those of
[cosmic-ray](https://pypi.org/project/cosmic-ray/), of each operator of the language the one or two replacements
that are hardest to tell from the original. What no test can see is not mutated: annotations, type aliases,
decorators that compile.

Mutated are the kernel, `quadedge.py`, `edgealgebra.py`, `delaunay.py`, `lawson.py`, `constrain.py`, and the
verifier. `python -m proofs_tests.mutation` tries them, as `CONTRIBUTING.md` tells, and writes this page with
`--page`. One process imports and collects everything; each mutant is a fork of it in which the code of one function
is exchanged, so that it costs as much as the tests that kill it. A test counts as a killer only if it passes
without the mutant, in the same way of running it. What was killed once is not tried again until its line changes.
At every commit CI tries 200 mutants, others each time, of those that are not listed below, and fails if fewer than
95 % of them are killed.

*The same* counts the mutants that mean the same program, listed below with the reason why; *score* is of the
others. A test holds the lists to the source of today.
"""


def page(results: Sequence[Result], survivors: Survivors) -> str:
    """Return docs/mutation.md: the score of each file, and the survivors under the reasons why."""
    total, killed, same = Counter[str](), Counter[str](), Counter[str]()
    for result in results:
        for name in ("all", f"`{Path(result.mutant.file).relative_to(Path(result.mutant.file).parts[0])}`"):
            total[name] += 1
            killed[name] += not result.alive
            same[name] += result.alive and described(result.mutant) in survivors.reasons
    alive = [described(result.mutant) for result in results if result.alive]
    return "\n".join(
        [
            _HEAD,
            "| file | mutants | killed | the same | score |",
            "|---|---:|---:|---:|---:|",
            *(
                _row(name, total[name], killed[name], same[name])
                for name in ["all", *sorted(total - Counter(all=total["all"]))]
            ),
            "",
            "## The survivors, and why each is the same program",
            "",
            *(
                line
                for reason in dict.fromkeys(survivors.reasons.values())
                for line in _group(reason, alive, survivors)
            ),
            *_unexplained(alive, survivors),
        ]
    )


def _row(name: str, total: int, killed: int, same: int) -> str:
    return f"| {name} | {total:,} | {killed:,} | {same} | {killed / max(total - same, 1):.1%} |"


def _group(reason: str, alive: Sequence[str], survivors: Survivors) -> list[str]:
    there = sorted({mutant for mutant in alive if survivors.reasons.get(mutant) == reason})
    return [f"**{reason}**", "", *_list(there)] if there else []


def _unexplained(alive: Sequence[str], survivors: Survivors) -> list[str]:
    there = sorted({mutant for mutant in alive if mutant not in survivors.reasons})
    return ["## Survivors without a reason", "", *_list(there)] if there else []


def _list(mutants: Sequence[str]) -> list[str]:
    return [*(f"- `{mutant}`" for mutant in mutants), ""]

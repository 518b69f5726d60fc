"""docs/mutation.md: the score of each file, and the survivors under the reasons why they survive."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from proofs_tests.mutation.campaign import Result
from proofs_tests.mutation.survivors import Survivors, described

__all__ = ["Scores", "name_of", "page"]

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

Not mutated are `+=` and its kin, which cosmic-ray leaves alone, and no statement is taken out.

*By the clock* counts those of the killed that a test did not end with in the time it has without them, five times
over and four seconds. *The same* counts the mutants that mean the same program, listed below with the reason why;
*score* is of the others. A test holds the lists to the source of today, and this page to the bar.
"""


@dataclass(frozen=True)
class Scores:
    """How many mutants each file has, how many of them were killed, and how many mean the same program."""

    total: Counter[str] = field(default_factory=Counter)
    killed: Counter[str] = field(default_factory=Counter)
    late: Counter[str] = field(default_factory=Counter)
    same: Counter[str] = field(default_factory=Counter)

    @classmethod
    def told(cls, text: str) -> "Scores":
        """Read the table of a page."""
        scores = cls()
        for name, *numbers in re.findall(r"^\| (\S+) \| ([\d,]+) \| ([\d,]+) \| (\d+) \| (\d+) \|", text, re.MULTILINE):
            for counts, number in zip((scores.total, scores.killed, scores.late, scores.same), numbers, strict=True):
                counts[name] = int(number.replace(",", ""))
        return scores

    def of(self, name: str) -> float:
        """Return the part that was killed of the mutants that do not mean the same program."""
        return self.killed[name] / max(self.total[name] - self.same[name], 1)

    def row(self, name: str) -> str:
        """Return the row of a file."""
        numbers = f"{self.total[name]:,} | {self.killed[name]:,} | {self.late[name]} | {self.same[name]}"
        return f"| {name} | {numbers} | {self.of(name):.2%} |"


def name_of(file: str) -> str:
    """Return a file's name in the table."""
    return f"`{file.partition('/')[2]}`"


def page(results: Sequence[Result], survivors: Survivors) -> str:
    """Return docs/mutation.md: the score of each file, and the survivors under the reasons why."""
    score = Scores()
    for result in results:
        for name in ("all", name_of(result.mutant.file)):
            score.total[name] += 1
            score.killed[name] += not result.alive
            score.late[name] += result.outcome == "timeout"
            score.same[name] += result.alive and described(result.mutant) in survivors.reasons
    alive = [described(result.mutant) for result in results if result.alive]
    return "\n".join(
        [
            _HEAD,
            "| file | mutants | killed | by the clock | the same | score |",
            "|---|---:|---:|---:|---:|---:|",
            *(score.row(name) for name in ["all", *sorted(set(score.total) - {"all"})]),
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


def _group(reason: str, alive: Sequence[str], survivors: Survivors) -> list[str]:
    there = sorted({mutant for mutant in alive if survivors.reasons.get(mutant) == reason})
    return [f"**{reason}**", "", *_list(there)] if there else []


def _unexplained(alive: Sequence[str], survivors: Survivors) -> list[str]:
    there = sorted({mutant for mutant in alive if mutant not in survivors.reasons})
    return ["## Survivors without a reason", "", *_list(there)] if there else []


def _list(mutants: Sequence[str]) -> list[str]:
    return [*(f"- `{mutant}`" for mutant in mutants), ""]

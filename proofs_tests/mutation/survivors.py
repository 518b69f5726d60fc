"""The mutants that no test can kill, and why: read from survivors/*.toml, which people write."""

import tomllib
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from proofs_tests.mutation.campaign import Result
from proofs_tests.mutation.mutants import Mutant

__all__ = ["Survivors", "described", "page"]

FOLDER = Path(__file__).with_name("survivors")


def described(mutant: Mutant) -> str:
    """Return a line that tells the mutant from others, and stays true when other lines move."""
    name = Path(mutant.file).with_suffix("")
    return f"{'/'.join(name.parts[1:])} {mutant.function}: {mutant.before} -> {mutant.after()}"


@dataclass(frozen=True)
class Survivors:
    """Each listed mutant and the reason why it means the same program."""

    reasons: dict[str, str]

    @classmethod
    def listed(cls, folder: Path = FOLDER) -> "Survivors":
        """Read the lists: tables [[equivalent]] with a reason and mutants, as ``described`` writes them."""
        texts = [path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.toml"))]
        groups = [group for text in texts for group in tomllib.loads(text)["equivalent"]]
        return cls({mutant: group["reason"] for group in groups for mutant in group["mutants"]})

    def unexplained(self, results: Iterable[Result]) -> list[Result]:
        """Return what survived without being listed."""
        return [result for result in results if result.alive and described(result.mutant) not in self.reasons]


def page(results: Sequence[Result], survivors: Survivors) -> str:
    """Return docs/mutation.md: the score of each file, and the survivors under the reasons why."""
    total, killed = Counter[str](), Counter[str]()
    for result in results:
        total[result.mutant.file] += 1
        killed[result.mutant.file] += not result.alive
    rows = [
        f"| `{file}` | {total[file]} | {killed[file]} | {killed[file] / total[file]:.1%} |" for file in sorted(total)
    ]
    everything = f"| all | {total.total()} | {killed.total()} | {killed.total() / total.total():.1%} |"
    alive = [described(result.mutant) for result in results if result.alive]
    return "\n".join(
        [
            *_HEAD,
            "| file | mutants | killed | score |",
            "|---|---|---|---|",
            everything,
            *rows,
            "",
            "## The survivors, and why each is equivalent",
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


_HEAD = [
    "# Mutation testing",
    "",
    "Can the tests fail? One place of the source is changed at a time (a sign, a comparison, a constant, a condition),",
    "on a copy, and the tests that run the changed line must notice. Made by `python -m proofs_tests.mutation --page`",
    "(see CONTRIBUTING.md); CI tries a sample of 200 mutants that differs from commit to commit.",
    "",
]

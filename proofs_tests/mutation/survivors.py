"""The mutants that no test can kill, and why: read from survivors/*.toml, which people write."""

import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from proofs_tests.mutation.campaign import Result
from proofs_tests.mutation.mutants import Mutant

__all__ = ["Survivors", "described"]

FOLDER = Path(__file__).with_name("survivors")


def described(mutant: Mutant) -> str:
    """Return a line that tells the mutant from others, and stays true when other lines move."""
    return f"{_place(mutant)} -> {mutant.after()}"


def _place(mutant: Mutant) -> str:
    name = Path(mutant.file).with_suffix("")
    return f"{'/'.join(name.parts[1:])} {mutant.function}: {mutant.before}"


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

    def refuted(self, results: Iterable[Result]) -> list[Result]:
        """Return what is listed though a test kills it, unless a mutant of the same words survives."""
        places = {mutant[: arrow.start()] for mutant in self.reasons for arrow in re.finditer(" -> ", mutant)}
        near = [result for result in results if _place(result.mutant) in places]  # to make a mutant takes its time
        alive = {described(result.mutant) for result in near if result.alive}
        listed = (result for result in near if not result.alive and described(result.mutant) in self.reasons)
        return [result for result in listed if described(result.mutant) not in alive]

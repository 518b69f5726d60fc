"""The mutants that no test can kill, and why: read from survivors/*.toml, which people write."""

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

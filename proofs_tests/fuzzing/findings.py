"""What fuzzing found, as files: the bytes, and beside them what they do."""

from pathlib import Path

from proofs_tests.fuzzing.judging import Breach

__all__ = ["known", "written"]


def known(folder: Path, target: str) -> set[str]:
    """Return the signatures of what has been found of a target."""
    return {path.read_text(encoding="utf-8").partition("\n")[0] for path in folder.glob(f"{target}-*.txt")}


def written(folder: Path, target: str, data: bytes, breach: Breach) -> Path:
    """Write a finding, and return the path of its bytes."""
    number = 1
    while (path := folder / f"{target}-{number}.bin").exists():
        number += 1
    path.write_bytes(data)
    path.with_suffix(".txt").write_text(f"{breach.signature}\n{breach.message}\n{data!r}\n", encoding="utf-8")
    return path

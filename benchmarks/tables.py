"""Tables: to the terminal by rich, and into docs/benchmarks.md, each command in a section of its own."""

import platform
import re
from collections.abc import Sequence
from datetime import date
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks.peers import PEERS, Mesher, version_of
from benchmarks.workers import Outcome

__all__ = ["Section", "cell", "machine"]

_PAGE = Path(__file__).resolve().parent.parent / "docs" / "benchmarks.md"
_HEAD = """# Benchmarks

Side by side in one run on one machine: each mesher in a process of its own, taking turns round after round; medians,
and in parentheses the ratio to exactmesh (2.0: it takes twice as long). Rerun with `python -m benchmarks delaunay`,
`constrained`, `refine`, `voronoi`, `verify` and `strategies` after `pip install '.[bench]'`; each run rewrites its
section.
"""


def machine() -> str:
    """Return one line about the machine and the versions."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        found = re.search(r"model name\s*:\s*(.*)", cpuinfo.read_text())
        model = found.group(1).strip() if found else model
    versions = ", ".join(_name(peer) + " " + version_of(peer.package) for peer in PEERS.values())
    libraries = ", ".join(f"{name} {version_of(name)}" for name in ("numpy", "numba", "gmpy2"))
    return (
        f"{date.today().isoformat()}, {model}, {platform.system()}, Python {platform.python_version()}; "
        f"{versions}; {libraries}. One thread."
    )


def _name(peer: Mesher) -> str:
    """Return the mesher's name, and that of the package, whose version it is, if it is another."""
    name = peer.name.lower()
    return peer.name if name in peer.package or peer.package in name else f"{peer.name} ({peer.package})"


class Section:
    """What one command prints, collected for the page."""

    def __init__(self, name: str, title: str) -> None:
        self._name = name
        self._console = Console()
        self._parts = [f"## {title}", machine()]
        self._console.rule(title)

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self._console.print(text)
        self._parts.append(text)

    def table(self, head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Add a table."""
        table = Table(*head)
        for row in rows:
            table.add_row(*row)
        self._console.print(table)
        lines = [head, ["---"] * len(head), *rows]
        self._parts.append("\n".join("| " + " | ".join(line) + " |" for line in lines))

    def write(self) -> None:
        """Put the section into the page, in the place of its last version."""
        page = _PAGE.read_text(encoding="utf-8") if _PAGE.exists() else _HEAD
        begin, end = f"<!-- begin {self._name} -->", f"<!-- end {self._name} -->"
        body = "\n\n".join([begin, *self._parts, end])
        if begin in page:
            before, rest = page.split(begin, 1)
            page = before + body + rest.split(end, 1)[1]
        else:
            page = page.rstrip() + "\n\n" + body + "\n"
        _PAGE.write_text(page, encoding="utf-8")
        self._console.print(f"written to {_PAGE}")


def cell(outcome: Outcome, own: Outcome) -> str:
    """Return a median with its ratio to the own one, or why there is none."""
    if outcome.failure:
        return outcome.failure
    cell = f"{outcome.median:.3f} s"
    if outcome is not own and own.seconds:
        cell += f" ({outcome.median / own.median:.2f})"
        if outcome.count != own.count:
            cell += f", {outcome.count - own.count:+d} triangles"
    return cell

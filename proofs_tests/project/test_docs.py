"""The documentation holds together: citation keys, pages, links, public names."""

import re
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import pytest

import exactkernel
import exactmesh

pytestmark = pytest.mark.once


ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
REFERENCES = DOCS / "references.md"
PAGES = sorted(DOCS.glob("*.md"))
READ_AT_THE_TOP = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
SOURCES = sorted(
    path for folder in ("kernel", "mesh", "proofs_tests", "benchmarks") for path in ROOT.glob(f"{folder}/**/*.py")
)

_KEY = r"\[[A-Z][A-Za-z]+\s\d{4}\]"


def keys_in(text: str) -> set[str]:
    """Return the citation keys of a text, those that are broken by a line end (in a comment, say) included."""
    flowing = re.sub(r"\s*\n\s*(?:#:?\s*)?", " ", text)
    return set(re.findall(_KEY, flowing))


def defined_keys(text: str) -> list[str]:
    """Return the keys that the items of the page of references define."""
    return re.findall(rf"^- \*\*({_KEY})\*\*", text, flags=re.MULTILINE)


def unresolved(texts: Iterable[str], references: str) -> set[str]:
    """Return the keys that are used in the texts and not defined on the page."""
    used: set[str] = set().union(*map(keys_in, texts))
    return used - set(defined_keys(references))


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


class TestReferences:
    """Law: the keys that are used are those that docs/references.md defines, each once."""

    citing = tuple(path for path in (*SOURCES, *PAGES, *READ_AT_THE_TOP) if path not in (REFERENCES, Path(__file__)))
    used = tuple(map(text_of, citing))

    def test_every_key_resolves(self) -> None:
        assert len(set().union(*map(keys_in, self.used))) > 10
        assert unresolved(self.used, text_of(REFERENCES)) == set()

    def test_every_reference_is_used_and_defined_once(self) -> None:
        defined = defined_keys(text_of(REFERENCES))
        assert defined == sorted(set(defined))
        assert set(defined) <= set().union(*map(keys_in, self.used))

    @pytest.mark.parametrize("text", ["as in [Nobody 1999].", "as in [Nobody\n    1999].", "# as in [Nobody\n# 1999]"])
    def test_control_an_unknown_key_is_found(self, text: str) -> None:
        assert unresolved([text], text_of(REFERENCES)) == {"[Nobody 1999]"}

    def test_control_a_missing_reference_is_found(self) -> None:
        without = text_of(REFERENCES).replace("- **[Guibas 1985]**", "- [Guibas 1985]")
        assert unresolved(self.used, without) == {"[Guibas 1985]"}


def listed_pages(index: str) -> list[str]:
    """Return the entries of the tables of contents."""
    blocks = re.findall(r"^```\{toctree\}\n(.*?)^```", index, flags=re.MULTILINE | re.DOTALL)
    return [line for block in blocks for line in block.split("\n") if line and not line.startswith(":")]


class TestPages:
    """Law: the tables of contents list each page of docs/ once, and nothing else."""

    def test_contents_are_the_pages(self) -> None:
        assert sorted(listed_pages(text_of(DOCS / "index.md"))) == sorted(p.stem for p in PAGES if p.stem != "index")

    def test_control_a_page_that_is_not_listed_is_found(self) -> None:
        index = text_of(DOCS / "index.md").replace("\nkernel\n", "\n")
        assert {page.stem for page in PAGES} - set(listed_pages(index)) == {"index", "kernel"}


def slug(heading: str) -> str:
    """Return the anchor of a heading, as GitHub and MyST make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def dead_links(text: str, folder: Path) -> list[str]:
    """Return the relative links that lead to no file, or to no heading of a page; with # they stay on their own."""
    dead = []
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        path = folder / name
        there = text if not name else text_of(path) if path.suffix == ".md" and path.exists() else ""
        headings = re.findall(r"^#+ (.*)$", there, flags=re.MULTILINE)
        if not path.exists() or (anchor and anchor not in map(slug, headings)):
            dead.append(target)
    return dead


class TestLinks:
    """Law: a relative link leads to a file of the project, and its anchor to a heading there."""

    @pytest.mark.parametrize("page", [*PAGES, *READ_AT_THE_TOP], ids=lambda page: page.name)
    def test_links_lead_somewhere(self, page: Path) -> None:
        assert dead_links(text_of(page), page.parent) == []

    def test_control_dead_links_are_found(self) -> None:
        text = "[a](nowhere.md) [b](kernel.md#ties) [c](kernel.md#no-such) [d](https://example.org) [e](#f) [g](#h)"
        assert dead_links(f"{text}\n## H\n", DOCS) == ["nowhere.md", "kernel.md#no-such", "#f"]


def undocumented(names: Iterable[str], page: str) -> set[str]:
    """Return the names that no directive of the page documents."""
    told = re.findall(r"^\.\. (?:auto|py:)\w+:: (?:[\w.]+\.)?(\w+)$", page, flags=re.MULTILINE)
    return set(names) - set(told)


def is_error(package: ModuleType, name: str) -> bool:
    value = getattr(package, name)
    return isinstance(value, type) and issubclass(value, Exception)


class TestApi:
    """Law: the page of the API documents every public name; errors come from exactmesh.errors as a whole."""

    names = frozenset(
        name for package in (exactkernel, exactmesh) for name in package.__all__ if not is_error(package, name)
    )

    def test_every_public_name_is_documented(self) -> None:
        assert len(self.names) > 30
        assert undocumented(self.names, text_of(DOCS / "api.md")) == set()

    def test_control_a_missing_name_is_found(self) -> None:
        page = text_of(DOCS / "api.md").replace(".. autofunction:: lawson\n", "")
        assert undocumented(self.names, page) == {"lawson"}

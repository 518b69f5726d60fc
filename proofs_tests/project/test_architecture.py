"""Imports point one way, and the examples in the documentation run."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
KERNEL, MESH = ROOT / "kernel" / "exactkernel", ROOT / "mesh" / "exactmesh"

#: Rooms that talk to people and files: algorithms know nothing of them.
OUTER_ROOMS = (
    *("io", "plot", "cli", "cli_arguments", "cli_files", "demo", "progress", "summary", "triangle"),
    *("certificate_file", "conformance", "html", "triangulate_file", "verify_file", "__main__"),
    *("triangulate_command", "verify_command"),
)
#: What the verifier may know of exactmesh: no algorithm, nothing that one is made of.
VERIFIER_MAY = ("exactmesh.verify", "exactmesh.errors")
#: The adapters turn objects into arrays for it, and know no algorithm either, but the formats of files.
ADAPTERS_MAY = (*VERIFIER_MAY, "exactmesh.adapters", "exactmesh.io")
#: Who may ask them for anybody's meshes, besides the outer rooms.
ADAPTED = ("exactmesh.adapters", "exactmesh.conformance")
#: What a module may import within a function only: a report's page is made in a room of its own when it is asked for,
#: and a mesh that is not given as arrays is taken apart there.
LATER = {"exactmesh.verify.report": "exactmesh.html", "exactmesh.verify.given": "exactmesh.adapters"}
#: Where everything comes together.
EXEMPT = ("exactmesh", *(f"exactmesh.{room}" for room in OUTER_ROOMS))


def module_name(path: Path, package: Path) -> str:
    parts = path.relative_to(package.parent).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__")


def imports(source: str) -> Iterator[str]:
    """Yield every module that is imported, for type checking only included, wherever in the file."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            assert node.module is not None
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def at_once(source: str) -> str:
    """Return the source without its functions and classes."""
    tree = ast.parse(source)
    tree.body = [node for node in tree.body if not isinstance(node, ast.FunctionDef | ast.ClassDef)]
    return ast.unparse(tree)


def is_within(name: str, room: str) -> bool:
    return name == room or name.startswith(room + ".")


def forbidden(module: str, source: str) -> list[str]:
    """Return the imports that the module must not have."""
    wrong = []
    for name in imports(source):
        if module.startswith("exactkernel"):
            bad = is_within(name, "exactmesh")
        elif is_within(module, "exactmesh.verify"):
            bad = is_within(name, "exactmesh") and not any(is_within(name, room) for room in VERIFIER_MAY)
            bad = bad and name != "exactmesh"
        elif is_within(module, "exactmesh.adapters"):
            bad = is_within(name, "exactmesh") and not any(is_within(name, room) for room in ADAPTERS_MAY)
            bad = bad and name != "exactmesh"
        elif module == "exactmesh.errors":
            bad = is_within(name, "exactmesh") and not is_within(name, "exactmesh.verify")
        elif any(is_within(module, room) for room in EXEMPT[1:]) or module == "exactmesh":
            bad = False
        else:
            bad = any(is_within(name, f"exactmesh.{room}") for room in OUTER_ROOMS)
            adapted = any(is_within(module, room) for room in ADAPTED)
            bad = bad or (is_within(name, "exactmesh.adapters") and not adapted)
        if bad and module in LATER and is_within(name, LATER[module]):
            bad = name in imports(at_once(source))
        if bad:
            wrong.append(name)
    return wrong


SOURCES = [(module_name(path, package), path) for package in (KERNEL, MESH) for path in sorted(package.rglob("*.py"))]


@pytest.mark.obligation("V1", "the verifier imports no algorithm, the kernel nothing of the mesh", method="named cases")
class TestImportDirections:
    """exactkernel imports nothing of exactmesh; the verifier no algorithm; algorithms neither files nor pictures nor
    the command."""

    @pytest.mark.parametrize(("module", "path"), SOURCES, ids=[module for module, _ in SOURCES])
    def test_module(self, module: str, path: Path) -> None:
        assert not forbidden(module, path.read_text(encoding="utf-8"))

    @pytest.mark.parametrize(
        ("module", "line"),
        [
            ("exactkernel.orient2d", "from exactmesh.errors import TopologyError"),
            ("exactkernel.orient2d", "def f():\n    import exactmesh.verify"),
            ("exactmesh.verify.mesh", "from exactmesh.lawson import flip"),
            ("exactmesh.verify.mesh", "from exactmesh.connectivity import neighbors_of"),
            ("exactmesh.verify.mesh", "from exactmesh import delaunay"),
            ("exactmesh.verify.report", "from exactmesh.html import page_of"),
            ("exactmesh.verify.mesh", "def f():\n    from exactmesh.html import page_of"),
            ("exactmesh.adapters.own", "from exactmesh.delaunay import delaunay"),
            ("exactmesh.delaunay", "from exactmesh.adapters import given_mesh"),
            ("exactmesh.verify.verifier", "from exactmesh.adapters import given_mesh"),
            ("exactmesh.verify.mesh", "def f():\n    from exactmesh.adapters import given_mesh"),
            ("exactmesh.delaunay", "from exactmesh.io import files"),
            ("exactmesh.delaunay", "from exactmesh import plot"),
            ("exactmesh.quadedge", "import exactmesh.cli"),
        ],
    )
    def test_control_a_wrong_import_is_noticed(self, module: str, line: str) -> None:
        """Imports the other way, within functions too."""
        assert forbidden(module, line)

    def test_all_sources_are_seen(self) -> None:
        names = {module for module, _ in SOURCES}
        assert {"exactkernel", "exactmesh", "exactmesh.verify.verifier", "exactmesh.delaunay"} <= names


DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def run_blocks(text: str, name: str) -> int:
    """Run the python blocks of a document, one after the other in one namespace; return how many there are."""
    namespace: dict[str, object] = {"__name__": "__document__"}
    blocks = list(BLOCK.finditer(text))
    for block in blocks:
        padding = "\n" * text.count("\n", 0, block.start(1))  # so that a traceback shows the line in the document
        exec(compile(padding + block.group(1), name, "exec"), namespace)
    return len(blocks)


@pytest.mark.once
@pytest.mark.obligation("W1", "every Python block of the README and of docs/ runs as it stands", method="named cases")
class TestDocuments:
    """Every ```python block of the README and of docs/ runs as it stands, in an empty folder."""

    @pytest.mark.parametrize("path", DOCUMENTS, ids=[str(path.relative_to(ROOT)) for path in DOCUMENTS])
    def test_blocks(self, path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.chdir(tmp_path)
        text = path.read_text(encoding="utf-8")
        assert run_blocks(text, str(path)) == text.count("```python")

    def test_control_blocks_share_names_and_can_fail(self) -> None:
        """A block whose assertion does not hold."""
        assert run_blocks("```python\nx = 1\n```\n\n```python\nassert x == 1\n```\n", "good") == 2
        with pytest.raises(AssertionError):
            run_blocks("text\n```python\nassert 1 == 2\n```\n", "bad")
        assert run_blocks("```sh\nls\n```\n", "another language") == 0


class TestQuickSelection:
    """Each line of quick.txt is a file of tests, or a class in one: pytest runs nothing at all if one is not."""

    @staticmethod
    def missing(lines: list[str]) -> list[str]:
        found = []
        for line in lines:
            file, _, name = line.partition("::")
            path = ROOT / file
            names = (
                {node.name for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ClassDef)}
                if path.exists()
                else set()
            )
            found += [] if path.exists() and name in {"", *names} else [line]
        return found

    def test_all_are_there(self) -> None:
        lines = (ROOT / "proofs_tests" / "quick.txt").read_text(encoding="utf-8").split()
        assert len(lines) > 70
        assert not self.missing(lines)

    def test_control_what_is_not_there(self) -> None:
        """A class that is gone, and a file."""
        lines = ["proofs_tests/mesh/test_quadedge.py::TestGone", "proofs_tests/test_gone.py"]
        assert self.missing(lines) == lines

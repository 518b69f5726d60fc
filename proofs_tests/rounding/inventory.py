"""Which functions of the code compare with a floating-point bound, found in their sources."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

__all__ = ["ELSEWHERE", "functions_with_bounds"]

ROOTS = (Path(__file__).resolve().parents[2] / "kernel", Path(__file__).resolve().parents[2] / "mesh")

#: Names of bounds, margins and guards, in the code's own manner of speaking.
_NAMES = re.compile(
    r"\w*(BOUND|MARGIN|SLACK|ERROR|DOUBT|FACTOR|WEIGHT|UNDERFLOW|RELATIVE|ABSOLUTE|ROUNDOFF|SMALL|TINY|CLEAR|ENOUGH|PRODUCT|STEPS)"
)
_ATTRIBUTES = frozenset({"orient2d_bound", "incircle_bound", "grid_limit"})
_NO_BOUNDS = frozenset({"MEASURE_BOUND", "_STEPS", "_CHILD_ERROR"})  # a limit of exact comparisons; of a walk

_DECIDES_NOTHING = frozenset({"strategies", "plot.py"})

_CALCULUS = "test_filter.py: the exact calculus of rounding errors, on the source itself"
_SAME = "calls a filter that is proved, with the bound of the context"
_CHOICE = "looks whether the input is inside the window, compares nothing with it"
_EXACT = "only prefers or limits; what is answered is checked exactly"

#: Functions that name a bound and are covered by another proof, or decide nothing by it.
ELSEWHERE: dict[str, str] = {
    "exactkernel.angle.angle_above_adaptive": _SAME,
    "exactkernel.bisector.bisector_crossing": "dd_cross and quotient_offset, with the same guards",
    "exactkernel.bisector.crossing_order_adaptive": _CALCULUS,
    "exactkernel.centre.circumcentre_in_pairs": "dd_cross and quotient_offset; 2^-10 guards the latter",
    "exactkernel.context.chunk_size": _CHOICE,
    "exactkernel.context.exponent_into_window": _CHOICE,
    "exactkernel.context.scaled_into_window": _CHOICE,
    "exactkernel.crossing.crossing_in_pairs": "dd_cross and quotient_offset; 2^-10 guards the latter",
    "exactkernel.diametral.diametral_adaptive": _SAME,
    "exactkernel.incircle.incircle_adaptive": _SAME,
    "exactkernel.incircle.incircle_perturbed_adaptive": _SAME,
    "exactkernel.orient2d.orient2d_adaptive": _SAME,
    "exactmesh.cavity.split_along": "the number of corners of a small polygon",
    "exactmesh.crossings.segment_meetings._neighbours_first": "an order in which pairs are looked at",
    "exactmesh.editing.draft.fitted": _CHOICE,
    "exactmesh.ordering._along_curves": "an order in which points are inserted",
    "exactmesh.refinement.layout.laid_out": _CHOICE,
    "exactmesh.refinement.placement.place_centre": _EXACT,
    "exactmesh.refinement.split_point._most_halves": _EXACT,
    "exactmesh.verify.delaunay._edges": "hands the constant to exact comparisons: rounding-sized or not",
    "exactmesh.verify.delaunay.describe": "hands the constant to exact comparisons: rounding-sized or not",
    "exactmesh.verify.duality._leaves": "compares fractions",
    "exactmesh.verify.gabriel.check_gabriel": "hands the constant to exact comparisons: rounding-sized or not",
    "exactmesh.verify.gabriel.describe": "hands the constant to exact comparisons: rounding-sized or not",
    "exactmesh.verify.grading.decide": "compares fractions",
    "exactmesh.verify.grading.grade_circles": "hands the constant to grade, which is proved",
    "exactmesh.verify.grading.grade_diametral": "hands the constant to grade, which is proved",
    "exactmesh.verify.grading.rank_angles": _CHOICE,
    "exactmesh.verify.grading.rank_areas": _CHOICE,
    "exactmesh.verify.grading.rank_circles": _CHOICE,
    "exactmesh.verify.grading.rank_diametral": _CHOICE,
    "exactmesh.verify.grading.rank_lengths": _CHOICE,
    "exactmesh.verify.nearest.nearest_corners": "repeats what find_nearest does, which is proved",
    "exactmesh.voronoi.cavity._centre": "an error that coordinates_of compares",
    "exactmesh.voronoi.cavity.coordinates_of": "decides no sign, but whether weights have 50 bits, by a factor of two",
}


def _is_bound(node: ast.AST) -> bool:
    if isinstance(node, ast.Name):
        return _NAMES.fullmatch(node.id) is not None and node.id not in _NO_BOUNDS
    if isinstance(node, ast.Attribute):
        return node.attr in _ATTRIBUTES
    return (
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Pow)
        and isinstance(node.right, ast.UnaryOp)
        and isinstance(node.left, ast.Constant)
    )


def _of_file(path: Path, root: Path) -> Iterator[str]:
    module = ".".join(path.relative_to(root).with_suffix("").parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef) and any(
            _is_bound(inner) for line in node.body for inner in ast.walk(line)
        ):
            yield f"{module}.{node.name}"


def functions_with_bounds() -> set[str]:
    """Return module.function of each function that names a bound, or writes a negative power of two."""
    files = [(path, root) for root in ROOTS for path in root.rglob("*.py") if not _DECIDES_NOTHING & set(path.parts)]
    return {name for path, root in files for name in _of_file(path, root)}

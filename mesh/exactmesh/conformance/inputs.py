"""One input from the command line: a case of the corpus, a file, or Python."""

import ast
import os
from typing import Any

from exactkernel.errors import shown
from exactmesh.conformance.corpus import case_named
from exactmesh.conformance.given import Given
from exactmesh.conformance.laws import Task
from exactmesh.errors import OptionError

__all__ = ["given_input"]


def given_input(text: str, task: Task) -> tuple[Given, str]:
    """Return the input that the text stands for, and where it is from.

    Args:
        text: "corpus:7", the path of a file that :func:`exactmesh.io.read` understands, a list of points, or a pair of
            points and segments.
        task: whether segments are wanted.

    Raises:
        OptionError: none of these, or no segments where some are wanted.
        ShapeError, CoordinateError: no arrays (n, 2) and (s, 2), or not of finite doubles and integers.

    >>> given_input("[(0, 0), (1, 0), (0, 1)]", Task.POINTS)[0].points.shape
    (3, 2)
    """
    if text.startswith("corpus:"):
        return _fitting(case_named(text.removeprefix("corpus:")).make(), task), text
    if os.path.exists(text):
        from exactmesh.io import read

        content = read(text)
        return _fitting(Given.of(content.points, content.segments), task), text
    try:
        literal = ast.literal_eval(text.strip())
    except (SyntaxError, TypeError, ValueError, MemoryError, RecursionError):
        raise OptionError(
            f"--input {shown(text)} is no file that is there, no corpus:NUMBER and no list of points in numbers"
        ) from None
    if isinstance(literal, tuple) and len(literal) == 2 and isinstance(literal[0], list | tuple) and _has_rows(literal):
        return _fitting(Given.of(*literal), task), ""
    return _fitting(Given.of(literal), task), ""


def _has_rows(literal: tuple[Any, Any]) -> bool:
    """Tell points and segments from two points: the first of the pair has rows."""
    return not literal[0] or isinstance(literal[0][0], list | tuple)


def _fitting(given: Given, task: Task) -> Given:
    if task is Task.POINTS:
        return Given(given.points)
    if given.segments is None:
        raise OptionError(f"the input has no segments, which {task} needs: (points, segments)")
    return given

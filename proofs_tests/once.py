"""What one lane is enough for: the marker ``once`` leaves it out of the interpreted lane of .ci/run.

These are tests that compile nothing of their own (files, pages, other people's meshes), tests whose oracles take nearly
all of their time, and tests in a process that runs interpreted anyway. The first few of a series run in both lanes.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from _pytest.mark import ParameterSet

__all__ = ["once_after"]


def once_after(first: int, values: Iterable[object], ids: Iterable[object] | None = None) -> "list[ParameterSet]":
    """Return parameters of which all after the first few are marked ``once``."""
    values = list(values)
    names = [None] * len(values) if ids is None else [str(name) for name in ids]
    return [
        pytest.param(value, id=name, marks=[pytest.mark.once] if i >= first else [])
        for i, (value, name) in enumerate(zip(values, names, strict=True))
    ]

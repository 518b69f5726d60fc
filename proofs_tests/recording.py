"""The type of pytest's own fixture ``record_property``: tests that loop over cases report by it how many there were."""

from collections.abc import Callable
from typing import TypeAlias

__all__ = ["Record"]

Record: TypeAlias = Callable[[str, object], None]

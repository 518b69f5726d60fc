"""The suite that ``pytest --mesher=module:function`` collects: one test for each law."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from exactmesh.conformance import Conformance


def test_law(mesher_conformance: Conformance, mesher_law: str, pytestconfig: pytest.Config) -> None:
    """The law holds on every input that was tried."""
    ruling = next(ruling for law, ruling in mesher_conformance.rulings.items() if law == mesher_law)
    if ruling.outcome == "holds" or (
        ruling.outcome == "rounding" and pytestconfig.getoption("--mesher-allow-rounding")
    ):
        if not mesher_conformance.complete:
            warnings.warn(
                "the time was up before every family of inputs had its turn (--mesher-deadline)", stacklevel=1
            )
        return
    example = ruling.counterexample
    told = "see answers" if example is None else f"{example.sentence}\n\n{example.code}\n\n# or: {example.command}"
    pytest.fail(f"{mesher_conformance.mesher} breaks {mesher_law}: {ruling.outcome}, {told}", pytrace=False)

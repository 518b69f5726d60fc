"""Hypothesis profiles, and the lane that the tests run in."""

import os

import pytest
from hypothesis import HealthCheck, Phase, settings

from exactkernel.jit import COMPILED

_patient = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
settings.register_profile("suite", _patient, max_examples=300, derandomize=True)
settings.register_profile("interpreted", _patient, max_examples=150, derandomize=True)
settings.register_profile(
    "mutation", _patient, max_examples=150, derandomize=True, phases=[Phase.explicit, Phase.generate], database=None
)
settings.register_profile("deep", _patient, max_examples=20000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "suite" if COMPILED else "interpreted"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    if COMPILED:
        return
    skip = pytest.mark.skip(reason="about the compiled functions; NUMBA_DISABLE_JIT=1 is set")
    for item in items:
        if item.get_closest_marker("compiled"):
            item.add_marker(skip)

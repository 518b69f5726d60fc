"""A pytest plugin: coverage learns which test runs which line.

``coverage run -m pytest -p proofs_tests.mutation.contexts`` names coverage's context after the test that runs, and
after its file while fixtures are made, which other tests of the file may use as well.
"""

from collections.abc import Iterator

import coverage
import pytest

__all__ = ["pytest_runtest_call", "pytest_runtest_setup"]


def _enter(context: str) -> None:
    if measuring := coverage.Coverage.current():
        measuring.switch_context(context)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    _enter(item.nodeid.split("::")[0])


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    _enter(item.nodeid)
    yield
    _enter(item.nodeid.split("::")[0])

"""Every example in a docstring runs and prints what it says."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import exactkernel
import exactmesh

PACKAGES = (exactkernel, exactmesh)
MODULES = [package.__name__ for package in PACKAGES] + [
    module.name for package in PACKAGES for module in pkgutil.walk_packages(package.__path__, package.__name__ + ".")
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_docstrings(name: str) -> None:
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


def test_public_functions_have_examples() -> None:
    """Each public function has an example in its own docstring."""
    finder = doctest.DocTestFinder(recurse=False)
    bare = [
        name
        for package in PACKAGES
        for name in package.__all__
        if inspect.isroutine(getattr(package, name))
        and not any(test.examples for test in finder.find(getattr(package, name), name))
    ]
    assert bare == []


def test_a_wrong_example_is_found() -> None:
    """The negative control: a docstring that lies fails."""
    test = doctest.DocTestParser().get_doctest(">>> 1 + 1\n3\n", {}, "lie", None, 0)
    assert doctest.DocTestRunner(verbose=False).run(test, out=lambda _: None).failed == 1

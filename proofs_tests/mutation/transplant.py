"""Put a mutant into a process that has imported the original: the code of one function is exchanged.

So a mutant costs a fork and the tests that kill it, not the import of everything.
"""

import functools
import types
from collections.abc import Iterator

__all__ = ["transplant"]


def transplant(module: types.ModuleType, original: str, mutated: str) -> bool:
    """Exchange the functions that differ; False, and nothing done, if something else differs as well."""
    path = str(module.__file__)
    old, new = compile(original, path, "exec"), compile(mutated, path, "exec")
    if not _same_but_functions(old, new):
        return False
    pairs = [(a, b) for a, b in zip(_functions(old), _functions(new), strict=True) if a != b]
    homes = [_live(module, code) for code, _ in pairs]
    if not pairs or any(home is None for home in homes):
        return False
    for home, (_, code) in zip(homes, pairs, strict=True):
        assert home is not None
        home.__code__ = code
    return True


def _inner(code: types.CodeType) -> list[types.CodeType]:
    return [constant for constant in code.co_consts if isinstance(constant, types.CodeType)]


def _is_body(code: types.CodeType) -> bool:
    """Tell whether the code runs when the module is imported: its own, and that of its classes."""
    return code.co_name == "<module>" or "__qualname__" in code.co_names


def _functions(code: types.CodeType) -> Iterator[types.CodeType]:
    for inner in _inner(code):
        if _is_body(inner):
            yield from _functions(inner)
        else:
            yield inner


def _same_but_functions(a: types.CodeType, b: types.CodeType) -> bool:
    def rest(code: types.CodeType) -> object:
        plain = [repr(constant) for constant in code.co_consts if not isinstance(constant, types.CodeType)]
        return code.co_code, plain, code.co_names, code.co_qualname

    bodies_a, bodies_b = ([inner for inner in _inner(code) if _is_body(inner)] for code in (a, b))
    return (
        rest(a) == rest(b)
        and len(_inner(a)) == len(_inner(b))
        and all(x.co_qualname == y.co_qualname for x, y in zip(_inner(a), _inner(b), strict=True))
        and all(_same_but_functions(x, y) for x, y in zip(bodies_a, bodies_b, strict=True))
    )


def _live(module: types.ModuleType, code: types.CodeType) -> types.FunctionType | None:
    """Return the function of the module that was made of this code."""
    home: object = module
    for name in code.co_qualname.split("."):
        home = vars(home).get(name) if isinstance(home, types.ModuleType | type) else None
    found = [function for function in _unwrapped(home) if function.__code__ == code]
    return found[0] if found else None


def _unwrapped(value: object) -> Iterator[types.FunctionType]:
    """Yield the functions behind a property, a method of the class, a cache or a wrapper."""
    if isinstance(value, property):
        for accessor in (value.fget, value.fset, value.fdel):
            yield from _unwrapped(accessor)
    elif isinstance(value, classmethod | staticmethod):
        yield from _unwrapped(value.__func__)
    elif isinstance(value, functools.cached_property):
        yield from _unwrapped(value.func)
    elif isinstance(value, types.FunctionType):
        yield value
        yield from _unwrapped(getattr(value, "__wrapped__", None))
    elif value is not None:
        yield from _unwrapped(getattr(value, "__wrapped__", None))

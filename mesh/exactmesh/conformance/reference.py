"""How a mesher is named, so that another process can import it."""

import base64
import os
import sys
from collections.abc import Callable
from pathlib import Path

from exactmesh.conformance.child import PICKLED, load
from exactmesh.conformance.known import KNOWN, Known
from exactmesh.conformance.laws import Task
from exactmesh.errors import MesherError

__all__ = ["Mesher", "loaded", "name_of", "reference_of", "resolved"]

#: What :func:`exactmesh.conformance.check` takes: a callable, the name of a known mesher, or "module:function".
Mesher = Callable[..., object] | str

_MESHERS = Path(__file__).with_name("meshers.py")


def resolved(mesher: Mesher, task: Task) -> tuple[str, Known | None]:
    """Return "module:function" or "file.py:function", and what is known of the mesher.

    Raises:
        MesherError: no name leads to it, or a known mesher does not do the task, or is not installed.
    """
    if not isinstance(mesher, str):
        return reference_of(mesher), None
    if ":" in mesher:
        return mesher, None
    known = KNOWN.get(mesher)
    if known is None:
        meant = f"; did you mean {mesher}:FUNCTION?" if "." in mesher or os.sep in mesher else ""
        raise MesherError(f"{mesher!r} is neither module:function nor a known mesher: {', '.join(KNOWN)}{meant}")
    if task not in known.functions:
        raise MesherError(f"{mesher} is known for {', '.join(known.functions)}, not for {task}")
    if not known.is_installed:
        raise MesherError(f"{known.title} is not installed: pip install {known.package}")
    return f"{_MESHERS}:{known.functions[task]}", known


def reference_of(mesher: Callable[..., object]) -> str:
    """Return the name under which another process can import a callable; of a lambda, and of what was defined within a
    function or at a prompt, its code.

    Raises:
        MesherError: there is neither.
    """
    module, name = getattr(mesher, "__module__", None), getattr(mesher, "__qualname__", None)
    if not module or not name:
        raise MesherError(f"{mesher!r} is no function that another process could import")
    place = module
    if module == "__main__":
        place = str(getattr(sys.modules["__main__"], "__file__", "") or "")
    if "<" in name or not place or not _leads_to(mesher, module, name):
        return _pickled(mesher, f"{module}.{name}")
    return f"{place}:{name}"


def _pickled(mesher: Callable[..., object], name: str) -> str:
    """Return the code of a function that no name leads to."""
    try:
        import cloudpickle
    except ImportError:
        raise MesherError(
            f"{name} cannot be imported by another process: define it with def at the top of a module or script, "
            "give module:function, or pip install cloudpickle"
        ) from None
    try:
        return PICKLED + base64.b64encode(cloudpickle.dumps(mesher)).decode()
    except Exception as error:
        raise MesherError(f"{name} cannot be sent to another process: {error}") from None


def name_of(mesher: Mesher, reference: str) -> str:
    """Return what a mesher is called: as it was asked for, or by what it was named where it was defined."""
    if isinstance(mesher, str):
        return mesher
    return f"<{getattr(mesher, '__name__', 'mesher')}>" if reference.startswith(PICKLED) else reference


def _leads_to(mesher: object, module: str, name: str) -> bool:
    found: object = sys.modules.get(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    return found is mesher


def loaded(mesher: str, task: Task) -> Callable[..., object]:
    """Return the mesher itself, in this process.

    Raises:
        MesherError: it cannot be imported.

    >>> from exactmesh.conformance import Task, loaded
    >>> points, triangles = loaded("exactmesh", Task.POINTS)([(0, 0), (1, 0), (0, 1)])
    >>> triangles.tolist()
    [[0, 1, 2]]
    """
    reference, _ = resolved(mesher, task)
    try:
        return load(reference)
    except ValueError as error:
        raise MesherError(str(error)) from error

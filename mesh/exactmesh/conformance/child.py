"""The process in which a mesher runs. It may crash, exit, hang, print or eat memory: who asks stands elsewhere.

Run as a file by :mod:`exactmesh.conformance.process`, so that nothing of exactmesh has to be imported and a restart is
cheap. The job and the inputs come in through standard input, pickled, the answers leave through what was standard
output; both are out of the mesher's reach.
"""

import base64
import contextlib
import importlib
import importlib.util
import os
import pickle
import signal
import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

__all__ = ["IN_CHILD", "MARK", "PICKLED", "load", "main"]

#: Set in the environment of every child: a script that asks again, in there, would never end.
IN_CHILD = "EXACTMESH_CONFORMANCE_CHILD"

#: Begins the reference of a mesher to which no name leads; what follows is the function, pickled, in base 64.
PICKLED = "pickled:"

#: Before each answer and its length: what a mesher writes into the pipe is no answer.
MARK = b"\0exactmesh answers\0"

_GRACE = 5  # seconds after which an orphan ends itself, beyond those it was given
_LONG = 1e9  # seconds that an alarm can be set to, at least
_SENTENCE = 300  # characters of an exception that are told


def load(reference: str) -> Callable[..., object]:
    """Return the callable that "package.module:function" or "path/to/file.py:function" names, or a pickled one.

    Raises:
        ValueError: there is no such thing, or it cannot be called; the message says which.
    """
    if reference.startswith(PICKLED):
        return _unpickled(reference)
    place, _, name = reference.rpartition(":")
    if not place or not name:
        raise ValueError(f"{reference!r} is no module:function")
    found: Any = _module_of(place)
    for part in name.split("."):
        if not hasattr(found, part):
            raise ValueError(f"there is no {name!r} in {place}")
        found = getattr(found, part)
    if not callable(found):
        raise ValueError(f"{reference} cannot be called: it is {type(found).__name__}")
    mesher: Callable[..., object] = found
    return mesher


def _unpickled(reference: str) -> Callable[..., object]:
    try:
        mesher: Callable[..., object] = pickle.loads(base64.b64decode(reference.removeprefix(PICKLED)))
    except Exception as error:
        raise ValueError(f"the mesher cannot be made again: {_told(error)}") from error
    return mesher


def _module_of(place: str) -> ModuleType:
    try:
        if not place.endswith(".py"):
            return importlib.import_module(place)
        specification = importlib.util.spec_from_file_location("exactmesh_mesher", place)
        if specification is None or specification.loader is None or not os.path.isfile(place):
            raise ValueError(f"there is no file {place}")
        module = importlib.util.module_from_spec(specification)
        sys.modules[module.__name__] = module
        specification.loader.exec_module(module)
        return module
    except Exception as error:
        if isinstance(error, ValueError) and "there is no file" in str(error):
            raise
        raise ValueError(f"{place} cannot be imported: {_told(error)}") from error


def _told(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}"[:_SENTENCE] if text else type(error).__name__


class _NoMeshError(Exception):
    """What came back is no mesh."""


def _integers(array: Any, what: str, width: int) -> Any:
    indices = np.asarray(array)
    if indices.size == 0:
        return np.zeros((0, width), dtype=np.int64)
    if indices.dtype.kind not in "iu":
        raise _NoMeshError(f"{what} are {indices.dtype}, not integers")
    if indices.ndim != 2 or indices.shape[1] != width:
        raise _NoMeshError(f"{what} have shape {indices.shape}, not (m, {width})")
    return np.array(indices, dtype=np.int64)


def _positions(array: Any) -> Any:
    points = np.asarray(array)
    if points.size == 0:
        return np.zeros((0, 2))
    if points.dtype.kind not in "iuf" or points.ndim != 2 or points.shape[1] != 2:
        raise _NoMeshError(f"points are {points.dtype} of shape {points.shape}, not doubles of shape (n, 2)")
    return np.array(points, dtype=np.float64)


def _plain(result: Any) -> dict[str, Any]:
    """Return what came back as arrays: triangles; points and triangles; or any mesh that has an adapter."""
    if isinstance(result, np.ndarray):
        return {"triangles": _integers(result, "triangles", 3)}
    if isinstance(result, list | tuple):
        if len(result) == 2 and np.ndim(result[0]) == 2:
            return {"points": _positions(result[0]), "triangles": _integers(result[1], "triangles", 3)}
        return {"triangles": _integers(result, "triangles", 3)}
    if isinstance(result, dict) and "vertices" in result:
        triangles = _integers(result.get("triangles", ()), "triangles", 3)
        return {"points": _positions(result["vertices"]), "triangles": triangles}
    return _adapted(result)


def _adapted(result: object) -> dict[str, Any]:
    if result is None:
        raise _NoMeshError("it returned None")
    from exactmesh.adapters import given_mesh  # only here: it takes half a second

    mesh = given_mesh(result)
    if len(mesh.quads):
        raise _NoMeshError("there are quadrilaterals in it")
    return {
        "points": _positions(mesh.points),
        "triangles": _integers(mesh.triangles, "triangles", 3),
        "orientation": str(mesh.orientation),
    }


def _answer(mesher: Callable[..., object], given: tuple[Any, ...]) -> dict[str, Any]:
    """Return what the mesher makes of the input: "fate", and "message" or a mesh in arrays."""
    untouched = [array.copy() for array in given]
    try:
        result = mesher(*given)
    except Exception as error:
        return {"fate": "refused", "message": _told(error)}
    kept = all(np.array_equal(a, b) for a, b in zip(given, untouched, strict=True))
    try:
        return {"fate": "answered", "message": "", "kept": kept, **_plain(result)}
    except _NoMeshError as error:
        return {"fate": "no_mesh", "message": str(error)}
    except Exception as error:
        return {"fate": "no_mesh", "message": _told(error)}


def _limit(memory: int) -> None:
    """Let no more memory be taken than told, and leave no core behind."""
    with contextlib.suppress(ImportError, ValueError, OSError, OverflowError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _alarm(seconds: float) -> None:
    """End this process if it still works when nobody waits any longer, whatever code it is in."""
    if sys.platform != "win32":  # where an orphan goes on
        signal.alarm(int(min(seconds, _LONG)) + _GRACE if seconds > 0 else 0)


def main() -> None:
    """Serve one mesher until there are no more questions."""
    questions, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)  # what the mesher prints goes where errors go

    def send(answer: dict[str, Any]) -> None:
        pickled = pickle.dumps(answer, protocol=pickle.HIGHEST_PROTOCOL)
        answers.write(MARK + len(pickled).to_bytes(8, "big") + pickled)
        answers.flush()

    job = pickle.load(questions)
    sys.path[:] = job["path"]
    _limit(job["memory"])
    try:
        mesher = load(job["reference"])
    except ValueError as error:
        send({"fate": "unloadable", "message": str(error)})
        return
    send({"fate": "ready"})
    server = os.getpid()
    while True:
        try:
            given, seconds = pickle.load(questions)
        except EOFError:
            return
        _alarm(seconds)
        answer = _answer(mesher, given)
        if os.getpid() != server:  # the mesher forked, and the fork returned as well
            os._exit(0)
        _alarm(0)
        send(answer)


if __name__ == "__main__":
    os.environ[IN_CHILD] = "1"
    main()

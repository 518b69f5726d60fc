"""The meshers that have a name here, and what they are known for."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec

from exactmesh.conformance.laws import Task

__all__ = ["KNOWN", "Known"]


@dataclass(frozen=True, slots=True)
class Known:
    """A mesher that can be asked for by name.

    Attributes:
        title: its name in tables.
        package: the distribution on PyPI.
        module: what is imported of it.
        functions: for each task that it does, the function of :mod:`exactmesh.conformance.meshers` which calls it.
        orientation: "ccw" if it says that triangles are listed so, else "any".
    """

    title: str
    package: str
    module: str
    functions: Mapping[Task, str]
    orientation: str = "ccw"

    @property
    def version(self) -> str:
        """The installed version, or "" where the package is missing."""
        try:
            return version(self.package)
        except PackageNotFoundError:
            return ""

    @property
    def is_installed(self) -> bool:
        """Whether it can be imported, wherever it is from."""
        return find_spec(self.module) is not None


def _tasks(function: str, *tasks: Task) -> dict[Task, str]:
    return {task: f"{function}_{task}" for task in tasks}


#: The meshers that have a name: ``check("scipy")``.
KNOWN: dict[str, Known] = {
    "exactmesh": Known("exactmesh", "exactmesh", "exactmesh", _tasks("exactmesh", *Task)),
    "triangle": Known("Triangle", "triangle", "triangle", _tasks("triangle", Task.POINTS, Task.SEGMENTS)),
    "meshpy": Known("meshpy (Triangle)", "meshpy", "meshpy", _tasks("meshpy", Task.POINTS, Task.SEGMENTS)),
    "cgal": Known("CGAL", "cgal", "CGAL", _tasks("cgal", Task.POINTS, Task.SEGMENTS)),
    "cdt": Known("CDT", "pythoncdt", "pythoncdt", _tasks("cdt", *Task)),
    "geos": Known("shapely (GEOS)", "shapely", "shapely", _tasks("geos", Task.POINTS, Task.DOMAIN), "any"),
    "scipy": Known("scipy (Qhull)", "scipy", "scipy", _tasks("scipy", Task.POINTS)),
    "matplotlib": Known("matplotlib (Qhull)", "matplotlib", "matplotlib", _tasks("matplotlib", Task.POINTS)),
    "gmsh": Known("gmsh", "gmsh", "gmsh", _tasks("gmsh", Task.POINTS), "any"),
    "startinpy": Known("startinpy", "startinpy", "startinpy", _tasks("startinpy", Task.POINTS)),
}

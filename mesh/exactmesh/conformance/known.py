"""The meshers that have a name here, and what they are known for."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from exactmesh.conformance.laws import Task

__all__ = ["KNOWN", "Known"]


@dataclass(frozen=True, slots=True)
class Known:
    """A mesher that can be asked for by name.

    Attributes:
        title: its name in tables.
        package: the distribution on PyPI.
        functions: for each task that it does, the function of :mod:`exactmesh.conformance.meshers` which calls it.
        orientation: "ccw" if it says that triangles are listed so, else "any".
    """

    title: str
    package: str
    functions: Mapping[Task, str]
    orientation: str = "ccw"

    @property
    def version(self) -> str:
        """The installed version, or "" where the package is missing."""
        try:
            return version(self.package)
        except PackageNotFoundError:
            return ""


def _tasks(function: str, *tasks: Task) -> dict[Task, str]:
    return {task: f"{function}_{task}" for task in tasks}


#: The meshers that have a name: ``check("scipy")``.
KNOWN: dict[str, Known] = {
    "exactmesh": Known("exactmesh", "exactmesh", _tasks("exactmesh", *Task)),
    "triangle": Known("Triangle", "triangle", _tasks("triangle", Task.POINTS, Task.SEGMENTS)),
    "meshpy": Known("meshpy (Triangle)", "meshpy", _tasks("meshpy", Task.POINTS, Task.SEGMENTS)),
    "cgal": Known("CGAL", "cgal", _tasks("cgal", Task.POINTS, Task.SEGMENTS)),
    "cdt": Known("CDT", "pythoncdt", _tasks("cdt", *Task)),
    "geos": Known("shapely (GEOS)", "shapely", _tasks("geos", Task.POINTS, Task.DOMAIN), "any"),
    "scipy": Known("scipy (Qhull)", "scipy", _tasks("scipy", Task.POINTS)),
    "matplotlib": Known("matplotlib (Qhull)", "matplotlib", _tasks("matplotlib", Task.POINTS)),
    "gmsh": Known("gmsh", "gmsh", _tasks("gmsh", Task.POINTS), "any"),
    "startinpy": Known("startinpy", "startinpy", _tasks("startinpy", Task.POINTS)),
}

"""All targets, by name."""

from proofs_tests.fuzzing import archives, foreign, graphs, meshes, texts, triangle_files
from proofs_tests.fuzzing.judging import Target

from exactmesh.errors import ExactMeshError

__all__ = ["TARGETS", "UnknownTargetError", "target_named"]

TARGETS: dict[str, Target] = {
    target.name: target
    for room in (triangle_files, archives, texts, meshes, foreign, graphs)
    for target in room.TARGETS
}


class UnknownTargetError(ExactMeshError):
    """There is no target of that name."""


def target_named(name: str) -> Target:
    """Return a target."""
    if name not in TARGETS:
        raise UnknownTargetError(f"{name!r} is no target; there are {', '.join(TARGETS)}")
    return TARGETS[name]

"""What is wrong with a switch string, and what a switch means here if that is not what it means to Triangle."""

from exactkernel.errors import ExactMeshError

__all__ = ["SwitchError", "TriangleWarning"]


class SwitchError(ExactMeshError):
    """A switch string that cannot be meant: ``switches`` is the string, ``position`` where in it, ``culprit`` what."""

    def __init__(self, message: str, *, switches: str, position: int, culprit: str) -> None:
        super().__init__(f"{culprit!r} at {position} of {switches!r}: {message}", indices=[position])
        self.switches = switches
        self.position = position
        self.culprit = culprit


class TriangleWarning(UserWarning):
    """Something that Triangle would do in another way, or without a word."""

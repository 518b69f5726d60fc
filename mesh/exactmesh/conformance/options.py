"""The numbers that a conformance run is told: refused here, where it says which one it is."""

import sys

from exactkernel.errors import shown
from exactmesh.errors import OptionError

__all__ = ["check_counts", "check_integer", "check_seconds"]


def check_integer(name: str, value: object) -> int:
    """Return what is an integer.

    Raises:
        OptionError: it is none, or a bool.
    """
    if isinstance(value, bool) or not isinstance(value, int):
        raise OptionError(f"{name}={shown(value)} is no integer")
    return value


def check_counts(**counts: object) -> None:
    """Refuse what is no positive integer.

    Raises:
        OptionError: it is none.
    """
    for name, value in counts.items():
        if check_integer(name, value) < 1:
            raise OptionError(f"{name}={shown(value)} has to be positive")


def check_seconds(name: str, value: object, *, most: float) -> None:
    """Refuse what is no time.

    Raises:
        OptionError: it is no number, not positive, or beyond the doubles and not the most.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise OptionError(f"{name}={shown(value)} is no number of seconds")
    if not (0 < value <= sys.float_info.max or value == most):
        raise OptionError(f"{name}={shown(value)} has to be positive{' and finite' if value > 0 else ''}")

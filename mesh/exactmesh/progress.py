"""What a terminal shows during long work; nothing where there is no terminal."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

__all__ = ["COMPILING", "working"]

#: What the first run on a machine says.
COMPILING = "compiling, once on this machine; a minute or so"

_PATIENCE = 1.0  # seconds; shorter work shows nothing


def _ignore(_done: int, _total: int) -> None:
    """There is nobody to tell."""


@contextmanager
def working(task: str, *, compiling: bool = False) -> Iterator[Callable[[int, int], None]]:
    """Show a spinner on standard error, if it is a terminal, when the block takes longer than a second.

    Elsewhere, one line says that there is something to compile, for that takes long.

    Yields:
        A callback (done, total) that turns the spinner into a bar, if the total is known: not 0.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        if compiling:
            console.print(f"{task}: {COMPILING}", markup=False, highlight=False, soft_wrap=True)
        yield _ignore
        return
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    shown = Progress(*columns, console=console, transient=True)
    bar = shown.add_task(f"{task}: {COMPILING}" if compiling else task, total=None)
    timer = threading.Timer(0.0 if compiling else _PATIENCE, shown.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda done, total: shown.update(bar, completed=done, total=total or None)
    finally:
        timer.cancel()
        timer.join()
        shown.stop()

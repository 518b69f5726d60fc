"""``python -m benchmarks delaunay|constrained|refine|voronoi|verify|strategies [--quick] [--rounds N]``."""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")  # before any mesher is imported, in this process and its children

from typing import Annotated

import typer

from benchmarks import constrained as constrained_benchmark
from benchmarks import delaunay as delaunay_benchmark
from benchmarks import refine as refine_benchmark
from benchmarks import strategies as strategies_benchmark
from benchmarks import verify as verify_benchmark
from benchmarks import voronoi as voronoi_benchmark

app = typer.Typer(help=__doc__, no_args_is_help=True, add_completion=False)

Quick = Annotated[bool, typer.Option(help="A hundredth of the size, nothing written: to see that it works.")]
Rounds = Annotated[int, typer.Option(min=1, help="How often each mesher has its turn.")]


@app.command()
def delaunay(quick: Quick = False, rounds: Rounds = 5) -> None:
    """Race the meshers on point sets; growth, memory, stages, starts."""
    delaunay_benchmark.run(quick=quick, rounds=rounds)


@app.command()
def constrained(quick: Quick = False, rounds: Rounds = 5) -> None:
    """Race the constrained meshers on graphs; crossings and their growth."""
    constrained_benchmark.run(quick=quick, rounds=rounds)


@app.command()
def refine(quick: Quick = False, rounds: Rounds = 5) -> None:
    """Race the refiners on domains; growth, and Python callbacks."""
    refine_benchmark.run(quick=quick, rounds=rounds)


@app.command()
def voronoi(quick: Quick = False, rounds: Rounds = 5) -> None:
    """Race the Voronoi diagrams on point sets; clipping, relaxation, interpolation."""
    voronoi_benchmark.run(quick=quick, rounds=rounds)


@app.command()
def verify(quick: Quick = False, rounds: Rounds = 5) -> None:
    """Time the verifier beside building the mesh."""
    verify_benchmark.run(quick=quick, rounds=rounds)


@app.command()
def strategies(quick: Quick = False, rounds: Rounds = 5) -> None:
    """Count how many inputs a second the hypothesis strategies draw."""
    strategies_benchmark.run(quick=quick, rounds=rounds)


if __name__ == "__main__":
    app()

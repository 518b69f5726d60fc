"""What each obligation says: the theorems, by family. What a class shows of one is said by its marker."""

from types import MappingProxyType

__all__ = ["CORE", "FAMILIES", "STATEMENTS", "family"]

#: The families of the first table: what the rest stands on.
CORE = ("K", "M", "V", "R", "J", "X")

FAMILIES = MappingProxyType(
    {
        "K": "The kernel: exact signs",
        "M": "The mesh: algebra, flips, insertion, segments",
        "V": "The verifier",
        "R": "Refinement",
        "J": "The machine code",
        "X": "The tests themselves",
        "D": "Voronoi diagrams and what is made of them",
        "ARR": "Arrangements of segments that cross",
        "P": "Input graphs and files",
        "G": "What is given, and what is returned",
        "H": "Holes",
        "A": "Everybody's meshes",
        "B": "The conformance suite for other meshers",
        "S": "The strategies",
        "T": "The interface of the triangle package",
        "W": "The documents",
    }
)

STATEMENTS = MappingProxyType(
    {
        "K1": "the filter constants are sound for u = 2^-53",
        "K2": "the filter bounds hold: static, semi-static, with underflow",
        "K3": "the filter never lies",
        "K4": "an unsound constant and a missing guard are found by K3",
        "K5": "two_sum, two_product, expansion sum and product are exact and bit-disjoint",
        "K6": "the exponent windows: exact inside, refused one step outside",
        "K7": "every predicate has the sign in fractions, for all finite doubles, and the stage that decided is known",
        "K8": "Knuth's axioms, flippability of an edge that is not Delaunay, incircle = lift",
        "K9": "the perturbed incircle is never 0 and is consistent: one unique triangulation",
        "M1": "the edge algebra: rot^4 = e, splice is an involution, Euler",
        "M2": "each flip lowers the potential by exactly incircle; at most n(n-1)/2 flips",
        "M3": "Lawson ends in the Delaunay triangulation from every triangulation; its smallest angle is maximal",
        "M4": "incremental insertion equals Lawson equals brute force, for every order",
        "M5": "constrained: one sink, every segment present, decided by visibility",
        "V1": "the verifier accepts exactly what has the property that is claimed",
        "V2": "each condition of the verifier is necessary",
        "V3": "a report says what was found, by minimal witnesses, and certifies what it was found of",
        "R1": "what refinement returns is what it says: theorems A to F, bounds, distances, grading",
        "R2": "refinement ends, for every valid graph",
        "J1": "compiled equals interpreted, bit for bit; no fused multiply-add; interrupts are heard",
        "J2": "compiled, the library equals brute force on small inputs of every family",
        "X1": "the tests can fail: at least 95 % of the mutants are killed, of all once, of 200 others at every commit",
        "D1": "circumcentres are rounded once",
        "D2": "Voronoi edges are the duals of the edges of the triangulation",
        "D3": "a Voronoi cell is exactly what is nearest to its site",
        "D4": "clipped cells are exactly cell and window",
        "D5": "the cells of a conforming triangulation tile its domain",
        "D6": "Sibson's coordinates are the parts of the stolen cell",
        "D7": "the interpolant takes the data, is linear for linear data, and stays within its neighbours",
        "D8": "Lloyd's energy never grows",
        "ARR1": "all pairs of segments that meet are found, and no others",
        "ARR2": "a crossing is rounded to the nearest doubles, or into its grid cell",
        "ARR3": "the rounded arrangement is planar, and within its stated distance",
        "ARR4": "snap rounding is that of brute force",
        "ARR5": "bad input is named, and attributes come along",
        "ARR6": "snapping is local",
        "ARR7": "the neighbourhood that is searched again is large enough",
        "P1": "a graph is refused exactly for the faults that it has",
        "P2": "points at one position, and only those, share a representative",
        "P3": "rings, GeoJSON and shapely come back bit for bit",
        "P4": "graphs on file come back bit for bit",
        "P5": "whatever the bytes, a reader returns what is the same when written and read again, or a typed error",
        "P6": "what is written is read back bit for bit; a file is replaced whole or not at all",
        "G1": "what cannot be taken is refused by every function alike, and named",
        "G2": "what is returned or kept is frozen",
        "G3": "locate names a triangle that the point is in",
        "G4": "arrays and statistics are those of naive definitions",
        "H1": "the seeds of the holes alone carve the same domain",
        "A1": "what a package holds reaches the verifier bit for bit; what is no mesh is refused",
        "B1": "every planted fault is found within the default budget",
        "B2": "nothing can be left out of a counterexample, and it shows the same again",
        "B3": "the known failures of other meshers are found",
        "B4": "whatever a mesher does to its process, the trial goes on",
        "B5": "in a test suite, what is asserted is what is verified",
        "S1": "what is drawn is what it is said to be",
        "S2": "blunders are found, and shrunk",
        "T1": "dictionaries are those of the package",
        "T2": "a string of switches is read whole or refused",
        "T3": "where Triangle dies, hangs or is silent, there is a mesh, a warning or an error",
        "W1": "the examples in the documents run",
    }
)


def family(identifier: str) -> str:
    """Return the letters of an identifier."""
    return identifier.rstrip("0123456789")

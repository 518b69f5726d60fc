"""A million small inputs of every family against brute force.

``python -m proofs_tests.differential --inputs 1000000`` draws inputs of up to eight or ten points from the families of
:mod:`exactmesh.strategies`, by the families' own code but without hypothesis' engine, and compares what the compiled
library answers with brute force in Python's integers, which shares no line with the library, nor with the oracles of
the other tests:

* points: every orientation and every incircle test of them, and the one perturbed Delaunay triangulation;
* graphs: the one constrained Delaunay triangulation, or which segments cross; which triangles are the domain;
* triangulations, sound and spoilt: the verdicts of the verifier.

An input is named by its family, the seed and its number, and can be drawn again from these.
"""

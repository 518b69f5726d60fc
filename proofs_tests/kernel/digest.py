"""Prints one digest a routine over a fixed structured input: for comparing lanes and processes, bit for bit.

python -m proofs_tests.kernel.digest
"""

import hashlib
import struct
from itertools import product

import numpy as np

import exactkernel as ek
from exactkernel import doubledouble, expansions
from exactkernel.context import bits_of, guarded_context, make_context, scaled_into_window
from exactkernel.incircle import incircle_perturbed_adaptive
from exactkernel.shape import (
    angle_above_adaptive,
    angle_below_adaptive,
    angle_bound,
    area_above_adaptive,
    length_above_adaptive,
)

VALUES = (0.0, -0.0, 1.0, -1.0, 0.1, 1.0 + 2.0**-52, 3.0, 2.0**27 + 1.0, -1e16, 2.0**-200, 1e150, 1 / 3, -np.pi)
POINTS = np.array(
    [
        *product((0.0, 1.0, 0.1, 1.0 + 2.0**-52), repeat=2),
        (1e-200, 1e200),
        (5e-324, -5e-324),
        (1.7e308, -1.7e308),
        (3.0, 4.0),
        (2.0**-540, 2.0**500),
    ]
)


class Digest:
    """A hash of doubles and integers, NaN and the sign of zero included."""

    def __init__(self) -> None:
        self.hash = hashlib.sha256()

    def add(self, *values: float) -> None:
        for value in values:
            self.hash.update(struct.pack("<d", value))

    def __str__(self) -> str:
        return self.hash.hexdigest()[:16]


def transforms() -> dict[str, Digest]:
    digests = {}
    for name in ("two_sum", "two_diff", "fast_two_sum", "two_product"):
        digests[name] = Digest()
        for a, b in product(VALUES, repeat=2):
            digests[name].add(*getattr(expansions, name)(a, b))
    digests["split"] = Digest()
    for a in VALUES:
        digests["split"].add(*expansions.split(a))
    for name in ("dd_add", "dd_multiply"):
        digests[name] = Digest()
        for a, b in product(VALUES, repeat=2):
            digests[name].add(*getattr(doubledouble, name)(a, a * 2.0**-54, b, -b * 2.0**-55))
    return digests


def expansion_arithmetic() -> dict[str, Digest]:
    digest, h, scratch = Digest(), np.zeros(16), np.zeros(32)
    pairs = [expansions.two_sum(a, a * 2.0**-60) for a in VALUES]
    for p, q in product(pairs, repeat=2):
        n = expansions.determinant_2x2(*p, *q, *pairs[4], *pairs[-1], h, scratch)
        digest.add(n, *h[:n].tolist(), expansions.expansion_sign(h, n))
    e, f, total = np.zeros(2), np.zeros(2), np.zeros(8)
    for (a, a_tail), (b, b_tail) in product(pairs, repeat=2):
        ne, nf = expansions.pair(a, a_tail, e), expansions.pair(b, b_tail, f)
        expansions.negate(e, ne)
        for n in (
            expansions.expansion_sum(e, ne, f, nf, h),
            expansions.scale_expansion(e, ne, b, h),
            expansions.expansion_product(e, ne, f, nf, h, scratch, total),
        ):
            digest.add(n, *h[:n].tolist())
    return {"expansions": digest}


def predicates() -> dict[str, Digest]:
    digests = {name: Digest() for name in ("orient2d", "diametral", "incircle", "perturbed", "batch", "scan")}
    triples = list(product(POINTS[[1, 3, 6, 10, 16, 17, 18, 20]].tolist(), repeat=3))
    for triple in triples:
        digests["orient2d"].add(*ek.orient2d_staged(*triple))
        digests["diametral"].add(*ek.diametral_staged(*triple))
    context = make_context(POINTS)
    for i, (a, b, c) in enumerate(triples[::3]):
        d = POINTS[i % len(POINTS)].tolist()
        digests["incircle"].add(*ek.incircle_staged(a, b, c, d))
        digests["perturbed"].add(incircle_perturbed_adaptive(context, *a, *b, *c, *d))
    a, b, c = (np.array(triples)[:, i] for i in range(3))
    digests["batch"].add(*ek.orient2d_batch(a, b, c).tolist(), *ek.incircle_batch(a, b, c, POINTS[3]).tolist())
    scaled, _ = scaled_into_window(POINTS[:16] * 2.0**-600)
    digests["scan"].add(*bits_of(POINTS), *bits_of(scaled))
    return digests


def shapes() -> dict[str, Digest]:
    digest, guarded, context = Digest(), guarded_context(), make_context(POINTS[:16])
    bounds = [angle_bound(degrees) for degrees in (20.0, 45.0, 90.0, 135.0)]
    for triple in product(POINTS[[1, 3, 6, 10, 16, 17, 18, 20]].tolist(), repeat=3):
        if ek.orient2d(*triple) <= 0:
            continue
        k = context if all(point in POINTS[:16].tolist() for point in triple) else guarded
        a, b, c = triple
        for bound in bounds:
            digest.add(angle_below_adaptive(k, bound, *a, *b, *c), angle_above_adaptive(k, bound, *a, *b, *c))
        for limit in (0.5, 1e-9, 0.1):
            digest.add(area_above_adaptive(k, limit, *a, *b, *c), length_above_adaptive(k, 2 * limit, *a, *b))
    digest.add(*guarded.counts[0].tolist(), *context.counts[0].tolist())
    return {"shapes": digest}


if __name__ == "__main__":
    for name, digest in {**transforms(), **expansion_arithmetic(), **predicates(), **shapes()}.items():
        print(name, digest)

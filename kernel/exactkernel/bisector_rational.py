"""The predicates about bisectors in gmpy2 rationals; compiled loops reach them as :mod:`exactkernel.rational` says."""

from gmpy2 import mpq, sign

from exactkernel.jit import jit
from exactkernel.rational import Mailbox, RationalPoint, _is_answered, _next_number, _register

__all__ = [
    "along_from_doubles",
    "along_rational",
    "crossing_order_from_doubles",
    "crossing_order_rational",
    "nearer_from_doubles",
    "nearer_rational",
]


def nearer_rational(p: RationalPoint, q: RationalPoint, x: RationalPoint) -> int:
    """Return the exact sign of |x - p|^2 - |x - q|^2: +1 if x is nearer to q than to p."""
    px, py, qx, qy = x[0] - p[0], x[1] - p[1], x[0] - q[0], x[1] - q[1]
    return int(sign(px * px + py * py - qx * qx - qy * qy))


def along_rational(p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint) -> int:
    """Return the exact sign of the inner product (q - p) (b - a)."""
    return int(sign((q[0] - p[0]) * (b[0] - a[0]) + (q[1] - p[1]) * (b[1] - a[1])))


def crossing_order_rational(
    s: RationalPoint, p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint
) -> int:
    """Return the exact sign of N(p) D(q) - N(q) D(p), where a + (b - a) N(p) / (2 D(p)) is as near to s as to p."""
    dx, dy, cx, cy = b[0] - a[0], b[1] - a[1], s[0] - a[0], s[1] - a[1]
    px, py, qx, qy = p[0] - s[0], p[1] - s[1], q[0] - s[0], q[1] - s[1]
    n_p, n_q = 2 * (px * cx + py * cy) + px * px + py * py, 2 * (qx * cx + qy * cy) + qx * qx + qy * qy
    return int(sign(n_p * (qx * dx + qy * dy) - n_q * (px * dx + py * dy)))


def _nearer(px: float, py: float, qx: float, qy: float, x: float, y: float) -> int:
    return nearer_rational((mpq(px), mpq(py)), (mpq(qx), mpq(qy)), (mpq(x), mpq(y)))


def _along(px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float) -> int:
    return along_rational((mpq(px), mpq(py)), (mpq(qx), mpq(qy)), (mpq(ax), mpq(ay)), (mpq(bx), mpq(by)))


def _crossing_order(
    sx: float, sy: float, px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float
) -> int:
    s, p, q = (mpq(sx), mpq(sy)), (mpq(px), mpq(py)), (mpq(qx), mpq(qy))
    return crossing_order_rational(s, p, q, (mpq(ax), mpq(ay)), (mpq(bx), mpq(by)))


_ask_nearer = _register("exactmesh_nearer_rational", _nearer, 6)
_ask_along = _register("exactmesh_along_rational", _along, 8)
_ask_crossing_order = _register("exactmesh_crossing_order_rational", _crossing_order, 10)


@jit
def nearer_from_doubles(mailbox: Mailbox, px: float, py: float, qx: float, qy: float, x: float, y: float) -> int:
    """Return the exact sign of nearer of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_nearer(mailbox.ctypes.data, number, attempt, px, py, qx, qy, x, y)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def along_from_doubles(
    mailbox: Mailbox, px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float
) -> int:
    """Return the exact sign of along of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_along(mailbox.ctypes.data, number, attempt, px, py, qx, qy, ax, ay, bx, by)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def crossing_order_from_doubles(
    mailbox: Mailbox, sx: float, sy: float, px: float, py: float, qx: float, qy: float,
    ax: float, ay: float, bx: float, by: float,
) -> int:  # fmt: skip
    """Return the exact sign of crossing_order of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_crossing_order(mailbox.ctypes.data, number, attempt, sx, sy, px, py, qx, qy, ax, ay, bx, by)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1

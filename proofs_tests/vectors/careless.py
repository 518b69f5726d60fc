"""What the cases are meant to catch: the naive formulas in doubles, and Shewchuk's first stage without its guard.

Each function returns (determinant, permanent), computed in doubles as a program would. The naive answer is the sign of
the determinant; the unguarded filter believes it where it exceeds a bound times the permanent.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache

from proofs_tests.kernel.shape_oracle import cosine_interval

__all__ = ["FACTORS", "FORMULAS", "filter_sign", "naive_sign"]

Values = Sequence[float]
Pair = tuple[float, float]
_U = 2.0**-53


def orient2d(values: Values) -> Pair:
    ax, ay, bx, by, cx, cy = values
    left, right = (ax - cx) * (by - cy), (ay - cy) * (bx - cx)
    return left - right, abs(left) + abs(right)


def diametral(values: Values) -> Pair:
    ax, ay, bx, by, px, py = values
    left, right = (px - ax) * (bx - px), (py - ay) * (py - by)
    return left - right, abs(left) + abs(right)


def incircle(values: Values) -> Pair:
    ax, ay, bx, by, cx, cy, dx, dy = values
    a, A, b, B, c, C = ax - dx, ay - dy, bx - dx, by - dy, cx - dx, cy - dy
    lift_a, lift_b, lift_c = a * a + A * A, b * b + B * B, c * c + C * C
    bC, cB, cA, aC, aB, bA = b * C, c * B, c * A, a * C, a * B, b * A
    permanent = (
        (abs(bC) + abs(cB)) * lift_a + (abs(cA) + abs(aC)) * lift_b + (abs(aB) + abs(bA)) * lift_c
    )  # fmt: skip
    return lift_a * (bC - cB) + lift_b * (cA - aC) + lift_c * (aB - bA), permanent


def nearer(values: Values) -> Pair:
    px, py, qx, qy, x, y = values
    to_p = (x - px) * (x - px) + (y - py) * (y - py)
    to_q = (x - qx) * (x - qx) + (y - qy) * (y - qy)
    return to_p - to_q, to_p + to_q


def along(values: Values) -> Pair:
    px, py, qx, qy, ax, ay, bx, by = values
    left, right = (qx - px) * (bx - ax), (qy - py) * (by - ay)
    return left + right, abs(left) + abs(right)


def crossing_order(values: Values) -> Pair:
    sx, sy, px, py, qx, qy, ax, ay, bx, by = values
    dx, dy, cx, cy = bx - ax, by - ay, sx - ax, sy - ay
    wx, wy, vx, vy = px - sx, py - sy, qx - sx, qy - sy
    w_lift, v_lift = wx * wx + wy * wy, vx * vx + vy * vy
    n_w, n_v = 2.0 * (wx * cx + wy * cy) + w_lift, 2.0 * (vx * cx + vy * cy) + v_lift
    d_w, d_v = wx * dx + wy * dy, vx * dx + vy * dy
    permanent = (2.0 * (abs(wx * cx) + abs(wy * cy)) + w_lift) * (abs(vx * dx) + abs(vy * dy))
    permanent += (2.0 * (abs(vx * cx) + abs(vy * cy)) + v_lift) * (abs(wx * dx) + abs(wy * dy))
    return n_w * d_v - n_v * d_w, permanent


@cache
def cosine_and_sine(degrees: float) -> Pair:
    """Return the doubles nearest to cosine and sine, without the machine's own, which differ between machines."""
    bound = Fraction(degrees)
    (c, d), (s, t) = cosine_interval(bound, 220), cosine_interval(abs(90 - bound), 220)
    return float((c + d) / 2), float((s + t) / 2)


def _angles(values: Values) -> list[Pair]:
    degrees, ax, ay, bx, by, cx, cy = values
    cosine, sine = cosine_and_sine(degrees)
    found = []
    for px, py, qx, qy, rx, ry in ((ax, ay, bx, by, cx, cy), (bx, by, cx, cy, ax, ay), (cx, cy, ax, ay, bx, by)):
        ux, uy, vx, vy = qx - px, qy - py, rx - px, ry - py
        cross, dot = abs(ux * vy - uy * vx), ux * vx + uy * vy
        weight = sine * (abs(ux * vx) + abs(uy * vy)) + abs(cosine) * (abs(ux * vy) + abs(uy * vx))
        found.append((cosine * cross - sine * dot, weight))
    return found


def angle_below(values: Values) -> Pair:
    pairs = _angles(values)
    return min(pair[0] for pair in pairs), max(pair[1] for pair in pairs)


def angle_above(values: Values) -> Pair:
    pairs = _angles(values)
    return max(pair[0] for pair in pairs), max(pair[1] for pair in pairs)


def area(values: Values) -> Pair:
    bound, ax, ay, bx, by, cx, cy = values
    left, right, twice = (ax - cx) * (by - cy), (ay - cy) * (bx - cx), 2.0 * bound
    return abs(left - right) - twice, abs(left) + abs(right) + twice


def length(values: Values) -> Pair:
    bound, ax, ay, bx, by = values
    squared, limit = (bx - ax) * (bx - ax) + (by - ay) * (by - ay), bound * bound
    return squared - limit, squared + limit


FORMULAS = {
    "orient2d": orient2d,
    "diametral": diametral,
    "incircle": incircle,
    "nearer": nearer,
    "along": along,
    "crossing_order": crossing_order,
    "angle_below": angle_below,
    "angle_above": angle_above,
    "area": area,
    "length": length,
}
#: The factors of the permanents: Shewchuk's, and what the calculus gives for the others.
FACTORS = {
    name: {"incircle": 10 + 96 * _U, "crossing_order": 10 + 96 * _U, "nearer": 4 + 32 * _U}.get(name, 3 + 16 * _U) * _U
    for name in FORMULAS
} | dict.fromkeys(("angle_below", "angle_above", "area", "length"), 4 * (3 + 16 * _U) * _U)


def naive_sign(name: str, values: Values) -> int:
    """Return the sign of the formula in doubles; 0 for NaN."""
    det, _ = FORMULAS[name](values)
    return (det > 0.0) - (det < 0.0)


def filter_sign(name: str, values: Values) -> int:
    """Return what a filter without a guard certifies: +-1, or 0 where it leaves the decision to a later stage."""
    det, permanent = FORMULAS[name](values)
    error = FACTORS[name] * permanent
    return (det > error) - (-det > error)

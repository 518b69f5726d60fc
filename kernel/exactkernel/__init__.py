"""exactkernel: the planar predicates with exact signs, for every finite double and for rationals.

>>> from exactkernel import orient2d, incircle
>>> orient2d((0, 0), (1, 0), (0, 1)), incircle((0, 0), (1, 0), (0, 1), (1, 1))
(<Sign.POSITIVE: 1>, <Sign.ZERO: 0>)
"""

from exactkernel.batch import diametral_batch, incircle_batch, orient2d_batch
from exactkernel.constructions import (
    RoundedPoint,
    circumcentre,
    point_on_segment,
    rounded,
    segment_crossing,
)
from exactkernel.diametral import diametral, diametral_staged
from exactkernel.errors import BoundError, CoordinateError, DegenerateError, ExactMeshError, NonFiniteError, ShapeError
from exactkernel.incircle import incircle, incircle_perturbed, incircle_staged
from exactkernel.orient2d import orient2d, orient2d_staged
from exactkernel.shape import angle_above, angle_below, area_above, length_above
from exactkernel.types import Coordinate, PointLike, Sign, Stage

__all__ = [
    "BoundError",
    "Coordinate",
    "CoordinateError",
    "DegenerateError",
    "ExactMeshError",
    "NonFiniteError",
    "PointLike",
    "RoundedPoint",
    "ShapeError",
    "Sign",
    "Stage",
    "angle_above",
    "angle_below",
    "area_above",
    "circumcentre",
    "diametral",
    "diametral_batch",
    "diametral_staged",
    "incircle",
    "incircle_batch",
    "incircle_perturbed",
    "incircle_staged",
    "length_above",
    "orient2d",
    "orient2d_batch",
    "orient2d_staged",
    "point_on_segment",
    "rounded",
    "segment_crossing",
]

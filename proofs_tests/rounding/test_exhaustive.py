"""K3, K4: the shipped filters over every input of tiny formats, compiled: faults are found, and not by chance."""

from collections.abc import Callable

import numpy as np
import pytest
from proofs_tests.rounding.minifloat import Backend, MiniFloat, all_numbers, derive, round_array
from proofs_tests.rounding.minifloat_filters import FILTERS, bound_of, tally, tally_of_doubles
from proofs_tests.rounding.minifloat_inputs import Axis, axis_of, offsets
from proofs_tests.rounding.minifloat_shapes import SHAPES, shape_tally

from exactkernel.constants import SHAPE_FACTOR

pytestmark = pytest.mark.compiled  # interpreted, they would take hours; test_filter.py has small ones

Record = Callable[[str, object], None]

#: (filter, bits, binades): every input whose coordinates are zero or in so many neighbouring binades.
FORMATS = [
    ("orient2d", 3, 4),
    ("orient2d", 4, 3),
    ("orient2d", 5, 2),
    ("diametral", 3, 4),
    ("diametral", 4, 3),
    ("along", 3, 3),
    ("nearer", 5, 1),
    ("nearer", 6, 0),
]

#: A multiple of u, below the shipped constant, with which lies are found, and where; not always the largest one.
UNSOUND = [
    ("orient2d", 3, 3, 1.0),
    ("orient2d", 4, 3, 1.5),
    ("orient2d", 5, 2, 1.75),
    ("diametral", 3, 3, 1.0),
    ("along", 3, 3, 1.0),
    ("nearer", 5, 1, 2.0),
    ("incircle", 3, 1, 1.0),
    ("incircle", 5, 0, 1.5),
]
UNSOUND_SHAPES = [("angle", 1.75), ("area", 0.5), ("length", 0.5)]

SPARSE = 3

OFFSETS = {"incircle": 8, "nearer": 20}  # offsets from the last point, without rounding, where binades are 0


def inputs(name: str, precision: int, binades: int, quantum: float = 0.0) -> Axis:
    if binades > 0:
        return FILTERS[name].axis(precision, binades, quantum)
    if name == "nearer":
        coordinates, exact = offsets(OFFSETS[name], 2)
        return coordinates, -exact  # x - p, with x last
    return offsets(OFFSETS[name], 3)


@pytest.mark.obligation(
    "K3",
    "the filters of degree 2 never lie: every input of 3, 4 and 5 bits in few binades",
    method="exhaustive",
    control_in="TestFaultsAreFound",
)
class TestFiltersOfDegree2:
    """Over every input of the format, a sign that the filter certifies is the exact one, with the shipped constant for
    the unit roundoff of the format.

    Every input: coordinates are zero or p-bit numbers of both signs in so many binades; one input for each class that
    the filter can tell apart (equal exact and equal rounded differences on both axes, mirror images, exchanged axes).
    For ``along``, the differences are independent of each other: that includes is_ahead and is_nearer, which are of the
    same form. For ``nearer`` with 0 binades, offsets from x are all integers up to 20.
    """

    @pytest.mark.parametrize(("name", "precision", "binades"), FORMATS)
    def test_shipped(self, name: str, precision: int, binades: int, record_property: Record) -> None:
        axis = inputs(name, precision, binades)
        tried, certified, lies = tally(name, MiniFloat(precision), bound_of(name, precision), axis)
        record_property("cases", tried)
        assert lies == 0
        assert certified > tried / 2

    @pytest.mark.parametrize(
        ("name", "precision", "binades"), [("orient2d", 3, 3), ("diametral", 3, 3), ("nearer", 5, 1)]
    )
    def test_underflow_inside_the_window(
        self, name: str, precision: int, binades: int, record_property: Record
    ) -> None:
        """The coordinates are multiples of g, and the smallest subnormal is g^2: the bottom of the window."""
        axis = inputs(name, precision, binades, 1.0)
        tried, certified, lies = tally(name, MiniFloat(precision, 1.0), bound_of(name, precision), axis)
        record_property("cases", tried)
        assert lies == 0
        assert certified > tried / 2


@pytest.mark.obligation(
    "K3",
    "the filter of incircle never lies: 3 bits; 5 and 6 bits where the differences are exact",
    method="exhaustive",
    control_in="TestFaultsAreFound",
)
class TestIncircle:
    """As above, for incircle.

    With 3 bits, (10 + 96 u) u is more than 1, and no filter certifies anything. So two sets: with 3 bits and the
    constant 6 u, every a, b, c, d with coordinates zero or in one binade, rounded differences included; with 5 and 6
    bits and the shipped constant, every a, b, c whose offsets from d are integers of at most 12 and 8.
    """

    def test_rounded_differences(self, record_property: Record) -> None:
        tried, certified, lies = tally("incircle", MiniFloat(3), 6.0 * 2.0**-3, inputs("incircle", 3, 1))
        record_property("cases", tried)
        assert lies == 0
        assert certified > tried / 20

    @pytest.mark.parametrize(("precision", "largest"), [(5, 12), (6, 8)])
    def test_shipped(self, precision: int, largest: int, record_property: Record) -> None:
        axis, bound = offsets(largest, 3), bound_of("incircle", precision)
        tried, certified, lies = tally("incircle", MiniFloat(precision), bound, axis)
        record_property("cases", tried)
        assert lies == 0
        assert certified > tried / 3

    def test_underflow_inside_the_window(self, record_property: Record) -> None:
        """Offsets are multiples of g, and the smallest subnormal is g^4."""
        tried, certified, lies = tally("incircle", MiniFloat(5, 1.0), bound_of("incircle", 5), inputs("incircle", 5, 0))
        record_property("cases", tried)
        assert lies == 0
        assert certified > tried / 3


@pytest.mark.obligation(
    "K3",
    "the filters of angles, areas and lengths never lie: 5 bits",
    method="exhaustive",
    control_in="TestFaultsAreFound",
)
class TestShapes:
    """As above, for all sides that are pairs of integers up to 8 (6 for angles, 31 for lengths), and all bounds of 5
    bits: areas and lengths zero or in ten binades; for angles sines of 1 to 2, and cosines zero, of 1 to 2 or a quarter
    of that, where the true ones may be any within u of them."""

    @pytest.mark.parametrize("name", SHAPES)
    def test_shipped(self, name: str, record_property: Record) -> None:
        tried, certified, lies = shape_tally(name, MiniFloat(5), SHAPE_FACTOR * bound_of("orient2d", 5))
        record_property("cases", tried)
        assert lies == 0
        assert certified > tried / 2


@pytest.mark.obligation("K4", "unsound constants, missing guards and wrong filters are found", method="exhaustive")
class TestFaultsAreFound:
    """The same searches find lies where there are some, however few; random doubles find none of them."""

    @pytest.mark.parametrize(("name", "precision", "binades", "factor"), UNSOUND)
    def test_control_an_unsound_constant(self, name: str, precision: int, binades: int, factor: float) -> None:
        """A constant of one or two u, with each filter; every third class of x is enough."""
        axis = inputs(name, precision, binades)
        assert tally(name, MiniFloat(precision), factor * 2.0**-precision, axis, step=SPARSE)[2] > 0

    @pytest.mark.parametrize(("name", "factor"), UNSOUND_SHAPES)
    def test_control_an_unsound_constant_for_shapes(self, name: str, factor: float) -> None:
        """A constant of about one u for angles, areas and lengths."""
        assert shape_tally(name, MiniFloat(5), factor * 2.0**-5)[2] > 0

    @pytest.mark.parametrize(
        ("name", "precision", "binades"),
        [("orient2d", 3, 3), ("diametral", 3, 3), ("nearer", 5, 1), ("incircle", 5, 0)],
    )
    def test_control_one_step_outside_the_window(self, name: str, precision: int, binades: int) -> None:
        """The smallest subnormal twice as large as the window allows, and no guard."""
        axis = inputs(name, precision, binades, 2.0)
        assert tally(name, MiniFloat(precision, 2.0), bound_of(name, precision), axis)[2] > 0

    @pytest.mark.parametrize(
        ("name", "function", "edit"),
        [
            ("orient2d", "orient2d_filter", ("-det > error", "-det >= error")),
            ("orient2d", "orient2d_filter", ("(by - cy)", "(by - ay)")),
            ("diametral", "diametral_filter", ("(py - by)", "(by - py)")),
            ("incircle", "determinant_and_permanent", ("lift_b * (cA - aC)", "lift_b * (aC - cA)")),
            ("incircle", "determinant_and_permanent", ("c * c + C * C", "c * c - C * C")),
        ],
    )
    def test_control_a_wrong_filter(self, name: str, function: str, edit: tuple[str, str]) -> None:
        """A comparison that admits equality, a wrong difference, a wrong sign."""
        precision = 6 if name == "incircle" else 3
        axis = offsets(3, 3) if name == "incircle" else inputs(name, 3, 2)
        mini = MiniFloat(precision, edits={function: edit})
        assert tally(name, mini, bound_of(name, precision), axis)[2] > 0

    @pytest.mark.parametrize(("name", "factor"), [("orient2d", 1.75), ("diametral", 1.0), ("incircle", 1.5)])
    def test_random_doubles_find_none(self, name: str, factor: float) -> None:
        """Why all inputs of a small format are tried: random doubles do not notice the unsound constants of above."""
        tried, certified, lies = tally_of_doubles(name, factor * 2.0**-53, 20000)
        assert certified > 0.99 * tried
        assert lies == 0


@pytest.mark.obligation("K3", "the enumeration leaves out nothing, and rounds as it should", method="exhaustive")
class TestEnumeration:
    """Every input is in a class that was tried, and the compiled rounding is that of the definition."""

    def test_every_input_has_its_class(self) -> None:
        _, exact = axis_of(3, 2, 3, ((0, 2), (1, 2)))
        values = all_numbers(3, range(2))
        classes = {tuple(row) for row in exact.T.tolist()}
        for a in values:
            for b in values:
                for c in values:
                    p, q = int(a - c), int(b - c)
                    assert (p, q) in classes or (-p, -q) in classes

    @pytest.mark.parametrize(("precision", "quantum"), [(3, 0.0), (5, 0.0), (3, 4.0), (5, 2.0)])
    def test_rounding(self, precision: int, quantum: float) -> None:
        x = np.arange(-4096, 4097) / 8.0
        both = derive([rounded_once], MiniFloat(precision, quantum), Backend.LOOPS)["rounded_once"]
        assert [both(v) for v in x.tolist()] == round_array(x, precision, quantum).tolist()

    def test_control_exchanged_axes(self) -> None:
        """An asymmetry of the source: half of the pairs would not do."""
        axis, mini = inputs("orient2d", 3, 2), MiniFloat(3)
        turned = (axis[0][:, ::-1], axis[1][:, ::-1])
        bound = bound_of("orient2d", 3)
        assert tally("orient2d", mini, bound, axis) == tally("orient2d", mini, bound, turned)
        skewed = MiniFloat(3, edits={"orient2d_filter": ("abs(left) + abs(right)", "abs(left)")})
        assert tally("orient2d", skewed, bound, axis) != tally("orient2d", skewed, bound, turned)


def rounded_once(x: float) -> float:
    return x + 0.0

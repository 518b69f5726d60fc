"""Lines with a bound that no Gappa script models: which class proves them, or why there is nothing to prove."""

__all__ = ["NOTHING_TO_PROVE", "PROVED"]

#: By class: function, then lines of it or parts with the bounds; none stand for all of its lines.
PROVED: dict[str, dict[str, tuple[str, ...]]] = {
    "rounding/test_filter.py::TestConstants": {
        "exactkernel.bisector.crossing_order_adaptive": (
            "error = INCIRCLE_BOUND * ( (2.0 * (abs(wx * cx) + abs(wy * cy)) + w_lift) * (abs(vx * dx) + abs(vy * dy))"
            " + (2.0 * (abs(vx * cx) + abs(vy * cy)) + v_lift) * (abs(wx * dx) + abs(wy * dy)) )",
            "det > error",
            "-det > error",
        ),
        "exactkernel.incircle.incircle_filter": (),
        "exactkernel.diametral.diametral_slow": ("sign = diametral_filter(ORIENT2D_BOUND, ax, ay, bx, by, px, py)",),
        "exactkernel.incircle.incircle_slow": (
            "sign = incircle_filter(INCIRCLE_BOUND, ax, ay, bx, by, cx, cy, dx, dy)",
        ),
        "exactkernel.orient2d.orient2d_slow": ("sign = orient2d_filter(ORIENT2D_BOUND, ax, ay, bx, by, cx, cy)",),
    },
    # the bound of the context is that of the filter, or infinite outside of the window
    "rounding/test_windows.py::TestContext": {
        "exactkernel.diametral.diametral_adaptive": (),
        "exactkernel.incircle.incircle_adaptive": (),
        "exactkernel.incircle.incircle_perturbed_adaptive": (),
        "exactkernel.orient2d.orient2d_adaptive": (),
    },
    "rounding/test_windows.py::TestScalarWindow": {
        "exactkernel.diametral.diametral_slow": ("c.orient2d_bound == math.inf",),
        "exactkernel.incircle.incircle_slow": ("k.incircle_bound == math.inf",),
        "exactkernel.incircle.safe_degree_4": (),
        "exactkernel.orient2d.orient2d_slow": ("c.orient2d_bound == math.inf",),
        "exactkernel.orient2d.safe_degree_2": (),
    },
    "rounding/test_windows.py::TestScaling": {
        "exactkernel.context.exponent_into_window": (),
        "exactkernel.context.scaled_into_window": (),
        "exactmesh.editing.draft.fitted": (),
        "exactmesh.refinement.layout.laid_out": (),
    },
    "rounding/test_window_ends.py::TestLoops": {
        "exactkernel.bisector.along_adaptive": ("k.orient2d_bound == math.inf",),
        "exactkernel.bisector.crossing_order_adaptive": ("k.incircle_bound == math.inf",),
        "exactkernel.bisector.nearer_adaptive": ("k.incircle_bound == math.inf",),
    },
    "rounding/test_window_ends.py::TestShapes": {
        "exactkernel.angle.corner_code": ("k.orient2d_bound < math.inf",),
        "exactkernel.measure.area_code": ("k.orient2d_bound == math.inf",),
        "exactkernel.measure.length_code": ("k.orient2d_bound == math.inf",),
    },
    "rounding/test_window_ends.py::TestWeights": {
        "exactmesh.verify.grading.grade": ("not SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT",),
    },
    "rounding/test_window_ends.py::TestConstructions": {
        "exactkernel.centre.circumcentre_in_pairs": ("k.incircle_bound == inf",),
        "exactkernel.crossing._is_safe": (),
        "exactkernel.crossing.crossing_in_pairs": ("k.incircle_bound == inf",),
        "exactmesh.crossings.crossing_points.__call__": (),
        "exactmesh.voronoi.centres.centres_of": (),
    },
    "rounding/test_window_ends.py::TestOtherWindows": {
        "exactmesh.crossings.hot_pixels._in_grid_units": (),
        "exactmesh.refinement.split_point._is_safe": (),
        "exactmesh.refinement.split_point._rounded": (),
    },
    "rounding/test_transforms.py::TestProduct": {"exactkernel.expansions.two_product": ()},
    "kernel/test_anglebound.py::TestEnclosures": {"exactkernel.anglebound.cosine_and_sine": ()},
    "kernel/test_bisector_crossing.py::TestErrors": {
        "exactkernel.bisector.bisector_crossing": (
            "n_error, det_error = DD_BOUND * n_permanent, 2.0 * DD_BOUND * det_permanent",
            "k.incircle_bound == math.inf",
        ),
    },
    "kernel/test_centre.py::TestNearest": {
        "exactkernel.centre._decided": (),
        "exactkernel.centre.nearest_circumcentre": (),
    },
    "kernel/test_crossing_parts.py::TestParts": {"exactkernel.crossing._zero_if_possible": ()},
    "kernel/test_shape.py::TestTrigonometry": {"exactkernel.angle.angle_bound": ()},
    "refinement/test_split_point.py::TestSplitPoint": {
        "exactmesh.refinement.split_point._is_multiple": (),
        "exactmesh.refinement.split_point._lowest_bit": (),
        "exactmesh.refinement.split_point._most_halves": (),
    },
    "verify/test_dual_passes.py::TestBetweenNeighbours": {
        "exactmesh.verify.dual_passes.between_neighbours": ("not error < math.inf",),
    },
    "verify/test_grading.py::TestPasses": {
        "exactmesh.verify.grading.grade_circles": (),
        "exactmesh.verify.grading.grade_diametral": (),
        "exactmesh.verify.grading.grade_lengths": (),
    },
    "verify/test_nearest.py::TestWithin": {
        "exactmesh.verify.nearest.nearest_corners": (),
    },
    "voronoi/test_clip.py::TestWindow": {"exactmesh.voronoi.clipping._crossing_places": ()},
    "voronoi/test_stolen_areas.py::TestErrors": {
        "exactmesh.voronoi.cavity._areas": (),
        "exactmesh.voronoi.cavity._centre": (),
        "exactmesh.voronoi.cavity.coordinates_of": (),
    },
}

_WINDOW = "looks whether the input is inside the window, compares nothing with it: outside, fractions decide"
_EXACT = "compares fractions, or hands the constant to where they are compared"
_WHERE = "where a vertex would best be put, or what is done first; that the result is right is decided by predicates"

#: By reason, as above.
NOTHING_TO_PROVE: dict[str, dict[str, tuple[str, ...]]] = {
    _WINDOW: {
        "exactkernel.context.chunk_size": (),
        "exactmesh.crossings.chain_distance.across": ("k.incircle_bound == math.inf",),
        "exactmesh.refinement.displacement._distance_bounds": ("k.incircle_bound == math.inf",),
        "exactmesh.verify.displaced.near_chains": ("mesh.context.orient2d_bound == math.inf",),
        "exactmesh.verify.grading.rank_angles": (),
        "exactmesh.verify.grading.rank_areas": (),
        "exactmesh.verify.grading.rank_circles": (),
        "exactmesh.verify.grading.rank_diametral": (),
        "exactmesh.verify.grading.rank_lengths": (),
        "exactmesh.voronoi.relaxation._exponent": (),
    },
    _WHERE: {
        "exactmesh.crossings.segment_meetings._neighbours_first": (),
        "exactmesh.crossings.segment_tree.split_top": (),
        "exactmesh.refinement.layout.mark_sharp": (),
        "exactmesh.refinement.placement.move_to_lattice": (),
        "exactmesh.refinement.placement.nearest_on_lattice": (),
        "exactmesh.refinement.placement.place_centre": (),
        "exactmesh.refinement.queue.bucket_of": (),
        "exactmesh.refinement.segments.concentric": (),
        "exactmesh.refinement.segments.divide_segment": (),
        "exactmesh.refinement.segments.parameter": (),
        "exactmesh.refinement.split_point.split_point": (),
        "exactmesh.refinement.triangles.is_thick": (),
    },
    _EXACT: {
        "exactmesh.verify.delaunay.describe": (),
        "exactmesh.verify.duality._leaves": (),
        "exactmesh.verify.gabriel.describe": (),
        "exactmesh.verify.grading.decide": (),
    },
    "integers": {"exactmesh.grid_rounding.grid_spacing": ()},
}

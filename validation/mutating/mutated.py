"""The files of the package that are mutated, and the tests of each that are to notice.

Every file of the paper's page, of the judge, of the solvers, of contacts and of the model is here.
"""

PAGE = (
    "equations/test_eq01_impedance.py",
    "equations/test_eq04_contact_rows.py",
    "equations/test_eq05_tangential_directions.py",
    "equations/test_eq06_opposite_tangents.py",
    "equations/test_eq07_torsional_directions.py",
    "equations/test_eq08_stacked_rows.py",
    "equations/test_eq13_step_problem.py",
)
JUDGE = (
    "equations/test_eq09_force_balance.py",
    "equations/test_eq10_primal_feasibility.py",
    "equations/test_eq11_dual_feasibility.py",
    "equations/test_eq12_complementarity.py",
)
EXACT = (
    "unit/certify/test_exact.py",
    "unit/certify/test_active_set.py",
    "unit/certify/test_rational.py",
    "unit/certify/test_rounding.py",
    "unit/certify/test_certificate.py",
    "unit/certify/test_farkas.py",
    "unit/certify/test_confirm.py",
    "properties/test_exact_against_enumeration.py",
)


def units(room: str, *names: str) -> tuple[str, ...]:
    """The tests of units of a room, by the names of their files."""
    return tuple(f"unit/{room}/test_{name}.py" for name in names)


SYSTEM = units("model", "system", "system_forces", "system_refusals")
CONTACT = (
    "equations/test_eq02_relative_velocity.py",
    "equations/test_eq03_contact_jacobian.py",
)
FOLLOWED = ("unit/contact/test_tracker_bound.py", "properties/test_tracker.py")
FORGED = (
    "unit/certify/test_single_faults.py",
    "unit/certify/test_enclosure.py",
    "properties/test_forgeries.py",
)
ENCLOSED = (
    "unit/certify/test_checked_pair.py",
    "unit/certify/test_interior.py",
    "unit/certify/test_newton.py",
    "unit/certify/test_enclosure.py",
    "unit/solve/test_native.py",
)
PAIRS = units("contact", "corners", "distance", "pairs", "jacobian")
SOLIDS = units("contact", "corners", "polytopes", "solid_pairs", "distance", "curved_pairs")
LARGE = ("unit/certify/test_sparse_bound.py", "unit/certify/test_bound_formulas.py")
SPARSE = (*units("step", "kept_and_shown", "mass_in_blocks", "sparse"), *units("solve", "solver"))
CLOUDS = units("model", "clouds", "cloud_headers", "meshes")
SCENES = (
    "unit/simulate/test_scenario.py",
    "unit/simulate/test_simulator.py",
    "unit/step/test_words.py",
)
URDF = (
    *units("model", "urdf", "urdf_refusals", "urdf_limits", "meshes"),
    "errors/test_bad_urdfs.py",
)
DATA = units("step", "arrays", "kept_and_shown", "data", "plain_data", "step_files")
MASSES = (*SYSTEM, "unit/step/test_mass_in_blocks.py")
SOLVERS = units(
    "solve",
    "adapters",
    "second_order",
    "extended",
    "kept_between_steps",
    "native",
    "backends",
    "solver",
    "units",
)
SOLVED = (
    "unit/solve/test_kept_between_steps.py",
    "unit/solve/test_plain_programs.py",
    "unit/solve/test_solver.py",
    "unit/solve/test_backends.py",
    "unit/step/test_problem.py",
    "unit/step/test_cones.py",
)
CURVED = units("contact", "curved_witness", "curved_pairs", "faces", "distance_guard", "distance")
DRAWN = "unit/model/test_shapes.py"

DIFFERENTIATED = (
    "unit/certify/test_touching.py",
    "unit/simulate/test_derivatives.py",
    "unit/simulate/test_derivative_verdicts.py",
    "unit/simulate/test_one_sided.py",
    "vectors/test_derivative_layer.py",
)


def ordered(own: str) -> tuple[str, ...]:
    """The tests of the exact method, those of one unit first."""
    first = f"unit/certify/test_{own}.py"
    return (first, *(test for test in EXACT if test != first))


TESTS: dict[str, tuple[str, ...]] = {
    "step/problem.py": ("unit/step/test_standard_form.py", *PAGE, "unit/step/test_problem.py"),
    "step/friction.py": ("unit/step/test_friction.py", *PAGE, "unit/step/test_cones.py"),
    "step/standard_form.py": ("unit/step/test_standard_form.py", *PAGE),
    "certify/optimality.py": (
        "unit/certify/test_optimality.py",
        *JUDGE,
        "unit/certify/test_enclosure.py",
    ),
    "certify/dyadic.py": ordered("rational"),
    "certify/rational.py": ordered("rational"),
    "certify/kkt.py": ordered("exact"),
    "certify/dependence.py": ordered("dependence"),
    "certify/balls.py": ordered("balls"),
    "certify/point.py": ordered("exact"),
    "certify/active_set.py": ordered("active_set"),
    "certify/degeneracy.py": ordered("exact"),
    "certify/rounding.py": ordered("rounding"),
    "certify/exact.py": ordered("exact"),
    "certify/exact_step.py": ordered("farkas"),
    "certify/confirm.py": ("unit/certify/test_confirm.py",),
    "certify/bound.py": ("unit/certify/test_bound.py", *FORGED),
    "certify/rounded_bound.py": (
        "unit/certify/test_rounded_bound.py",
        "unit/certify/test_bound_formulas.py",
    ),
    "certify/exchange.py": ("unit/certify/test_exchange.py",),
    "certify/least_eigenvalues.py": LARGE,
    "certify/opening.py": LARGE,
    "certify/outward.py": ("unit/certify/test_sizes.py", *LARGE),
    "certify/sizes.py": ("unit/certify/test_sizes.py", *LARGE),
    "certify/sparse_bound.py": LARGE,
    "certify/gap.py": ("unit/certify/test_gap.py", *FORGED),
    "certify/impulses.py": ("unit/certify/test_impulses.py", *FORGED),
    "certify/judged.py": ("unit/certify/test_judged.py", *FORGED),
    "certify/ellipsoid.py": ("unit/certify/test_apex.py", *FORGED),
    "certify/apex.py": ("unit/certify/test_apex.py", *FORGED),
    "certify/conic.py": ("unit/certify/test_conic.py", *FORGED),
    "certify/verdict.py": ("unit/certify/test_certificate.py", *FORGED),
    "certify/warm.py": ("unit/certify/test_warm.py", *EXACT),
    "certify/sensitivity.py": (
        "unit/certify/test_sensitivity.py",
        "unit/certify/test_obstacles.py",
    ),
    "certify/parameters.py": ("unit/certify/test_sensitivity.py", "unit/certify/test_obstacles.py"),
    "certify/rows.py": ("unit/certify/test_certificate.py", "unit/certify/test_farkas.py"),
    "certify/farkas.py": ("unit/certify/test_farkas.py",),
    "certify/certificate.py": ordered("certificate"),
    "certify/norm.py": ("unit/certify/test_digits.py", "unit/certify/test_farkas.py"),
    "certify/digits.py": ("unit/certify/test_digits.py",),
    "model/coordinates.py": ("unit/model/test_system.py",),
    "model/rotation.py": ("unit/model/test_rotation.py",),
    "model/system.py": MASSES,
    "contact/jacobian.py": ("unit/contact/test_jacobian.py", *CONTACT),
    "contact/cloud.py": ("unit/contact/test_cloud.py",),
    "contact/pairs.py": ("unit/contact/test_pairs.py", "unit/contact/test_jacobian.py"),
    "contact/tracker.py": FOLLOWED,
    "contact/cloud_tracker.py": FOLLOWED,
    "contact/batch.py": FOLLOWED,
    "contact/tracker_bound.py": FOLLOWED,
    "contact/ball_tree.py": FOLLOWED,
    "contact/settle.py": CURVED,
    "contact/faces.py": CURVED,
    "contact/by_coal.py": CURVED,
    "contact/curved_pair.py": CURVED,
    "certify/enclosure.py": ENCLOSED,
    "certify/interior.py": ENCLOSED,
    "certify/newton.py": ENCLOSED,
    "certify/scaled_blocks.py": ENCLOSED,
    "contact/distance.py": PAIRS,
    "contact/placed.py": SOLIDS,
    "contact/polytope.py": SOLIDS,
    "contact/polytope_pair.py": SOLIDS,
    "contact/poses.py": FOLLOWED,
    "contact/solid_pair.py": ("unit/contact/test_polytopes.py", *CURVED),
    "contact/solid_rows.py": ("unit/lab/test_step_time.py", *FOLLOWED, *PAIRS),
    "contact/sparse_jacobian.py": SPARSE,
    "contact/ways_out.py": ("unit/contact/test_ways_out.py", *SOLIDS),
    "model/body.py": ("unit/model/test_solid.py", "unit/model/test_planar.py", *SCENES),
    "model/clouds.py": CLOUDS,
    "model/configuration.py": (*units("model", "configuration", "system_refusals"), *SCENES),
    "model/convex_mesh.py": (*units("model", "meshes", "shapes"), *SOLIDS),
    "model/dae.py": ("unit/model/test_meshes.py",),
    "model/frozen.py": ("unit/model/test_shapes.py", "unit/step/test_plain_data.py", *SYSTEM),
    "model/kinematics.py": ("unit/model/test_system.py", *CONTACT),
    "model/mesh_files.py": ("unit/model/test_meshes.py",),
    "model/motion.py": ("unit/model/test_system.py", "unit/simulate/test_simulator.py", *CONTACT),
    "model/pcd.py": CLOUDS,
    "model/ply.py": CLOUDS,
    "model/point_table.py": CLOUDS,
    "model/screw.py": units("model", "screw", "rotation", "system"),
    "model/shapes.py": (*units("model", "shapes", "solid"), "unit/step/test_words.py"),
    "model/point_cloud.py": (DRAWN, *CLOUDS),
    "model/solids/box.py": (DRAWN, *SOLIDS),
    "model/solids/capsule.py": (DRAWN, *SOLIDS),
    "model/solids/cone.py": ("unit/contact/test_curved_points.py", DRAWN, *CURVED),
    "model/solids/cylinder.py": (DRAWN, *CURVED),
    "model/solids/ellipsoid.py": ("unit/contact/test_curved_points.py", DRAWN, *CURVED),
    "model/solids/half_space.py": ("unit/contact/test_cloud.py", DRAWN, *SOLIDS),
    "model/solids/hull.py": SOLIDS,
    "model/solids/round.py": SOLIDS,
    "model/solids/rounded.py": ("unit/contact/test_cloud.py", *SOLIDS),
    "model/solids/shape.py": ("unit/model/test_a_shape_added.py", DRAWN, *SOLIDS),
    "model/solids/sphere.py": (DRAWN, *SOLIDS),
    "model/solid.py": ("unit/model/test_solid.py", "unit/step/test_plain_data.py"),
    "model/text.py": URDF,
    "model/urdf.py": URDF,
    "model/urdf_file.py": URDF,
    "model/urdf_inertia.py": URDF,
    "model/urdf_shapes.py": URDF,
    "model/urdf_tree.py": URDF,
    "model/urdf_xml.py": URDF,
    "model/words.py": ("unit/step/test_words.py", "unit/step/test_plain_data.py"),
    "model/workspace.py": (*units("model", "world"), *MASSES, "unit/simulate/test_memory.py"),
    "model/world.py": (
        *units("model", "world", "planar", "system"),
        "unit/step/test_sparse.py",
        *SYSTEM[1:],
    ),
    "solve/adapters/clarabel.py": SOLVERS,
    "solve/adapters/daqp.py": SOLVERS,
    "solve/adapters/osqp.py": SOLVERS,
    "solve/adapters/piqp.py": SOLVERS,
    "solve/adapters/program.py": SOLVERS,
    "solve/adapters/quadprog.py": SOLVERS,
    "solve/backends.py": SOLVERS,
    "solve/cone_problem.py": ("unit/step/test_standard_form.py", *SOLVERS),
    "solve/engines.py": ("unit/solve/test_defaults.py", *SOLVERS),
    "solve/extended.py": SOLVERS,
    "solve/native.py": ("unit/solve/test_native.py", "unit/solve/test_units.py"),
    "solve/scaled.py": SOLVERS,
    "solve/second_order.py": ("unit/solve/test_native.py", "unit/step/test_cones.py"),
    "solve/solve.py": (*SOLVED, "unit/solve/test_native.py"),
    "solve/solver.py": SOLVED,
    "solve/sparse.py": (*SPARSE, "unit/certify/test_sparse_bound.py"),
    "solve/through_cvxpy.py": SOLVED,
    "solve/through_qpsolvers.py": SOLVED,
    "solve/uncertified.py": (*SOLVED, "unit/certify/test_rounded_bound.py"),
    "solve/units.py": ("unit/solve/test_units.py", *SOLVERS),
    "step/arrays.py": (*MASSES, *DATA),
    "step/blocks.py": SPARSE,
    "step/cones.py": ("unit/step/test_cones.py", "unit/cli/test_completion.py"),
    "step/contacts.py": ("unit/step/test_artifacts.py", *DATA),
    "step/data.py": DATA,
    "step/extension.py": ("unit/solve/test_native.py", "examples/test_extensions.py"),
    "step/files.py": (
        "unit/step/test_step_files.py",
        "unit/step/test_solution_files.py",
        "errors/test_bad_steps.py",
    ),
    "step/posed.py": (*MASSES, *DATA),
    "step/rounded_wrench.py": (
        "unit/step/test_kept_and_shown.py",
        "unit/simulate/test_wrenches.py",
        "unit/certify/test_enclosure.py",
    ),
    "step/show.py": ("unit/step/test_words.py", *DATA),
    "step/solution.py": (
        "unit/step/test_kept_and_shown.py",
        "unit/certify/test_certificate.py",
        "unit/certify/test_newton.py",
    ),
    "step/solution_files.py": (
        "unit/step/test_kept_and_shown.py",
        "unit/step/test_solution_files.py",
        "unit/step/test_solutions_of_version_1.py",
        *FORGED,
    ),
    "step/sparse_form.py": SPARSE,
    "step/words.py": ("unit/step/test_words.py", *DATA),
    "certify/optimum_rates.py": DIFFERENTIATED,
    "certify/reason.py": DIFFERENTIATED,
    "certify/touching.py": DIFFERENTIATED,
    "certify/zeros.py": ("unit/certify/test_zeros.py", "unit/certify/test_confirm.py"),
    "contact/contact_rates.py": ("unit/contact/test_couples.py", *DIFFERENTIATED),
    "contact/couples.py": ("unit/contact/test_couples.py", *DIFFERENTIATED),
    "contact/depth_ties.py": ("unit/contact/test_depth_ties.py", *DIFFERENTIATED),
    "contact/features.py": ("unit/contact/test_features.py", *DIFFERENTIATED),
    "contact/kinks.py": ("unit/contact/test_kinks.py", *DIFFERENTIATED),
    "contact/point_ties.py": ("unit/contact/test_point_ties.py", *DIFFERENTIATED),
    "contact/spare_pairs.py": ("unit/contact/test_spare_pairs.py", *DIFFERENTIATED),
    "contact/witness_rates.py": ("unit/contact/test_sliding.py", *DIFFERENTIATED),
    "model/mass.py": MASSES,
    "model/mass_rates.py": DIFFERENTIATED,
    "model/motion_rates.py": ("unit/model/test_motion_rates.py", *DIFFERENTIATED),
    "model/tangent.py": (*units("model", "tangent"), *units("simulate", "step_jax", "smoothed")),
    "solve/barrier.py": ("unit/solve/test_barrier.py", "unit/simulate/test_smoothed.py"),
}
"""The files that are mutated, and the tests that are to notice, the quickest first."""

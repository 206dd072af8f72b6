"""The files of the package that are mutated, and the tests of each that are to notice.

Every file of the paper's page, of the judge, of the solvers, of contacts and of the model is here.
"""

from pathlib import Path

FOLDER = Path(__file__).parents[3] / "tests"
FOUND = {path.name: path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("test_*.py")}

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
    "certify/test_exact.py",
    "certify/test_active_set.py",
    "certify/test_rational.py",
    "certify/test_rounding.py",
    "certify/test_certificate.py",
    "certify/test_farkas.py",
    "optional/fast/guess/test_confirm.py",
    "properties/test_exact_against_enumeration.py",
)


def units(*names: str) -> tuple[str, ...]:
    """The tests of units by the names of their files, each of which is there once."""
    return tuple(FOUND[f"test_{name}.py"] for name in names)


SYSTEM = units("system", "system_forces", "system_refusals")
CONTACT = (
    "equations/test_eq02_relative_velocity.py",
    "equations/test_eq03_contact_jacobian.py",
)
FOLLOWED = ("optional/fast/tracker/test_tracker_bound.py", "properties/test_tracker.py")
FORGED = (
    "certify/test_single_faults.py",
    "optional/ellipsoid/test_enclosure.py",
    "properties/test_forgeries.py",
)
ENCLOSED = (
    "optional/ellipsoid/test_checked_pair.py",
    "optional/ellipsoid/test_interior.py",
    "optional/ellipsoid/test_newton.py",
    "optional/ellipsoid/test_enclosure.py",
    "solve/test_native.py",
)
PAIRS = units("patch", "distance", "pairs", "jacobian")
SOLIDS = units("corners", "patch", "polytope_pair", "solid_pair", "distance", "curved_pair")
LARGE = ("optional/large/test_sparse_bound.py", "optional/large/test_bound_formulas.py")
SPARSE = (*units("kept_and_shown", "mass_in_blocks", "sparse"), *units("solver"))
CLOUDS = units("clouds", "cloud_headers", "mesh_files")
SCENES = (
    "scenario/test_scenario.py",
    "simulate/test_simulator.py",
    "optional/show/test_words.py",
)
URDF = (
    *units("urdf", "urdf_refusals", "urdf_file", "mesh_files"),
    "errors/test_bad_urdfs.py",
)
DATA = units("arrays", "kept_and_shown", "data", "plain_data", "step_files")
MASSES = (*SYSTEM, "optional/large/test_mass_in_blocks.py")
SOLVERS = units(
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
    "solve/test_kept_between_steps.py",
    "lab/study/test_plain_programs.py",
    "solve/test_solver.py",
    "solve/test_backends.py",
    "step/test_problem.py",
    "step/test_cones.py",
)
CURVED = units("curved_pair", "settle", "faces", "by_coal", "distance")
DRAWN = "shapes/test_shapes.py"

DIFFERENTIATED = (
    "optional/derivatives/step/test_touching.py",
    "optional/derivatives/step/test_optimum_rates.py",
    "optional/derivatives/test_derivatives.py",
    "optional/derivatives/test_derivative_verdicts.py",
    "optional/derivatives/test_gradient.py",
    "lab/vectors/test_derivative_layer.py",
)


def ordered(own: str) -> tuple[str, ...]:
    """The tests of the exact method, those of one unit first."""
    first = f"certify/test_{own}.py"
    return (first, *(test for test in EXACT if test != first))


TESTS: dict[str, tuple[str, ...]] = {
    "step/problem.py": ("step/test_standard_form.py", *PAGE, "step/test_problem.py"),
    "step/friction.py": (
        "step/test_friction.py",
        *PAGE,
        "step/test_cones.py",
        "optional/large/test_kept_and_shown.py",
        "simulate/test_wrenches.py",
    ),
    "step/cones.py": ("step/test_cones.py", *PAGE, *JUDGE, "cli/test_completion.py"),
    "step/pivots.py": units("pivots"),
    "step/standard_form.py": ("step/test_standard_form.py", *PAGE),
    "certify/optimality.py": (
        "certify/test_optimality.py",
        *JUDGE,
        "optional/ellipsoid/test_enclosure.py",
    ),
    "certify/arithmetic.py": units("environments"),
    "certify/rational.py": ordered("rational"),
    "certify/dependence.py": ordered("dependence"),
    "certify/point.py": ordered("balls"),
    "certify/active_set.py": ordered("active_set"),
    "certify/degeneracy.py": ordered("exact"),
    "certify/rounding.py": ordered("rounding"),
    "certify/exact.py": ordered("exact"),
    "optional/fast/guess/confirm.py": ("optional/fast/guess/test_confirm.py",),
    "optional/large/bound.py": ("optional/large/test_bound.py", *FORGED),
    "optional/large/rounded_bound.py": (
        "optional/large/test_rounded_bound.py",
        "optional/large/test_bound_formulas.py",
    ),
    "optional/fast/guess/exchange.py": ("optional/fast/guess/test_exchange.py",),
    "optional/large/least_eigenvalues.py": LARGE,
    "optional/large/opening.py": LARGE,
    "optional/large/outward.py": ("optional/large/test_sizes.py", *LARGE),
    "optional/large/sizes.py": ("optional/large/test_sizes.py", *LARGE),
    "optional/large/sparse_bound.py": LARGE,
    "certify/gap.py": ("certify/test_gap.py", *FORGED),
    "optional/ellipsoid/impulses.py": ("optional/ellipsoid/test_impulses.py", *FORGED),
    "optional/large/judged.py": ("optional/large/test_judged.py", *FORGED),
    "optional/ellipsoid/cone.py": (
        "optional/ellipsoid/test_apex.py",
        *FORGED,
        "optional/ellipsoid/test_enclosure.py",
        "certify/test_optimality.py",
        "step/test_standard_form.py",
    ),
    "optional/ellipsoid/apex.py": ("optional/ellipsoid/test_apex.py", *FORGED),
    "optional/extensions/conic.py": ("optional/extensions/test_conic.py", *FORGED),
    "certify/verdict.py": ("certify/test_certificate.py", *FORGED),
    "certify/warm.py": ("certify/test_warm.py", *EXACT),
    "optional/derivatives/step/sensitivity.py": (
        "optional/derivatives/step/test_sensitivity.py",
        "optional/derivatives/step/test_parameters.py",
    ),
    "optional/derivatives/step/parameters.py": (
        "optional/derivatives/step/test_sensitivity.py",
        "optional/derivatives/step/test_parameters.py",
    ),
    "certify/rows.py": ("certify/test_certificate.py", "certify/test_farkas.py"),
    "certify/farkas.py": ("certify/test_farkas.py",),
    "certify/certificate.py": ordered("certificate"),
    "certify/norm.py": ("certify/test_digits.py", "certify/test_farkas.py"),
    "certify/digits.py": ("certify/test_digits.py",),
    "model/coordinates.py": ("model/test_system.py",),
    "model/angles.py": ("model/test_angles.py",),
    "step/ordered.py": ("step/test_ordered.py",),
    "model/rotation.py": ("model/test_rotation.py",),
    "model/system.py": MASSES,
    "contact/jacobian.py": ("contact/test_jacobian.py", *CONTACT),
    "contact/cloud.py": ("contact/test_cloud.py",),
    "contact/pairs.py": ("contact/test_pairs.py", "contact/test_jacobian.py"),
    "optional/fast/tracker/tracker.py": FOLLOWED,
    "optional/fast/tracker/tracker_bound.py": FOLLOWED,
    "optional/fast/tracker/ball_tree.py": FOLLOWED,
    "contact/solids/settle.py": CURVED,
    "contact/solids/faces.py": CURVED,
    "contact/solids/by_coal.py": CURVED,
    "optional/ellipsoid/enclosure.py": ENCLOSED,
    "optional/ellipsoid/interior.py": ENCLOSED,
    "optional/ellipsoid/newton.py": ENCLOSED,
    "optional/ellipsoid/scaled_blocks.py": ENCLOSED,
    "contact/distance.py": PAIRS,
    "contact/patch.py": ("analytic/test_flat_on_flat.py", *PAIRS),
    "contact/shape_in_world.py": SOLIDS,
    "contact/solids/polytope.py": SOLIDS,
    "contact/solids/polytope_pair.py": SOLIDS,
    "contact/separations.py": (
        "analytic/test_flat_on_flat.py",
        "optional/derivatives/contact/test_depth_ties.py",
    ),
    "contact/solids/solid_pair.py": ("contact/solids/test_polytope_pair.py", *CURVED),
    "optional/large/sparse_jacobian.py": SPARSE,
    "contact/solids/ways_out.py": ("contact/solids/test_ways_out.py", *SOLIDS),
    "model/body.py": ("model/urdf/test_solid.py", "model/test_planar.py", *SCENES),
    "model/readers/clouds.py": CLOUDS,
    "model/configuration.py": (*units("configuration", "system_refusals"), *SCENES),
    "shapes/convex_mesh.py": (*units("convex_mesh", "mesh_files", "shapes"), *SOLIDS),
    "model/readers/dae.py": ("model/readers/test_mesh_files.py",),
    "shapes/frozen.py": ("shapes/test_shapes.py", "step/test_plain_data.py", *SYSTEM),
    "model/kinematics.py": ("model/test_system.py", *CONTACT),
    "model/readers/mesh_files.py": ("model/readers/test_mesh_files.py",),
    "model/motion.py": ("model/test_system.py", "simulate/test_simulator.py", *CONTACT),
    "model/readers/pcd.py": CLOUDS,
    "model/readers/ply.py": CLOUDS,
    "model/readers/point_table.py": CLOUDS,
    "model/screw.py": units("screw", "rotation", "system"),
    "shapes/placed_shape.py": (*units("shapes", "solid"), "optional/show/test_words.py"),
    "shapes/point_cloud.py": (DRAWN, *CLOUDS),
    "shapes/box.py": (DRAWN, *SOLIDS),
    "shapes/capsule.py": (DRAWN, *SOLIDS),
    "shapes/cone.py": ("contact/test_cloud.py", DRAWN, *CURVED),
    "shapes/cylinder.py": (DRAWN, *CURVED),
    "shapes/ellipsoid.py": ("contact/test_cloud.py", DRAWN, *CURVED),
    "shapes/half_space.py": ("contact/test_cloud.py", DRAWN, *SOLIDS),
    "shapes/hull.py": SOLIDS,
    "shapes/round.py": SOLIDS,
    "shapes/rounded.py": ("contact/test_cloud.py", *SOLIDS),
    "shapes/shape.py": ("shapes/test_a_shape_added.py", DRAWN, *SOLIDS),
    "shapes/sphere.py": (DRAWN, *SOLIDS),
    "model/urdf/solid.py": ("model/urdf/test_solid.py", "step/test_plain_data.py"),
    "model/readers/text.py": URDF,
    "model/urdf/urdf.py": URDF,
    "model/urdf/urdf_file.py": URDF,
    "model/urdf/urdf_inertia.py": URDF,
    "model/urdf/urdf_shapes.py": URDF,
    "model/urdf/urdf_tree.py": URDF,
    "model/urdf/urdf_xml.py": URDF,
    "optional/show/model_words.py": ("optional/show/test_words.py", "step/test_plain_data.py"),
    "model/workspace.py": (*units("world"), *MASSES, "simulate/test_memory.py"),
    "model/world.py": (
        *units("world", "planar", "system"),
        "optional/large/test_sparse.py",
        *SYSTEM[1:],
    ),
    "solve/adapters/clarabel.py": SOLVERS,
    "solve/adapters/daqp.py": SOLVERS,
    "solve/adapters/osqp.py": SOLVERS,
    "solve/adapters/piqp.py": SOLVERS,
    "solve/adapters/program.py": SOLVERS,
    "solve/adapters/quadprog.py": SOLVERS,
    "solve/backends.py": SOLVERS,
    "solve/cvxpy_problem.py": ("step/test_standard_form.py", "step/test_problem.py", *SOLVERS),
    "optional/fast/backends.py": ("solve/test_defaults.py", *SOLVERS),
    "optional/fast/solver.py": (*SOLVED, "solve/test_native.py", "solve/test_defaults.py"),
    "simulate/pace.py": ("simulate/test_pace.py",),
    "optional/extensions/extended.py": SOLVERS,
    "solve/native.py": ("solve/test_native.py", "solve/test_units.py"),
    "solve/scaled.py": SOLVERS,
    "optional/ellipsoid/second_order.py": ("solve/test_native.py", "step/test_cones.py"),
    "solve/solve.py": (*SOLVED, "solve/test_native.py", "optional/large/test_rounded_bound.py"),
    "solve/solver.py": SOLVED,
    "optional/large/sparse.py": (*SPARSE, "optional/large/test_sparse_bound.py"),
    "solve/through_cvxpy.py": SOLVED,
    "solve/through_qpsolvers.py": SOLVED,
    "solve/units.py": ("solve/test_units.py", *SOLVERS),
    "step/arrays.py": (*MASSES, *DATA),
    "optional/large/blocks.py": SPARSE,
    "optional/large/sparse_contacts.py": SPARSE,
    "step/contacts.py": ("optional/doctor/test_artifacts.py", *DATA),
    "step/data.py": DATA,
    "step/extension.py": ("solve/test_native.py", "lab/examples/test_extensions.py"),
    "step/files.py": (
        "step/test_step_files.py",
        "step/test_solution_files.py",
        "errors/test_bad_steps.py",
    ),
    "optional/fast/posed.py": (*MASSES, *DATA),
    "optional/show/show.py": ("optional/show/test_words.py", *DATA),
    "step/solution.py": (
        "optional/large/test_kept_and_shown.py",
        "certify/test_certificate.py",
        "optional/ellipsoid/test_newton.py",
    ),
    "step/solution_files.py": (
        "optional/large/test_kept_and_shown.py",
        "step/test_solution_files.py",
        "step/test_solutions_of_version_1.py",
        *FORGED,
    ),
    "optional/large/sparse_form.py": SPARSE,
    "optional/show/step_words.py": ("optional/show/test_words.py", *DATA),
    "optional/derivatives/step/optimum_rates.py": DIFFERENTIATED,
    "optional/derivatives/step/reason.py": DIFFERENTIATED,
    "optional/derivatives/step/touching.py": DIFFERENTIATED,
    "optional/fast/guess/zeros.py": (
        "optional/fast/guess/test_zeros.py",
        "optional/fast/guess/test_confirm.py",
    ),
    "optional/derivatives/contact/contact_rates.py": (
        "optional/derivatives/contact/test_couples.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/couples.py": (
        "optional/derivatives/contact/test_couples.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/depth_ties.py": (
        "optional/derivatives/contact/test_depth_ties.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/features.py": (
        "optional/derivatives/contact/test_features.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/kinks.py": (
        "optional/derivatives/contact/test_kinks.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/point_ties.py": (
        "optional/derivatives/contact/test_point_ties.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/spare_pairs.py": (
        "optional/derivatives/contact/test_spare_pairs.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/contact/witness_rates.py": (
        "optional/derivatives/contact/test_witness_rates.py",
        *DIFFERENTIATED,
    ),
    "model/mass.py": MASSES,
    "optional/derivatives/model/mass_rates.py": DIFFERENTIATED,
    "optional/derivatives/model/motion_rates.py": (
        "optional/derivatives/model/test_motion_rates.py",
        *DIFFERENTIATED,
    ),
    "optional/derivatives/model/tangent.py": (
        *units("tangent"),
        *units("step_jax", "smoothed"),
    ),
    "optional/derivatives/step/barrier.py": (
        "optional/derivatives/step/test_barrier.py",
        "optional/derivatives/test_smoothed.py",
    ),
}
"""The files that are mutated, and the tests that are to notice, the quickest first."""

"""The files of the package that are mutated, and the tests of each that are to notice.

Every file of the paper's page, of the judge, of the solvers, of contacts and of the model is here.
"""

from collections.abc import Iterator
from pathlib import Path

FOLDER = Path(__file__).parents[3] / "tests"
FILES = [path.relative_to(FOLDER) for path in FOLDER.rglob("test_*.py")]
SETS = {
    "PAGE": (
        "eq01_impedance eq04_contact_rows eq05_tangential_directions "
        "eq06_opposite_tangents eq07_torsional_directions eq08_stacked_rows "
        "eq13_step_problem"
    ),
    "JUDGE": (
        "eq09_force_balance eq10_primal_feasibility eq11_dual_feasibility eq12_complementarity"
    ),
    "EXACT": ("exact active_set rational rounding certificate farkas exact_against_enumeration"),
    "FORGED": "single_faults enclosure forgeries",
    "SOLVERS": "adapters second_order extended kept_between_steps native backends solver units",
    "SOLVED": "kept_between_steps compiled_problems solver backends problem cones",
    "ENCLOSED": "checked_pair interior newton enclosure native",
    "DIFFERENTIATED": (
        "touching optimum_rates optimum_against_differences derivatives derivative_verdicts "
        "gradient derivative_layer"
    ),
    "SOLIDS": "corners tied_faces polytope_pair solid_pair contact/distance curved_pair",
    "CURVED": "curved_pair settle faces by_coal contact/distance",
    "PAIRS": "cloud tied_faces contact/distance pairs jacobian",
    "SPARSE": "mass_in_blocks sparse solver fast",
    "CLOUDS": "clouds mesh_files",
    "URDF": "urdf urdf_refusals urdf_file mesh_files",
    "DATA": "arrays posed_data data plain_data step_files",
    "SYSTEM": "system system_forces system_refusals random_mechanisms",
    "SCENES": "scenario simulator words",
    "LARGE": "bound_formulas float_bound",
    "CONTACT": "eq02_relative_velocity eq03_contact_jacobian",
}
TABLE = """
step/problem.py
    standard_form PAGE problem
step/friction.py
    PAGE cones wrenches
step/cones.py
    PAGE JUDGE completion standard_form problem
step/groups.py
    own
certify/farkas.py
model/angles.py step/ordered.py model/rotation.py
model/readers/mesh_files.py optional/fast/pace.py
    own
step/standard_form.py
    PAGE
certify/residuals.py
    JUDGE enclosure
optional/forces/forces.py optional/forces/faces.py
optional/forces/eliminated.py optional/forces/face_guess.py
optional/forces/of_group.py
optional/ellipsoid/forces.py
    forces guessed_faces ellipsoid/enclosure
certify/arithmetic.py
    environments
certify/rational.py certify/dependence.py certify/active_set.py certify/degeneracy.py
certify/rounding.py certify/exact.py certify/warm.py
    EXACT
certify/certificate.py
    EXACT FORGED
cli/decimals.py
    rounding cli/solve
certify/minimiser.py
    EXACT
optional/large/bound.py certify/gap.py optional/ellipsoid/impulses.py optional/large/judged.py
optional/ellipsoid/apex.py optional/extensions/conic.py
    FORGED
optional/large/least_eigenvalues.py optional/large/opening.py optional/large/sizes.py
optional/large/float_bound.py
    LARGE sizes
optional/large/outward.py
    sizes LARGE
optional/ellipsoid/cone.py
    apex FORGED residuals standard_form
certify/verdict.py
    certificate FORGED
certify/rows.py
    certificate farkas
certify/norm.py
    norm farkas pivots
model/coordinates.py
    system
model/system.py model/mass.py
    named SYSTEM mass_in_blocks fast
contact/jacobian.py
    CONTACT
contact/pairs.py
    jacobian
optional/curved/settle.py optional/curved/faces.py optional/curved/by_coal.py
    CURVED depth_ties
optional/ellipsoid/enclosure.py optional/ellipsoid/interior.py optional/ellipsoid/newton.py
optional/ellipsoid/scaled_blocks.py
    ENCLOSED
contact/distance.py
    PAIRS flat_on_flat point_ties
contact/tied_faces.py
    flat_on_flat PAIRS
contact/crossings.py
    contact/distance crossings
optional/curved/rims.py
    crossings
contact/shape_in_world.py contact/solids/polytope.py contact/solids/polytope_pair.py
optional/curved/ways_out.py shapes/hull.py shapes/revolved.py
    SOLIDS
contact/separations.py
    flat_on_flat depth_ties
contact/solids/solid_pair.py
    separations polytope_pair CURVED
optional/large/block_columns.py optional/large/blocks.py optional/large/sparse_contacts.py
optional/large/sparse_form.py
    SPARSE
model/body.py
    solid system system_refusals SCENES
model/readers/clouds.py optional/readers/pcd.py optional/readers/ply.py
optional/readers/point_table.py optional/readers/points.py
    CLOUDS
model/configuration.py
    system_refusals SCENES
shapes/convex_mesh.py
    mesh_files shapes SOLIDS
optional/readers/dae.py
    mesh_files
shapes/frozen.py
    shapes plain_data SYSTEM
model/named.py
    named
model/kinematics.py
    system random_mechanisms CONTACT
model/column_map.py
    system simulator CONTACT
model/screw.py model/joints/joint.py model/joints/axis_joint.py model/joints/continuous.py
model/joints/floating.py model/joints/planar.py model/joints/ball.py model/joints/twist_joint.py
    screw tangent ball rotation system
shapes/placed_shape.py
    shapes solid words
shapes/point_cloud.py
    corners shapes CLOUDS
shapes/box.py shapes/capsule.py shapes/sphere.py
    shapes SOLIDS
shapes/cone.py shapes/ellipsoid.py
    cloud corners shapes CURVED solid_pair
shapes/cylinder.py
    cloud corners shapes CURVED
shapes/half_space.py
    cloud shapes SOLIDS
shapes/rounded.py
    cloud SOLIDS
shapes/shape.py
    a_shape_added shapes SOLIDS
model/urdf/solid.py
    plain_data
model/readers/text.py
    clouds URDF
model/urdf/urdf_file.py model/urdf/urdf_inertia.py model/urdf/urdf_tree.py model/urdf/urdf_xml.py
    URDF
model/urdf/urdf.py
    URDF ball system
model/urdf/urdf_shapes.py
    URDF python_mistakes
optional/show/model_words.py
    words plain_data
model/workspace.py
    world SYSTEM mass_in_blocks memory fast
model/world.py
    SYSTEM sparse fast
optional/fast/adapters/clarabel.py optional/fast/adapters/daqp.py optional/fast/adapters/osqp.py
optional/fast/adapters/piqp.py optional/fast/adapters/program.py optional/fast/adapters/quadprog.py
optional/extensions/extended.py solve/units.py
    SOLVERS pivots
solve/backends.py
    parts SOLVERS
solve/cvxpy_problem.py
    standard_form problem SOLVERS
optional/fast/backends.py
    defaults SOLVERS
optional/fast/solver.py
    SOLVED native defaults float_bound
optional/fast/native.py
    units
optional/fast/second_order.py
    native cones
solve/solve.py
    SOLVED native float_bound enclosure
solve/solver.py solve/prover.py solve/through_cvxpy.py optional/qpsolvers/through_qpsolvers.py
    SOLVED
optional/large/sparse.py optional/fast/sparse_solver.py
    SPARSE sizes float_bound
step/arrays.py optional/fast/posed.py
    posed_data SYSTEM mass_in_blocks DATA fast
step/pivots.py
    pivots SYSTEM mass_in_blocks DATA
step/contacts.py
    step/groups artifacts DATA fixed_point
step/data.py
    DATA step/groups
step/extension.py
    native extensions rises
step/files.py
    step_files solution_files bad_steps
optional/show/show.py optional/show/step_words.py
    words DATA
certify/solution.py
    certificate newton forces/forces
cli/solution_files.py
    step/friction certify/solution solution_files solutions_of_version_1 FORGED
optional/derivatives/step/optimum_rates.py optional/derivatives/step/reason.py
optional/derivatives/step/touching.py optional/derivatives/contact/couples.py
optional/derivatives/contact/depth_ties.py optional/derivatives/contact/features.py
optional/derivatives/contact/kinks.py optional/derivatives/contact/point_ties.py
optional/derivatives/contact/spare_pairs.py optional/derivatives/contact/closest_point_rates.py
optional/derivatives/model/mass_rates.py optional/derivatives/model/motion_rates.py
    DIFFERENTIATED
optional/derivatives/contact/contact_rates.py
    couples DIFFERENTIATED
optional/derivatives/model/tangent.py
    step_jax smoothed
optional/derivatives/step/barrier.py
    smoothed
"""
"""Files, and below them their tests, the quickest first. The test of a file's own name comes first
where it is not named, and alone where there is only ``own``."""


def file_of_test(name: str) -> Path:
    """The test ``test_NAME.py``, by its folder, too, where there are two."""
    folder, _, stem = name.rpartition("/")
    own = [path for path in FILES if path.name == f"test_{stem}.py"]
    (found,) = [path for path in own if folder in ("", path.parent.name)]
    return found


def tests_of(file: str, words: list[str]) -> tuple[str, ...]:
    """The tests of a file in their order."""
    names = [name for word in words if word != "own" for name in SETS.get(word, word).split()]
    tests = [file_of_test(name) for name in names]
    own = Path(file).with_name(f"test_{Path(file).name}")
    if own in FILES and own.stem.removeprefix("test_") not in words:
        tests.insert(0, own)
    return tuple(dict.fromkeys(path.as_posix() for path in tests))


def rows() -> Iterator[tuple[list[str], list[str]]]:
    """Files and tests of each entry of the table."""
    files = []
    tests = []
    for line in TABLE.strip().splitlines():
        if not line.startswith(" ") and tests:
            yield files, tests
            files = []
            tests = []
        (tests if line.startswith(" ") else files).extend(line.split())
    yield files, tests


TESTS = {file: tests_of(file, tests) for files, tests in rows() for file in files}
"""The files that are mutated, and the tests that are to notice."""

"""Each part is what the core expects of it: mypy reads this file, and each row is loaded."""

from collections.abc import Callable

import pytest

from quasistatic_ref import Simulator
from quasistatic_ref.certify.refined import BearingRows
from quasistatic_ref.contact.crossings import CurveCrossings
from quasistatic_ref.contact.normals import KnownGaps
from quasistatic_ref.contact.solids.solid_pair import WitnessOfPair
from quasistatic_ref.files.clouds import FilePoints
from quasistatic_ref.files.mesh_files import FileMesh
from quasistatic_ref.files.scenario import scenario
from quasistatic_ref.files.urdf import file
from quasistatic_ref.model.body import Described
from quasistatic_ref.model.world import ReadUrdf
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.compiled import CompiledFunction, IsCompiled
from quasistatic_ref.optional.compiled import leaves
from quasistatic_ref.optional.coulomb import fixed_point
from quasistatic_ref.optional.curved import by_coal, clouds_by_coal, rims, ways_out
from quasistatic_ref.optional.daqp import bearing_rows, default, solver
from quasistatic_ref.optional.doctor import checks, observer, texts
from quasistatic_ref.optional.ellipsoid.cone import ELLIPSOID_CONE
from quasistatic_ref.optional.extensions import by_function, extended, of_scenario
from quasistatic_ref.optional.forces import forces
from quasistatic_ref.optional.mesh_formats import meshes, points
from quasistatic_ref.optional.pinocchio_models import described
from quasistatic_ref.optional.qpsolvers import through_qpsolvers
from quasistatic_ref.optional.show import pages, table
from quasistatic_ref.optional.stands import after, slow, stands
from quasistatic_ref.parts import PARTS, is_there, part
from quasistatic_ref.simulate.distances import ChangedPairs
from quasistatic_ref.simulate.record.trajectory import StandsAfter, Table
from quasistatic_ref.simulate.recorder import WatchingDoctor
from quasistatic_ref.simulate.simulator import SceneFindings, StandingsOf
from quasistatic_ref.simulate.step_solver import CoulombSolution, ExtendedSolution
from quasistatic_ref.solve.backends import SolverNames
from quasistatic_ref.solve.choice import FunctionSolver, NamedSolver
from quasistatic_ref.solve.many import ColdAnswers
from quasistatic_ref.solve.solve import ExtendedStep
from quasistatic_ref.step.cones import FrictionCone
from quasistatic_ref.step.extension import Posed
from quasistatic_ref.step.solution import ForcesOfStep
from quasistatic_ref.text.shown import Page


class Expected:
    """By each word what it names, as the core may use it."""

    urdf_tree: ReadUrdf = file.urdf_tree
    described_model: Described = described.described_model
    file_mesh: FileMesh = meshes.file_mesh
    file_points: FilePoints = points.file_points
    extended_bodies: scenario.ExtendedBodies = of_scenario.of_scenario
    coal_witness: WitnessOfPair = by_coal.coal_witness
    curve_crossings: CurveCrossings = rims.curve_crossings
    known_gaps: KnownGaps = ways_out.known_gaps
    is_compiled: IsCompiled = leaves.is_compiled
    compiled_function: CompiledFunction = leaves.compiled_function
    pairs_by_coal: ChangedPairs = clouds_by_coal.pairs_by_coal
    ellipsoid: FrictionCone = ELLIPSOID_CONE
    coulomb: CoulombSolution = fixed_point.simulated_solution
    coulomb_from: Callable[..., fixed_point.CoulombSolution] = fixed_point.fixed_point_from
    posed: Posed = extended.posed
    extended_step: ExtendedStep = extended.extended_step
    extended_solution: ExtendedSolution = extended.simulated_solution
    contact_forces: ForcesOfStep = forces.contact_forces
    function_solver: FunctionSolver = by_function.FunctionSolver
    qpsolvers_solver: NamedSolver = through_qpsolvers.QpsolversSolver
    qpsolvers_names: SolverNames = through_qpsolvers.available_solvers
    daqp_solver: NamedSolver = solver.DaqpSolver
    cold_answers: ColdAnswers = solver.cold_answers
    bearing_rows: BearingRows = bearing_rows.bearing_rows
    fast_backend: scenario.FastBackend = default.default_backend
    slow_step: Callable[..., slow.Slow] = slow.slow_step
    kept_loads: Callable[[Simulator, Array, Array, Array], Array] = after.kept
    stands: StandingsOf = stands.stands
    stands_after: StandsAfter = after.stands_after
    doctor: WatchingDoctor = observer.Doctor
    scene_findings: SceneFindings = checks.scene_findings
    finding_names: frozenset[str] = texts.NAMES
    page_text: Page = pages.text
    page_html: Page = pages.html
    step_table: Table = table.data_frame
    contact_table: Table = table.contact_frame


@pytest.mark.parametrize("word", PARTS)
def test_a_word_names_what_the_core_expects(word: str) -> None:
    assert part(word) is vars(Expected)[word]


def test_the_core_states_what_it_expects_of_each_word() -> None:
    assert Expected.__annotations__.keys() == PARTS.keys()
    assert all(map(is_there, PARTS))

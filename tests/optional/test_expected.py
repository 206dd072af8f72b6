"""Each part is what the core expects of it: mypy reads this file, and each row is loaded."""

from collections.abc import Callable
from typing import Any

import pytest

from quasistatic_ref import Simulator
from quasistatic_ref.contact import crossings, normals
from quasistatic_ref.contact.solids.solid_pair import WitnessOfPair
from quasistatic_ref.exact.refined import BearingRows
from quasistatic_ref.files import clouds, mesh_files
from quasistatic_ref.files.scenario import scenario
from quasistatic_ref.files.urdf import file
from quasistatic_ref.model import body, world
from quasistatic_ref.numbers import arrays, compiled
from quasistatic_ref.optional.compiled import leaves
from quasistatic_ref.optional.coulomb import fixed_point
from quasistatic_ref.optional.curved import by_coal, measured_by_coal, rims, ways_out
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
from quasistatic_ref.shown import Page
from quasistatic_ref.simulate import distance_source, recorder, simulator, step_solver
from quasistatic_ref.simulate.record import trajectory
from quasistatic_ref.solve import backends, choice, many, solve
from quasistatic_ref.step import cones, extension, solution


class Expected:
    """By each word what it names, as the core may use it."""

    urdf_tree: world.ReadUrdf = file.urdf_tree
    described_model: body.Described = described.described_model
    file_mesh: mesh_files.FileMesh = meshes.file_mesh
    file_points: clouds.FilePoints = points.file_points
    extended_bodies: scenario.ExtendedBodies = of_scenario.of_scenario
    coal_witness: WitnessOfPair = by_coal.coal_witness
    curve_crossings: crossings.CurveCrossings = rims.curve_crossings
    known_gaps: normals.KnownGaps = ways_out.known_gaps
    is_compiled: compiled.IsCompiled = leaves.is_compiled
    compiled_function: compiled.CompiledFunction = leaves.compiled_function
    pairs_by_coal: distance_source.ChangedPairs = measured_by_coal.pairs_by_coal
    ellipsoid: cones.FrictionCone = ELLIPSOID_CONE
    coulomb: step_solver.CoulombSolution = fixed_point.simulated_solution
    coulomb_from: Callable[..., fixed_point.CoulombSolution] = fixed_point.fixed_point_from
    posed: extension.Posed = extended.posed
    extended_solution: solve.ExtendedSolution = extended.extended_solution
    simulated_solution: step_solver.SimulatedSolution = extended.simulated_solution
    contact_forces: solution.ForcesOfStep = forces.contact_forces
    function_solver: choice.FunctionSolver = by_function.FunctionSolver
    function_at: Callable[[str], Callable[..., Any]] = by_function.function_at
    qpsolvers_solver: choice.NamedSolver = through_qpsolvers.QpsolversSolver
    qpsolvers_names: backends.SolverNames = through_qpsolvers.available_solvers
    daqp_solver: choice.NamedSolver = solver.DaqpSolver
    cold_replies: many.ColdReplies = solver.cold_replies
    bearing_rows: BearingRows = bearing_rows.bearing_rows
    fast_backend: scenario.FastBackend = default.default_backend
    slow_step: Callable[..., slow.Slow] = slow.slow_step
    kept_loads: Callable[[Simulator, arrays.Array, arrays.Array, arrays.Array], arrays.Array] = (
        after.kept
    )
    stands: simulator.StandingsOf = stands.stands
    stands_after: trajectory.StandsAfter = after.stands_after
    doctor: recorder.WatchingDoctor = observer.Doctor
    scene_findings: simulator.SceneFindings = checks.scene_findings
    finding_names: frozenset[str] = texts.NAMES
    page_text: Page = pages.text
    page_html: Page = pages.html
    step_table: trajectory.Table = table.data_frame
    contact_table: trajectory.Table = table.contact_frame


@pytest.mark.parametrize("word", PARTS)
def test_a_word_names_what_the_core_expects(word: str) -> None:
    assert part(word) is vars(Expected)[word]


def test_the_core_states_what_it_expects_of_each_word() -> None:
    assert Expected.__annotations__.keys() == PARTS.keys()
    assert all(map(is_there, PARTS))

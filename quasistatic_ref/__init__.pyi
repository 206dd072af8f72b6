"""The names of the package as type checkers see them; `__init__.py` reads them, too."""

from quasistatic_ref import figures as figures

__version__: str

# A scene.
from quasistatic_ref.model.system import System as System
from quasistatic_ref.model.body import Body as Body
from quasistatic_ref.shapes.placed_shape import (
    Sphere as Sphere,
    Box as Box,
    Cylinder as Cylinder,
    Capsule as Capsule,
    Cone as Cone,
    Ellipsoid as Ellipsoid,
    HalfSpace as HalfSpace,
    PointCloud as PointCloud,
    PlacedShape as PlacedShape,
)
from quasistatic_ref.shapes.convex_mesh import convex_hull as convex_hull
from quasistatic_ref.contact.pairs import ContactPair as ContactPair

# Steps in sequence.
from quasistatic_ref.simulate.result import StepResult as StepResult
from quasistatic_ref.simulate.limits import Limits as Limits
from quasistatic_ref.simulate.simulator import Simulator as Simulator
from quasistatic_ref.optional.fast.simulator import FastSimulator as FastSimulator
from quasistatic_ref.optional.derivatives.derivatives import derivatives as derivatives
from quasistatic_ref.optional.derivatives.smoothed import smoothed as smoothed
from quasistatic_ref.optional.derivatives.step_jax import (
    step_jax as step_jax,
    smoothed_jax as smoothed_jax,
)
from quasistatic_ref.simulate.rollout import rollout as rollout
from quasistatic_ref.simulate.recorder import Recorder as Recorder
from quasistatic_ref.simulate.observer import Observer as Observer
from quasistatic_ref.simulate.finding import Finding as Finding
from quasistatic_ref.simulate.trajectory import (
    Trajectory as Trajectory,
    load_trajectory as load_trajectory,
    save_trajectory as save_trajectory,
)
from quasistatic_ref.scenario.scenario import Scenario as Scenario, load_scenario as load_scenario
from quasistatic_ref.optional.scans.body import scanned_body as scanned_body

# One step and its answer.
from quasistatic_ref.step.data import StepData as StepData, Contacts as Contacts, Extra as Extra
from quasistatic_ref.step.files import load_step as load_step, save_step as save_step
from quasistatic_ref.solve.step_problem import StepProblem as StepProblem
from quasistatic_ref.step.standard_form import standard_form as standard_form
from quasistatic_ref.optional.extensions.extension import Extension as Extension, Symbols as Symbols
from quasistatic_ref.certify.solution import (
    StepSolution as StepSolution,
    SolverStatistics as SolverStatistics,
)
from quasistatic_ref.certify.solution_files import (
    SolutionFile as SolutionFile,
    load_solution as load_solution,
    save_solution as save_solution,
)
from quasistatic_ref.solve.solve import solve_step as solve_step
from quasistatic_ref.optional.guests.mujoco import mujoco_step as mujoco_step
from quasistatic_ref.optional.guests.mujoco_opinion import mujoco_opinion as mujoco_opinion
from quasistatic_ref.optional.guests.scene import mujoco_scenario as mujoco_scenario
from quasistatic_ref.optional.coulomb.fixed_point import (
    coulomb_step as coulomb_step,
    CoulombSolution as CoulombSolution,
    NoFixedPoint as NoFixedPoint,
)
from quasistatic_ref.certify.certificate import Certificate as Certificate
from quasistatic_ref.certify.residuals import (
    Residuals as Residuals,
    optimality_residuals as optimality_residuals,
)
from quasistatic_ref.certify.verification import verify as verify, verify_answer as verify_answer
from quasistatic_ref.certify.verdict import Verdict as Verdict
from quasistatic_ref.certify.contact_forces import ContactForces as ContactForces
from quasistatic_ref.optional.forces.forces import contact_forces as contact_forces

# A run in pictures and numbers.
from quasistatic_ref.optional.show.figures.animation import animate as animate
from quasistatic_ref.optional.show.figures.draw import (
    draw_scene as draw_scene,
    draw_scenes as draw_scenes,
)
from quasistatic_ref.optional.show.figures.viewer import save_view as save_view
from quasistatic_ref.optional.doctor.motions import relative_turn as relative_turn

# What can go wrong.
from quasistatic_ref.errors import (
    QuasistaticError as QuasistaticError,
    InputError as InputError,
    MissingKey as MissingKey,
    StepDataError as StepDataError,
    ModelError as ModelError,
    ContactError as ContactError,
    ScenarioError as ScenarioError,
    BackendError as BackendError,
)
from quasistatic_ref.optional.derivatives.step.reason import NotDifferentiable as NotDifferentiable
from quasistatic_ref.certify.failures import (
    StepNotSolved as StepNotSolved,
    StepInfeasible as StepInfeasible,
    StepIllPosed as StepIllPosed,
)
from quasistatic_ref.simulate.failures import LimitExceeded as LimitExceeded, RunFailed as RunFailed

"""Reference implementation of convex quasi-dynamic simulation with torsional friction.

The model is that of Tracy & Manchester, "Convex Quasi-Dynamic Simulation of Rigid Point
Clouds with Torsional Friction"; equation numbers everywhere in this package are the paper's.
docs/contributing.md, "Read the code", names the files of a step in the order of its calls.

The names below are loaded on first use, so that ``import quasistatic_ref as qr`` is cheap and
``step``, ``certify`` and ``solve`` work where pinocchio and coal are not installed. None of them
is the name of a sub-package, which Python would put in its place once that is imported, but
``figures``, which is that module.
"""

from importlib import import_module
from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOMES = {
    # A scene.
    "model.system": "System",
    "model.body": "Body",
    "model.state": "State",
    "model.kinematics": "Kinematics",
    "model.joints.joint": "Joint",
    "shapes.placed_shape": "Sphere Box Cylinder Capsule Cone Ellipsoid HalfSpace PointCloud "
    "PlacedShape",
    "shapes.convex_mesh": "convex_hull",
    "contact.pairs": "ContactPair",
    "contact.closest_points": "ClosestPoints",
    "simulate.target": "Targets",
    # Steps in sequence.
    "simulate.result": "StepResult StepArrays",
    "simulate.limits": "Limits",
    "simulate.simulator": "Simulator",
    "simulate.steps": "Steps",
    "optional.derivatives.derivatives": "derivatives",
    "optional.derivatives.step_jax": "step_jax",
    "simulate.rollout": "rollout",
    "simulate.recorder": "Recorder",
    "simulate.observer": "Observer Recording",
    "simulate.standing": "Standings",
    "simulate.finding": "Finding",
    "simulate.record.trajectory": "Trajectory",
    "simulate.record.header": "Header",
    "files.trajectory": "load_trajectory save_trajectory",
    "files.scenario.scenario": "Scenario load_scenario",
    "optional.scans.body": "scanned_body",
    # One step and its answer.
    "step.data": "StepData Contacts Extra",
    "files.step": "load_step save_step",
    "solve.step_problem": "StepProblem",
    "step.standard_form": "StandardForm standard_form",
    "optional.extensions.extension": "Extension Symbols",
    "step.solution": "Certificate ContactForces SolverStatistics StepSolution",
    "files.solution": "SolutionFile load_solution save_solution",
    "solve.solve": "solve_step",
    "optional.mujoco.mujoco": "mujoco_step",
    "optional.mujoco.mujoco_opinion": "mujoco_opinion",
    "optional.mujoco.scene": "mujoco_scenario",
    "optional.coulomb.fixed_point": "coulomb_step CoulombSolution NoFixedPoint",
    "certify.verification": "verify verify_answer",
    "certify.farkas": "FarkasVector",
    "exact.verdict": "Verdict",
    "certify.residuals": "Residuals optimality_residuals",
    "optional.forces.forces": "contact_forces",
    # Any quadratic program.
    "exact.qp.exact": "exact_lp exact_ls exact_qp",
    "exact.qp.answer": "ExactQP QPInfeasible QPNotConvex QPUnbounded",
    "exact.qp.program": "QuadraticProgram",
    "exact.time_limit": "TimeIsUp",
    "exact.qp.files": "load_answer",
    "optional.qp_files.load": "load_qp",
    "optional.qp_doors.by_cvxpy": "Exact",
    "optional.qp_doors.by_qpsolvers": "register_qpsolvers",
    # A run in pictures and numbers.
    "optional.show.figures.animation": "animate",
    "optional.show.figures.draw": "draw_scene draw_scenes",
    "optional.show.figures.viewer": "save_view",
    "simulate.record.motions": "relative_turn",
    # What can go wrong.
    "errors": "QuasistaticError InputError MissingKey StepDataError ModelError ContactError "
    "ScenarioError BackendError",
    "optional.derivatives.reason": "NotDifferentiable",
    "certify.failures": "StepNotSolved StepInfeasible StepIllPosed",
    "simulate.record.failures": "LimitExceeded RunFailed",
}
_HOME = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = ["__version__", "figures", *sorted(_HOME)]


if TYPE_CHECKING:  # what editors and type checkers see: the same names, with their types
    from quasistatic_ref import figures as figures
    from quasistatic_ref.certify.failures import (
        StepIllPosed as StepIllPosed,
        StepInfeasible as StepInfeasible,
        StepNotSolved as StepNotSolved,
    )
    from quasistatic_ref.step.solution import (
        Certificate as Certificate,
        ContactForces as ContactForces,
        SolverStatistics as SolverStatistics,
        StepSolution as StepSolution,
    )
    from quasistatic_ref.certify.farkas import FarkasVector as FarkasVector
    from quasistatic_ref.certify.residuals import (
        Residuals as Residuals,
        optimality_residuals as optimality_residuals,
    )
    from quasistatic_ref.exact.verdict import Verdict as Verdict
    from quasistatic_ref.certify.verification import (
        verify as verify,
        verify_answer as verify_answer,
    )
    from quasistatic_ref.files.solution import (
        SolutionFile as SolutionFile,
        load_solution as load_solution,
        save_solution as save_solution,
    )
    from quasistatic_ref.contact.closest_points import ClosestPoints as ClosestPoints
    from quasistatic_ref.contact.pairs import ContactPair as ContactPair
    from quasistatic_ref.errors import (
        BackendError as BackendError,
        ContactError as ContactError,
        InputError as InputError,
        MissingKey as MissingKey,
        ModelError as ModelError,
        QuasistaticError as QuasistaticError,
        ScenarioError as ScenarioError,
        StepDataError as StepDataError,
    )
    from quasistatic_ref.model.body import Body as Body
    from quasistatic_ref.model.joints.joint import Joint as Joint
    from quasistatic_ref.model.kinematics import Kinematics as Kinematics
    from quasistatic_ref.model.state import State as State
    from quasistatic_ref.model.system import System as System
    from quasistatic_ref.optional.coulomb.fixed_point import (
        CoulombSolution as CoulombSolution,
        NoFixedPoint as NoFixedPoint,
        coulomb_step as coulomb_step,
    )
    from quasistatic_ref.optional.derivatives.derivatives import derivatives as derivatives
    from quasistatic_ref.optional.derivatives.reason import (
        NotDifferentiable as NotDifferentiable,
    )
    from quasistatic_ref.optional.derivatives.step_jax import (
        step_jax as step_jax,
    )
    from quasistatic_ref.optional.extensions.extension import (
        Extension as Extension,
        Symbols as Symbols,
    )
    from quasistatic_ref.optional.forces.forces import contact_forces as contact_forces
    from quasistatic_ref.optional.mujoco.mujoco import mujoco_step as mujoco_step
    from quasistatic_ref.optional.mujoco.mujoco_opinion import mujoco_opinion as mujoco_opinion
    from quasistatic_ref.optional.mujoco.scene import mujoco_scenario as mujoco_scenario
    from quasistatic_ref.exact.qp.answer import (
        ExactQP as ExactQP,
        QPInfeasible as QPInfeasible,
        QPNotConvex as QPNotConvex,
        QPUnbounded as QPUnbounded,
    )
    from quasistatic_ref.exact.qp.exact import (
        exact_lp as exact_lp,
        exact_ls as exact_ls,
        exact_qp as exact_qp,
    )
    from quasistatic_ref.exact.qp.files import load_answer as load_answer
    from quasistatic_ref.exact.qp.program import QuadraticProgram as QuadraticProgram
    from quasistatic_ref.exact.time_limit import TimeIsUp as TimeIsUp
    from quasistatic_ref.optional.qp_doors.by_cvxpy import Exact as Exact
    from quasistatic_ref.optional.qp_doors.by_qpsolvers import (
        register_qpsolvers as register_qpsolvers,
    )
    from quasistatic_ref.optional.qp_files.load import load_qp as load_qp
    from quasistatic_ref.optional.scans.body import scanned_body as scanned_body
    from quasistatic_ref.optional.show.figures.animation import animate as animate
    from quasistatic_ref.optional.show.figures.draw import (
        draw_scene as draw_scene,
        draw_scenes as draw_scenes,
    )
    from quasistatic_ref.optional.show.figures.viewer import save_view as save_view
    from quasistatic_ref.files.scenario.scenario import (
        Scenario as Scenario,
        load_scenario as load_scenario,
    )
    from quasistatic_ref.shapes.convex_mesh import convex_hull as convex_hull
    from quasistatic_ref.shapes.placed_shape import (
        Box as Box,
        Capsule as Capsule,
        Cone as Cone,
        Cylinder as Cylinder,
        Ellipsoid as Ellipsoid,
        HalfSpace as HalfSpace,
        PlacedShape as PlacedShape,
        PointCloud as PointCloud,
        Sphere as Sphere,
    )
    from quasistatic_ref.simulate.record.failures import (
        LimitExceeded as LimitExceeded,
        RunFailed as RunFailed,
    )
    from quasistatic_ref.simulate.finding import Finding as Finding
    from quasistatic_ref.simulate.limits import Limits as Limits
    from quasistatic_ref.simulate.record.motions import relative_turn as relative_turn
    from quasistatic_ref.simulate.observer import Observer as Observer, Recording as Recording
    from quasistatic_ref.simulate.recorder import Recorder as Recorder
    from quasistatic_ref.simulate.record.header import Header as Header
    from quasistatic_ref.simulate.result import StepArrays as StepArrays, StepResult as StepResult
    from quasistatic_ref.simulate.rollout import rollout as rollout
    from quasistatic_ref.simulate.simulator import Simulator as Simulator
    from quasistatic_ref.simulate.standing import Standings as Standings
    from quasistatic_ref.simulate.steps import Steps as Steps
    from quasistatic_ref.simulate.target import Targets as Targets
    from quasistatic_ref.simulate.record.trajectory import Trajectory as Trajectory
    from quasistatic_ref.files.trajectory import (
        load_trajectory as load_trajectory,
        save_trajectory as save_trajectory,
    )
    from quasistatic_ref.solve.solve import solve_step as solve_step
    from quasistatic_ref.solve.step_problem import StepProblem as StepProblem
    from quasistatic_ref.step.data import Contacts as Contacts, Extra as Extra, StepData as StepData
    from quasistatic_ref.files.step import load_step as load_step, save_step as save_step
    from quasistatic_ref.step.standard_form import (
        StandardForm as StandardForm,
        standard_form as standard_form,
    )
else:

    def __getattr__(name: str) -> object:
        if name == "figures":
            return import_module(f"{__name__}.figures")
        if name not in _HOME:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        home = _HOME[name]
        if home.startswith("optional."):
            with import_module(f"{__name__}.parts").needing(name):
                return getattr(import_module(f"{__name__}.{home}"), name)
        return getattr(import_module(f"{__name__}.{home}"), name)


def __dir__() -> list[str]:
    return __all__

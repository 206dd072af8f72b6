"""Reference implementation of convex quasi-dynamic simulation with torsional friction.

The model is that of Tracy & Manchester, "Convex Quasi-Dynamic Simulation of Rigid Point
Clouds with Torsional Friction"; equation numbers everywhere in this package are the paper's.
docs/contributing.md, "Read the code", names the files of a step in the order of its calls.

The names below are loaded on first use, so that ``import quasistatic_ref as qr`` is cheap and
``step``, ``certify`` and ``solve`` work where pinocchio and coal are not installed. None of them
is the name of a sub-package, which Python would put in its place once that is imported.
"""

from importlib import import_module

__version__ = "0.1.0"

_HOMES = {
    # A scene.
    "model.system": "System",
    "model.body": "Body",
    "shapes.placed_shape": "Sphere Box Cylinder Capsule Cone Ellipsoid HalfSpace PointCloud "
    "PlacedShape",
    "shapes.convex_mesh": "convex_hull",
    "contact.pairs": "ContactPair",
    # Steps in sequence.
    "simulate.result": "StepResult",
    "simulate.simulator": "Simulator",
    "optional.fast.simulator": "FastSimulator",
    "optional.derivatives.derivatives": "derivatives",
    "optional.derivatives.smoothed": "smoothed",
    "optional.derivatives.step_jax": "step_jax smoothed_jax",
    "simulate.rollout": "rollout",
    "simulate.recorder": "Recorder",
    "simulate.trajectory": "Trajectory trajectory_read",
    "scenario.scenario": "Scenario load_scenario",
    "optional.scans.body": "scanned_body",
    # One step and its answer.
    "step.data": "StepData Contacts Extra",
    "step.files": "step_read step_written",
    "step.problem": "StepProblem",
    "step.standard_form": "standard_form",
    "optional.extensions.extension": "Extension",
    "certify.solution": "StepSolution",
    "solve.solve": "solve_step",
    "optional.guests.mujoco": "mujoco_step",
    "optional.guests.mujoco_opinion": "second_opinion",
    "optional.guests.scene": "mujoco_scenario",
    "optional.coulomb.fixed_point": "coulomb_step",
    "certify.certificate": "Certificate",
    "certify.verification": "verify",
    "optional.forces.forces": "contact_forces",
    # A run in pictures and numbers.
    "optional.show.figures.animation": "animate",
    "optional.show.figures.contact_pictures": "stick_slip_map",
    "optional.show.figures.draw": "draw_scene draw_scenes",
    "optional.show.figures.friction_cone": "cone_with_load",
    "optional.show.figures.moments": "moment",
    "optional.show.figures.viewer": "view_written",
    "simulate.motions": "relative_turn",
    # What can go wrong.
    "errors": "QuasistaticError InputError MissingKey StepDataError ModelError ContactError "
    "ScenarioError BackendError NotDifferentiable",
    "certify.failures": "StepNotSolved StepInfeasible StepIllPosed",
    "simulate.failures": "LimitExceeded NoFixedPoint RunFailed",
}
_HOME = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = _HOME[name]
    if home.startswith("optional."):
        with import_module(f"{__name__}.parts").needing(name):
            return getattr(import_module(f"{__name__}.{home}"), name)
    return getattr(import_module(f"{__name__}.{home}"), name)


def __dir__() -> list[str]:
    return __all__

"""Runs the Python path of quasistatic_simulator: ``python peer_adapter.py SOURCE OUT``.

SOURCE is a checkout of github.com/pangtao22/quasistatic_simulator at c917755 (MIT licence), none of
which is here. It needs drake, cvxpy, parse and pyyaml; what it imports besides is stood in for: its
compiled module, whose names of modes and parameters are given, and packages that only its viewer,
its gradients or its other robots need. Writes JSON to OUT: the configurations of each instance of
each model after each step, with Drake's Clarabel as it comes, with tighter tolerances, and with
OSQP, its default where no licence is.
"""

import copy
import enum
import json
import sys
import tempfile
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pydrake.common
from pydrake.all import ClarabelSolver, OsqpSolver

TIGHT = ("tol_gap_abs", "tol_gap_rel", "tol_feas")
QUARTER = np.pi / 4
MODELS = {
    "planar_hand_ball": {
        "h": 0.05, "steps": 60,
        "start": {"sphere": [0, 0.5, 0], "arm_left": [-QUARTER] * 2, "arm_right": [QUARTER] * 2},
        "rate": {"arm_left": [-0.01, -0.02], "arm_right": [0.007, 0.014]}, "moving": 40,
    },
    "planar_hand_box": {
        "h": 0.05, "steps": 60,
        "start": {"sphere": [0, 0.5, 0], "arm_left": [-QUARTER] * 2, "arm_right": [QUARTER] * 2},
        "rate": {"arm_left": [-0.01, -0.02], "arm_right": [0.007, 0.014]}, "moving": 40,
    },
    "box_pushing": {
        "h": 0.2, "steps": 60, "start": {"box": [0, 0.5, 0], "hand": [0, -0.2]},
        "rate": {"hand": [0.002, 0.02]}, "moving": 60,
    },
    "ball_grazing_2d": {
        "h": 0.1, "steps": 40, "start": {"box": [0], "ball": [0, 0.1]},
        "rate": {"ball": [0.0025, -0.005]}, "moving": 40,
    },
    "two_spheres_y": {
        "h": 0.05, "steps": 40, "start": {"sphere_y": [0.5], "sphere_y_actuated": [0]},
        "rate": {"sphere_y_actuated": [0.02]}, "moving": 40,
    },
    "two_spheres_yz": {
        "h": 0.1, "steps": 40, "start": {"sphere_yz": [0.05, 0.25], "sphere_yz_actuated": [0, 0]},
        "rate": {"sphere_yz_actuated": [0.002, 0.008]}, "moving": 40,
    },
    "3_link_arm_2d_box": {
        "h": 0.05, "steps": 40,
        "start": {"box0": [1.7, 0.5, 0], "arm": [np.pi / 2, -np.pi / 2, -np.pi / 2]},
        "rate": {"arm": [-0.004, -0.004, 0.002]}, "moving": 40,
    },
    "two_spheres_xyz": {
        "h": 0.1, "steps": 40,
        "start": {"sphere_xyz": [0, 0, 0.5], "sphere_xyz_actuated": [-0.65, 0.05, 0.5]},
        "rate": {"sphere_xyz_actuated": [0.02, 0.002, 0]}, "moving": 40,
    },
}  # fmt: skip
"""Its models, where each starts, and by how much targets move in a step, while they do."""


def command(model, k):
    """Targets of robots after so many steps."""
    start, rate = model["start"], model["rate"]
    moved = min(k + 1, model["moving"])
    return {name: np.add(start[name], np.multiply(moved, r)) for name, r in rate.items()}


class GradientMode(enum.Enum):
    """Which derivatives of a step are formed."""

    kNone = 0
    kBOnly = 1
    kAB = 2


ForwardDynamicsMode = enum.Enum(
    "ForwardDynamicsMode",
    "kQpMp kQpCvx kSocpMp kLogPyramidMp kLogPyramidCvx kLogPyramidMy kLogIcecream",
)


class Parameters(SimpleNamespace):
    """The compiled module's parameters, by their names, with defaults of ours."""

    def __init__(self, **given):
        values = {
            "h": np.nan, "gravity": np.zeros(3), "contact_detection_tolerance": np.nan,
            "is_quasi_dynamic": True, "log_barrier_weight": np.nan,
            "unactuated_mass_scale": np.nan, "calc_contact_forces": False,
            "forward_mode": ForwardDynamicsMode.kQpMp, "gradient_mode": GradientMode.kNone,
            "gradient_lstsq_tolerance": 1e-2, "nd_per_contact": 4, "use_free_solvers": True,
        }  # fmt: skip
        super().__init__(**(values | given))

    def __deepcopy__(self, memo):
        return Parameters(**copy.deepcopy(vars(self), memo))


def stand_ins(source):
    """Put what the source imports and this does not use in its place."""
    nothing = type("Nothing", (), {"__init__": lambda self, *given: None})
    folder = tempfile.mkdtemp()
    for inner in ("manipulation/models", "models"):
        (Path(folder) / inner).mkdir(parents=True)
    pydrake.common.GetDrakePath = lambda: folder
    named = {
        "qsim_cpp": {
            "GradientMode": GradientMode, "ForwardDynamicsMode": ForwardDynamicsMode,
            "QuasistaticSimParameters": Parameters,
            "SolverSelector": type("Selector", (), {"has_gurobi": staticmethod(lambda: False)}),
            **dict.fromkeys(("QuasistaticSimulatorCpp", "BatchQuasistaticSimulator",
                             "QpLogBarrierSolver", "FiniteDiffGradientCalculator"), nothing),
        },
        "robotics_utilities": {}, "robotics_utilities.qp_derivatives": {},
        "robotics_utilities.qp_derivatives.qp_derivatives": {"QpDerivativesKktActive": nothing},
        "robotics_utilities.iiwa_controller": {},
        "robotics_utilities.iiwa_controller.utils": {"get_package_path": lambda: folder},
        "qsim.system": {"QuasistaticSystem": nothing},
        "qsim.visualizer": {"QuasistaticVisualizer": nothing, "QsimVisualizationType": nothing},
    }  # fmt: skip
    for name, values in named.items():
        module = ModuleType(name)
        vars(module).update(values)
        sys.modules[name] = module
    sys.path.insert(0, str(source))


def run(parser, path, model, solver):
    """Configurations of each model instance, a row a step."""
    given = parser(str(path))
    given.set_sim_params(use_free_solvers=True)
    simulator = given.make_simulator_py()
    instances = simulator.get_model_instance_name_to_index_map()
    simulator.solver_qp = OsqpSolver() if solver == "osqp" else ClarabelSolver()
    if solver == "clarabel, tight":
        for option in TIGHT:
            simulator.options_grb.SetOption(ClarabelSolver.id(), option, 1e-12)
    parameters = simulator.get_sim_parmas_copy()
    parameters.h = model["h"]
    parameters.is_quasi_dynamic = True
    parameters.gradient_mode = GradientMode.kNone
    parameters.calc_contact_forces = False
    simulator.sim_params = parameters
    start = {instances[name]: np.array(q, dtype=float) for name, q in model["start"].items()}
    simulator.update_mbp_positions(start)
    rows = {name: [] for name in model["start"]}
    for k in range(model["steps"]):
        targets = {instances[name]: q for name, q in command(model, k).items()}
        simulator.step(targets, simulator.calc_tau_ext([]), parameters)
        for name, q in rows.items():
            q.append(simulator.get_mbp_positions()[instances[name]].tolist())
    return rows


def main():
    """Run all models with all solvers, and write what comes of it."""
    source = Path(sys.argv[1])
    stand_ins(source)
    from qsim.parser import QuasistaticParser

    found = {"models": MODELS}
    for name, model in MODELS.items():
        path = source / "models" / "q_sys" / f"{name}.yml"
        for solver in ("clarabel", "clarabel, tight", "osqp"):
            try:
                result = run(QuasistaticParser, path, model, solver)
            except Exception as error:  # whatever theirs raises
                result = f"{type(error).__name__}: {str(error)[:200]}"
            found.setdefault(name, {})[solver] = result
    Path(sys.argv[2]).write_text(json.dumps(found))


if __name__ == "__main__":
    main()

"""Runs the Python path of quasistatic_simulator: ``python peer_adapter.py SOURCE OUT``.

SOURCE is a checkout of github.com/pangtao22/quasistatic_simulator at c917755 with its submodule
(MIT licence), none of which is here. It needs drake, cvxpy, parse and pyyaml; what it imports
besides is stood in for: its compiled module, whose names of modes and parameters are given, and
what only its viewer or its other robots need. Writes JSON to OUT, for each model: configurations
of each instance after each step, with Drake's Clarabel at several tolerances and with OSQP, its
default where no licence is; its gradients in each step with the tightest; and its steps with
logarithmic barriers from some states of that run.
"""

import copy
import enum
import json
import sys
import tempfile
from functools import partialmethod
from pathlib import Path
from types import ModuleType, SimpleNamespace

import cvxpy as cp
import numpy as np
import pydrake.common
from pydrake.all import ClarabelSolver, OsqpSolver

OPTIONS = ("tol_gap_abs", "tol_gap_rel", "tol_feas")
TOLERANCES = {"clarabel 1e-8": 1e-8, "clarabel 1e-10": 1e-10, "clarabel 1e-12": 1e-12}
"""Of Drake's Clarabel; the first is its own."""
TIGHT = "clarabel 1e-12"
WEIGHTS, EVERY = (1e2, 1e4), 10
"""Its weights of logarithmic barriers, and between how many steps one is taken with each."""
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
        "rate": {"arm": [0.0075] * 3}, "moving": 40,
    },
    "two_spheres_xyz": {
        "h": 0.1, "steps": 40,
        "start": {"sphere_xyz": [0, 0, 0.5], "sphere_xyz_actuated": [-0.65, 0.05, 0.5]},
        "rate": {"sphere_xyz_actuated": [0.02, 0.002, 0]}, "moving": 40,
    },
    "3_link_arm_3d_box": {
        "h": 0.05, "steps": 40,
        "start": {"box0": [1, 0, 0, 0, 0, 1.7, 0.5], "arm": [np.pi / 2, -np.pi / 2, -np.pi / 2]},
        "rate": {"arm": [0.0075] * 3}, "moving": 40,
    },
    "allegro_hand_and_sphere": {
        "h": 0.1, "steps": 40,
        "start": {"sphere": [1, 0, 0, 0, -0.12, 0.01, 0.07], "allegro_hand_right": [0] * 16},
        "rate": {"allegro_hand_right": [0, *[0.05] * 7, 0, *[0.05] * 3, 0, *[0.05] * 3]},
        "moving": 20,
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


def stand_ins(source, folder):
    """Put what the source imports and this does not use in its place; files, in a folder."""
    nothing = type("Nothing", (), {"__init__": lambda self, *given: None})
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
        "robotics_utilities.iiwa_controller.utils": {"get_package_path": lambda: folder},
        "qsim.system": {"QuasistaticSystem": nothing},
        "qsim.visualizer": {"QuasistaticVisualizer": nothing, "QsimVisualizationType": nothing},
    }  # fmt: skip
    for name, values in named.items():
        module = ModuleType(name)
        vars(module).update(values)
        sys.modules[name] = module
    sys.path.insert(0, str(source))


def simulator_of(parser, path, h):
    """Its simulator of a model, in the Python path."""
    given = parser(str(path))
    given.set_sim_params(use_free_solvers=True)
    simulator = given.make_simulator_py()
    parameters = simulator.get_sim_parmas_copy()
    parameters.h = h
    parameters.is_quasi_dynamic = True
    parameters.calc_contact_forces = False
    simulator.sim_params = parameters
    return simulator


def run(parser, path, model, solver):
    """Configurations of each instance, a row a step; of the tightest run its derivatives, too."""
    simulator = simulator_of(parser, path, model["h"])
    parameters = simulator.sim_params
    instances = simulator.get_model_instance_name_to_index_map()
    simulator.solver_qp = OsqpSolver() if solver == "osqp" else ClarabelSolver()
    if solver != "osqp":
        for option in OPTIONS:
            simulator.options_grb.SetOption(ClarabelSolver.id(), option, TOLERANCES[solver])
    planar = parameters.nd_per_contact == 2
    simulator.update_mbp_positions(
        {instances[name]: np.array(q, dtype=float) for name, q in model["start"].items()}
    )
    rows = {name: [] for name in model["start"]}
    gradients, barriers = [], []
    for k in range(model["steps"]):
        targets = {instances[name]: q for name, q in command(model, k).items()}
        loads = simulator.calc_tau_ext([])
        if solver == TIGHT:
            if k % EVERY == 0:
                barriers.append(smooth(simulator, targets, loads))
            parameters.gradient_mode = GradientMode.kAB if planar else GradientMode.kBOnly
        simulator.step(targets, loads, parameters)
        for name, q in rows.items():
            q.append(simulator.get_mbp_positions()[instances[name]].tolist())
        if solver == TIGHT:
            A = simulator.get_Dq_nextDq().tolist() if planar else None
            gradients.append({"A": A, "B": by_target(simulator)})
    return (rows, gradients, barriers) if solver == TIGHT else rows


def by_target(simulator):
    """dq+/du, columns in the order of the plant's velocities."""
    own = [simulator.get_velocity_indices()[model] for model in simulator.get_actuated_models()]
    return simulator.get_Dq_nextDqa_cmd()[:, np.argsort(np.concatenate(own))].tolist()


def smooth(simulator, targets, loads):
    """Its steps with barriers from where it is, by weight: q+ and dq+/du. It stays there."""
    start = simulator.get_mbp_positions()
    at = simulator.get_mbp_positions_as_vec().tolist()
    found = {}
    exact, simulator.sim_params = simulator.sim_params, simulator.get_sim_parmas_copy()
    parameters = simulator.sim_params
    parameters.forward_mode = ForwardDynamicsMode.kLogPyramidCvx
    parameters.gradient_mode = GradientMode.kBOnly
    for weight in WEIGHTS:
        parameters.log_barrier_weight = weight
        simulator.step(targets, loads, parameters)
        found[f"{weight:g}"] = {
            "q": simulator.get_mbp_positions_as_vec().tolist(), "B": by_target(simulator),
        }  # fmt: skip
        simulator.update_mbp_positions(start)
    simulator.sim_params = exact
    return {"at": at, "by weight": found}


def main():
    """Run all models with all solvers, and write what comes of it."""
    source = Path(sys.argv[1])
    # It leaves the solver of its barriers to CVXPY, which takes Clarabel: here at 1e-12.
    tight = dict.fromkeys(OPTIONS, TOLERANCES[TIGHT])
    cp.Problem.solve = partialmethod(cp.Problem.solve, solver=cp.CLARABEL, **tight)
    with tempfile.TemporaryDirectory() as folder:
        stand_ins(source, folder)
        found = runs_of_models(source)
    Path(sys.argv[2]).write_text(json.dumps(found))


def runs_of_models(source):
    """What comes of all models with all solvers, by model."""
    from qsim.parser import QuasistaticParser

    found = {}
    for name, model in MODELS.items():
        path = source / "models" / "q_sys" / f"{name}.yml"
        of_model = found[name] = {"model": model, "runs": {}}
        for solver in (*TOLERANCES, "osqp"):
            result = run(QuasistaticParser, path, model, solver)
            if solver == TIGHT:
                result, of_model["gradients"], of_model["barriers"] = result
            of_model["runs"][solver] = result
    return found


if __name__ == "__main__":
    main()

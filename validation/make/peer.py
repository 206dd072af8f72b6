"""A peer's models: ``python -m validation.make.peer [--source F] [--python P] [--out FILE]``.

quasistatic_simulator of Pang and Tedrake solves the same kind of step. F is a checkout of it at
c917755 (MIT licence), of which nothing is here; without one, git clones it. P is an interpreter
with drake, cvxpy, parse and pyyaml, which runs its Python path by
``validation/programs/engines/peer_adapter.py`` on eight of its models; without one, an environment
is made. Each model is then run by ``drake_step`` on the same Drake plant, every step exact. FILE
gets the page, and the file next to it with the ending .json the configurations of its planar hand,
which the claim ``peer`` compares with a scene of ours.
Exit status 1 if a model is farther than 1e-8 from ours with tight tolerances, and the difference is
not its solver's: such a one falls with its tolerances.
"""

import json
import subprocess
import sys
import tempfile
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.optional.guests.drake import drake_step, scoped
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import StepData, no_rows
from validation.tools.scripts import ROOT, asked, environment, shown

drake = import_module("pydrake.all")
SOURCE, COMMIT = "https://github.com/pangtao22/quasistatic_simulator", "c917755"
PACKAGES = ("drake>=1.51", "cvxpy", "parse", "pyyaml")
"""Of the environment in which its Python path runs."""
ADAPTER = ROOT / "validation" / "programs" / "engines" / "peer_adapter.py"
HAND = "planar_hand_ball"
AGREES = 1e-8
FALLS = 50.0
"""By how much a difference falls at least, with tolerances smaller by 1e4, that is its solver's: it
is the square root of the tolerance where rows are repeated or barely active."""
SOLVERS = ("clarabel", "clarabel, tight", "osqp")
PAGE = """# A peer's models

Made by `python -m validation.make.peer` with Drake's wheel, of quasistatic_simulator (Pang and
Tedrake, c917755, MIT licence), whose Python path takes steps of the same kind: the same quadratic
program without torsion, with facets in a plane where its models are planar, and with the mass of
un-actuated bodies scaled where a model says so. Here both are given the same.

Columns: the largest difference of any coordinate in any step between its run and ours, on the same
Drake plant [m, rad], by its solver: Drake's Clarabel as it comes, with tolerances of 1e-12, and
OSQP, its default where no licence is; the digits of the second, -log10 of the difference over the
largest motion. Our steps are exact; what is left is its solver's: it falls with its tolerances, and
with their square root in the two models of spheres whose difference is largest. Its gradients, its
log-barrier smoothing and its models with iterated distances (the Allegro hand) are not compared.

{table}
"""


def plant_of(source: Path, name: str) -> tuple[Any, Any, dict[str, Any], dict[str, Any]]:
    """Plant, root context, what the model says, and stiffness by joint."""
    given = import_module("pydrake.common.yaml").yaml_load_file(
        str(source / "models" / "q_sys" / f"{name}.yml")
    )
    models = source / "models"

    def path(uri: str) -> str:
        return str(models / uri.removeprefix("package://quasistatic_simulator/"))

    builder = drake.DiagramBuilder()
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, 1e-3)
    parser = drake.Parser(plant)
    parser.package_map().Add("quasistatic_simulator", str(models))
    for thing in given["objects"]:
        (instance,) = parser.AddModels(path(thing["file"]))
        plant.RenameModelInstance(instance, thing["name"])
    drake.ProcessModelDirectives(drake.LoadModelDirectives(path(given["model_directive"])), parser)
    plant.mutable_gravity_field().set_gravity_vector(given["quasistatic_sim_params"]["gravity"])
    plant.Finalize()
    diagram = builder.Build()
    stiffness = {}
    for robot in given["robots"]:
        own = [plant.get_joint(i) for i in plant.GetJointIndices(
            plant.GetModelInstanceByName(robot["name"]))]  # fmt: skip
        moving = sorted((j for j in own if j.num_velocities()), key=lambda j: j.velocity_start())
        stiffness |= {scoped(plant, j): k for j, k in zip(moving, robot["Kp"], strict=True)}
    plant.KEPT = diagram  # or Python drops it
    return plant, diagram.CreateDefaultContext(), given["quasistatic_sim_params"], stiffness


def ours(source: Path, name: str, model: dict[str, Any]) -> dict[str, list[list[float]]]:
    """Configurations of each model instance, a row a step, by exact steps."""
    plant, root, says, stiffness = plant_of(source, name)
    context = plant.GetMyContextFromRoot(root)
    instances = {i: plant.GetModelInstanceByName(i) for i in model["start"]}
    for instance, q in model["start"].items():
        plant.SetPositions(context, instances[instance], q)
    found: dict[str, list[list[float]]] = {instance: [] for instance in instances}
    margin = float(says["contact_detection_tolerance"])
    for k in range(model["steps"]):
        moved = min(k + 1, model["moving"])
        targets = {}
        for robot, rate in model["rate"].items():
            goal = np.add(model["start"][robot], np.multiply(moved, rate))
            joints = [j for j in stiffness if j.startswith(f"{robot}::")]
            targets |= dict(zip(joints, goal.tolist(), strict=True))
        step, coordinates = drake_step(plant, context, model["h"], stiffness, targets, margin)
        answer = solve_step(theirs(step, says))
        v = coordinates.T @ answer.delta_q
        q = plant.GetPositions(context) + plant.MapVelocityToQDot(context, v)
        plant.SetPositions(context, q)
        for instance, rows in found.items():
            rows.append(plant.GetPositions(context, instances[instance]).tolist())
    return found


def theirs(step: StepData, says: dict[str, Any]) -> StepData:
    """A step as the peer has it: without loads on robots, limits and masses that it scales."""
    scale = float(says.get("unactuated_mass_scale", np.nan))
    M_u = step.M_u
    if np.isfinite(scale) and scale > 0:
        M_u = M_u * (np.diag(step.K_q).min() * step.h**2 / np.diag(M_u).max() / scale)
    contacts = step.contacts
    if says["nd_per_contact"] == 4:
        turned = [drake.RotationMatrix.MakeFromOneVector(n, 2).matrix() for n in contacts.n]
        frames = np.array(turned).reshape(-1, 3, 3)
        contacts = replace(contacts, d1=frames[:, :, 0], d2=frames[:, :, 1])
    return step.replace(
        M_u=M_u, tau_a=np.zeros(step.n_a), extra=no_rows(step.n_v), contacts=contacts
    )


def together(rows: dict[str, list[list[float]]]) -> Array:
    """All coordinates, a row a step."""
    return np.hstack([np.array(rows[name]) for name in sorted(rows)])


def cloned(folder: Path) -> Path:
    """The peer's source at its commit."""
    subprocess.run(["git", "clone", "-q", SOURCE, str(folder)], check=True)
    subprocess.run(["git", "-C", str(folder), "checkout", "-q", COMMIT], check=True)
    return folder


def main() -> int:
    """Run both, write the page, and return the exit status."""
    options = asked(__doc__, source=Path, python=str, out=Path)
    with tempfile.TemporaryDirectory() as own:
        folder = Path(own)
        source = options.source or cloned(folder / "source")
        python = options.python or str(environment(folder / "environment", *PACKAGES))
        out = folder / "peer.json"
        command = [python, str(ADAPTER), str(source), str(out)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        runs = json.loads(out.read_text("utf-8"))
        models = runs.pop("models")
        every = {name: together(ours(source, name, models[name])) for name in runs}
    table = []
    far = []
    for name, by_solver in runs.items():
        mine = every[name]
        off = {}
        for solver in SOLVERS:
            run = by_solver[solver]
            off[solver] = np.nan if isinstance(run, str) else np.abs(together(run) - mine).max()
        motion = np.abs(mine - mine[0]).max()
        digits = -np.log10(off["clarabel, tight"] / motion)
        table.append((name, models[name]["steps"], *(f"{off[s]:.1e}" for s in SOLVERS),
                      f"{digits:.1f}"))  # fmt: skip
        falls = off["clarabel, tight"] <= off["clarabel"] / FALLS
        if not (off["clarabel, tight"] <= AGREES or falls):
            far.append(name)
    head = ("model", "steps", *SOLVERS, "digits")
    shown(PAGE.format(table="\n".join(markdown_table(head, table, 1))), options.out)
    if options.out is not None:
        hand = {"model": models[HAND], "runs": {s: runs[HAND][s] for s in SOLVERS}}
        text_written(options.out.with_suffix(".json"), json.dumps(hand) + "\n")
    print(f"farther than its solver explains: {', '.join(far) or 'none'}", file=sys.stderr)
    return int(bool(far))


if __name__ == "__main__":
    sys.exit(main())

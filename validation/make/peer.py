"""A peer's models: ``python -m validation.make.peer [--source F] [--python P] [--out FILE]``.

quasistatic_simulator of Pang and Tedrake solves the same kind of step. F is a checkout of it at
c917755 with its submodule (MIT licence), of which nothing is here; without one, git clones it. P is
an interpreter with drake, cvxpy, parse and pyyaml, which runs its Python path by
``validation/programs/engines/peer_adapter.py`` on ten of its models; without one, an environment
is made. Each model is then run by ``drake_step`` on the same Drake plant, every step exact. FILE
gets the page, and the file next to it with the ending .json what the claim ``peer`` compares with a
scene of ours: its planar hand.
Exit status 1 if a model is farther than 1e-8 from ours with tolerances of 1e-12, and the central
path of our own steps does not say that this is its solver's error.
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.claims.engines.peer import data_rates, gradients, in_plane
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.optional.derivatives.step.barrier import barrier_rates, barrier_step
from quasistatic_ref.optional.guests.drake import drake_step, scoped
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import StepData, no_rows
from quasistatic_ref.step.files import step_sha256
from validation.tools.scripts import ROOT, environment, script_options, show_page

drake = import_module("pydrake.all")
SOURCE, COMMIT = "https://github.com/pangtao22/quasistatic_simulator", "c917755"
PACKAGES = ("drake>=1.51", "cvxpy", "parse", "pyyaml")
"""Of the environment in which its Python path runs."""
ADAPTER = ROOT / "validation" / "programs" / "engines" / "peer_adapter.py"
HAND = "planar_hand_ball"
AGREES = 1e-8
SOLVERS = ("clarabel 1e-8", "clarabel 1e-10", "clarabel 1e-12", "osqp")
TIGHT = SOLVERS[2]
KAPPAS = (1e-8, 1e-10, 1e-12)
"""Weights of the barriers on the central path [N m s]."""
ROOTS = 30.0
"""An error that falls by less from one of them to the next is their square root: of a row whose
slack and multiplier are both zero, or nearly. Else it falls as they do, by 100."""
FACETS = "8 facets"
WEIGHTS = ("100", "10000")
APART = 1e-5
"""Change of a coordinate by which whole derivatives are measured [m, rad]."""
EVERY = 10
"""Between how many steps they are."""
HEADS = {
    "trajectories": (
        "model", "steps", *SOLVERS, "digits", *(f"kappa {kappa:g}" for kappa in KAPPAS),
    ),
    "worth": ("model", "true masses", "our tangents", "loads", "limits", "8 facets"),
    "gradients": ("model", "steps", "B", "B, same rows", "B, E(q+)", "A, held", "A, whole"),
    "smoothing": (
        "model", *(f"{what}, w = {w}" for w in WEIGHTS for what in ("q+", "B", "from exact")),
    ),
}  # fmt: skip
PAGE = """# A peer's models

Made by `python -m validation.make.peer` with Drake's wheel, of quasistatic_simulator (Pang and
Tedrake, c917755, MIT licence). Its Python path takes steps of the same kind: the same quadratic
program without torsion, with two facets where a model is planar and four elsewhere, without loads
and limits of joints, and with masses of un-actuated bodies scaled where a model says so. Here both
are given the same on the same Drake plant; ours is exact.

## Trajectories

The largest difference of any coordinate in any step [m, rad], by its solver: Drake's Clarabel with
tolerances of 1e-8, its own, to 1e-12 (at 1e-14 it often fails), and OSQP, its default where no
licence is. Digits: -log10 of the third over the largest motion. The last columns are of our steps
alone: how far the minimiser with barriers -kappa log(slack) [N m s] is from the exact one, where
Newton's method converges. It falls as kappa does, by 100, unless a row has neither slack nor
multiplier: then by 10, and so does an interior-point method with its tolerance. In two_spheres_y
the target of one step ends where the spheres touch; in two_spheres_xyz, which is not planar, two
rows lose their slack from step to step (8e-9 m in step 20) and never bear.

{trajectories}

## What each difference of the models is worth

The largest difference from its tight run if ours has one thing otherwise. A dash: the first step is
the same. Our tangents change nothing where they span the same pyramid. The claim `peer` has the
planar hand with our geometry in place of Drake's.

{worth}

## Gradients

The largest differences of B = dq+/du, by the targets, and A = dq+/dq, which it gives of planar
models. Its rows are those that bear more than 0.1 N, ours all that bear: all columns but the first
B are of steps in which these are the same (steps: so many, of those with a derivative, of all). A
free body's orientation follows E(q) in its step, and E(q+) in its B; the next column takes E(q+)
for ours, too. *Held*: ours with J as it is, which is how it defines A. *Whole*: ours with all that
q changes, by differences of exact steps of +-{apart:g}, every {every}th: what its A leaves out, by
intention, where normals or points of contact turn.

{gradients}

## Smoothing

Its steps with log barriers of weight w are ours (`smoothed`) with kappa = h / w, of its rows: two
for each contact in a plane. Differences of q+ and B from every {every}th state, by CVXPY's Clarabel
at 1e-12, which calls some inaccurate; and how far the smoothed q+ is from the exact one.

{smoothing}
"""


class Model:
    """A model of the peer's on a Drake plant, which is somewhere.

    Parameters
    ----------
    name : str
    given : mapping
        Where it starts, its targets and its time step.
    source : Path
        The checkout.
    """

    def __init__(self, name: str, given: dict[str, Any], source: Path) -> None:
        self.name, self.given = name, given
        models = source / "models"
        read = import_module("pydrake.common.yaml").yaml_load_file
        says = read(str(models / "q_sys" / f"{name}.yml"))
        self.parameters = says["quasistatic_sim_params"]
        self.planar = self.parameters["nd_per_contact"] == 2

        def path(uri: str) -> str:
            return str(models / uri.removeprefix("package://quasistatic_simulator/"))

        builder = drake.DiagramBuilder()
        self.plant, _ = drake.AddMultibodyPlantSceneGraph(builder, 1e-3)
        parser = drake.Parser(self.plant)
        parser.package_map().Add("quasistatic_simulator", str(models))
        for thing in says["objects"]:
            (instance,) = parser.AddModels(path(thing["file"]))
            self.plant.RenameModelInstance(instance, thing["name"])
        directives = drake.LoadModelDirectives(path(says["model_directive"]))
        drake.ProcessModelDirectives(directives, parser)
        self.plant.mutable_gravity_field().set_gravity_vector(self.parameters["gravity"])
        self.plant.Finalize()
        self.diagram = builder.Build()
        self.root = self.diagram.CreateDefaultContext()
        self.context = self.plant.GetMyContextFromRoot(self.root)
        self.stiffness = {}
        for robot in says["robots"]:
            instance = self.plant.GetModelInstanceByName(robot["name"])
            own = [self.plant.get_joint(i) for i in self.plant.GetJointIndices(instance)]
            own = sorted((j for j in own if j.num_velocities()), key=lambda j: j.velocity_start())
            names = [scoped(self.plant, joint) for joint in own]
            self.stiffness |= dict(zip(names, robot["Kp"], strict=True))

    def start(self) -> None:
        """Go where it starts."""
        for instance, q in self.given["start"].items():
            number = self.plant.GetModelInstanceByName(instance)
            self.plant.SetPositions(self.context, number, q)

    @property
    def q(self) -> Array:
        """The plant's positions, which may be set."""
        return np.array(self.plant.GetPositions(self.context))

    @q.setter
    def q(self, value: Array) -> None:
        self.plant.SetPositions(self.context, value)

    def by_instance(self, q: Array) -> dict[str, Array]:
        """Positions, shape (..., nq), of each instance, in the order of the file."""
        numbers = np.arange(self.plant.num_positions())
        found = {}
        for name in self.given["start"]:
            instance = self.plant.GetModelInstanceByName(name)
            found[name] = q[..., self.plant.GetPositionsFromArray(instance, numbers).astype(int)]
        return found

    def targets(self, k: int) -> dict[str, float]:
        """Of joints in step k [m, rad]."""
        moved = min(k + 1, self.given["moving"])
        found = {}
        for robot, rate in self.given["rate"].items():
            goal = np.add(self.given["start"][robot], np.multiply(moved, rate))
            joints = [j for j in self.stiffness if j.startswith(f"{robot}::")]
            found |= dict(zip(joints, goal.tolist(), strict=True))
        return found

    def step(self, k: int, keeps: str = "") -> tuple[StepData, Array]:
        """Step k from where it is, as the peer has it but for what it `keeps`; T (nv, n_v)."""
        margin = float(self.parameters["contact_detection_tolerance"])
        step, coordinates = drake_step(
            self.plant, self.context, self.given["h"], self.stiffness, self.targets(k), margin,
            depth="as is",
        )  # fmt: skip
        for what, change in CHANGES.items():
            if what != keeps:
                step = change(self, step)
        if keeps == FACETS:
            step = step.replace(cone="facets-8")
        return step, coordinates.T

    def moved(self, v: Array) -> Array:
        """Rates of positions of displacements of velocities, (nv,) or (nv, P), where it is."""
        return np.array([self.plant.MapVelocityToQDot(self.context, one) for one in v.T]).T

    def onward(self, v: Array) -> Array:
        """Positions after a displacement of velocities, (nv,), quaternions of length one."""
        q = self.q + self.plant.MapVelocityToQDot(self.context, v)
        for index in self.plant.GetFloatingBaseBodies():
            first = self.plant.get_body(index).floating_positions_start()
            q[first : first + 4] /= np.linalg.norm(q[first : first + 4])
        return np.asarray(q)

    def run(self, keeps: str = "") -> Iterator["State"]:
        """Each step from its start."""
        self.start()
        for k in range(self.given["steps"]):
            step, T = self.step(k, keeps)
            answer = solve_step(step)
            after = self.onward(T @ answer.delta_q)
            yield State(k, self.q, step, T, answer, after)
            self.q = after

    def trajectory(self, keeps: str = "") -> Array:
        """Positions after each step, shape (steps, nq) [m, rad, -]."""
        return np.array([state.after for state in self.run(keeps)])

    def together(self, run: dict[str, list[list[float]]]) -> Array:
        """A run of its own, by instances, in the same order."""
        found = np.zeros((self.given["steps"], self.plant.num_positions()))
        for name, entries in self.by_instance(np.arange(found.shape[1])).items():
            found[:, entries] = run[name]
        return found


@dataclass(frozen=True, eq=False)
class State:
    """A step of ours: its number, positions (nq,), data, T (nv, n_v), answer, positions after."""

    k: int
    at: Array
    step: StepData
    T: Array
    answer: StepSolution
    after: Array


def scaled(model: Model, step: StepData) -> StepData:
    """With masses as it scales them, by `unactuated_mass_scale`."""
    scale = float(model.parameters.get("unactuated_mass_scale", np.nan))
    if not scale > 0:
        return step
    largest = np.diag(step.M_u).max()
    return step.replace(M_u=step.M_u * (np.diag(step.K_q).min() * step.h**2 / largest / scale))


def turned(model: Model, step: StepData) -> StepData:
    """With its tangents: in space those that Drake makes of the normal into a body of the model."""
    if model.planar or not step.contacts.n_c:
        return step
    contacts = step.contacts
    frames = []
    for name, n in zip(contacts.name, contacts.n, strict=True):
        into = name.partition("/")[2].partition("::")[0] in model.given["start"]  # of A
        frames.append(drake.RotationMatrix.MakeFromOneVector(n if into else -n, 2).matrix())
    R = np.array(frames)
    return step.replace(contacts=replace(contacts, d1=R[:, :, 0], d2=R[:, :, 1]))


def unloaded(model: Model, step: StepData) -> StepData:
    """Without loads on robots."""
    return step.replace(tau_a=np.zeros(step.n_a))


def unlimited(model: Model, step: StepData) -> StepData:
    """Without limits of joints."""
    return step.replace(extra=no_rows(step.n_v))


CHANGES = {
    "true masses": scaled, "our tangents": turned, "loads": unloaded, "limits": unlimited,
}  # fmt: skip
"""What makes a step of ours one of the peer's, by what ours would keep."""


def digits(error: float, size: float) -> str:
    """-log10 of an error over a size."""
    return f"{-np.log10(error / size):.1f}" if error else "16"


def number(error: float) -> str:
    """An error in two digits."""
    return f"{error:.1e}"


def of_barriers(states: list[State]) -> list[float]:
    """How far minimisers with barriers are from exact ones, for each kappa [m, rad]."""
    largest = [0.0] * len(KAPPAS)
    for i, kappa in enumerate(KAPPAS):
        for state in states:
            with suppress(StepNotSolved):
                off = barrier_step(state.step, kappa).x - state.answer.delta_q
                largest[i] = max(largest[i], float(np.abs(off).max()))
    return largest


def of_worth(model: Model, theirs: Array) -> list[str]:
    """The largest difference from the peer's run if ours keeps something."""
    model.start()
    plain, _ = model.step(0)
    found = []
    for keeps in (*CHANGES, FACETS):
        other, _ = model.step(0, keeps)
        same = step_sha256(other) == step_sha256(plain)
        found.append("-" if same else number(np.abs(model.trajectory(keeps) - theirs).max()))
    return found


def whole(model: Model, k: int) -> Array:
    """A of exact steps, by central differences where it is, shape (nq, nq)."""
    here = model.q
    found = []
    for i in range(len(here)):
        ends = []
        for side in (APART, -APART):
            model.q = here + side * np.eye(len(here))[i]
            step, T = model.step(k)
            ends.append(model.onward(T @ solve_step(step).delta_q))
        found.append((ends[0] - ends[1]) / (2 * APART))
    model.q = here
    return np.array(found).T


def of_gradients(model: Model, states: list[State], given: list[dict[str, Any]]) -> list[str]:
    """A row of the table of gradients."""
    off = {key: [] for key in ("B", "same rows", "E", "held", "whole")}
    for state, theirs in zip(states, given, strict=True):
        model.q = state.at
        step, T = state.step, state.T
        B, A = gradients(state.answer)
        if np.isnan(B).any():
            continue
        lam = state.answer.lam
        same = not ((lam > 0) & (lam <= 0.1 * step.h)).any()
        ours = T @ B
        off["B"].append(float(np.abs(model.moved(ours) - theirs["B"]).max()))
        model.q = state.after
        along = model.moved(ours)
        model.q = state.at
        if same:
            off["same rows"].append(off["B"][-1])
            off["E"].append(float(np.abs(along - theirs["B"]).max()))
        if theirs["A"] is not None and same and not np.isnan(A).any():
            off["held"].append(float(np.abs(T @ A @ T.T - theirs["A"]).max()))
            if state.k % EVERY == 0:
                off["whole"].append(float(np.abs(whole(model, state.k) - theirs["A"]).max()))
    steps = f"{len(off['same rows'])} of {len(off['B'])} of {model.given['steps']}"
    return [steps, *(number(max(own)) if own else "-" for own in off.values())]


def of_smoothing(model: Model, barriers: list[dict[str, Any]]) -> Iterator[str]:
    """The largest differences of q+ and of B, and of q+ from the exact one, for each weight."""
    for weight in WEIGHTS:
        largest = np.zeros(3)
        for i, barrier in enumerate(barriers):
            model.q = np.array(barrier["at"])
            step, T = model.step(EVERY * i)
            exact = model.onward(T @ solve_step(step).delta_q)
            rows = in_plane(step) if model.planar else step
            found = barrier_step(rows, step.h / float(weight))
            theirs = barrier["by weight"][weight]
            q = model.onward(T @ found.x)
            B = T @ barrier_rates(rows, found, data_rates(rows))[:, : step.n_a]
            off = (q - theirs["q"], B - theirs["B"], q - exact)
            largest = np.maximum(largest, [np.abs(one).max() for one in off])
        yield from map(number, largest)


def peer_source(folder: Path) -> Path:
    """The peer's source at its commit."""
    subprocess.run(["git", "clone", "-q", SOURCE, str(folder)], check=True)
    for words in (("checkout", "-q", COMMIT), ("submodule", "update", "-q", "--init")):
        subprocess.run(["git", "-C", str(folder), *words], check=True)
    return folder


def bare_copy(source: Path, folder: Path) -> Path:
    """A copy without visual elements, whose meshes Drake would download."""
    shutil.copytree(source, folder, ignore=shutil.ignore_patterns(".git"))
    for path in (folder / "models").glob("*.sdf"):
        text = path.read_text("utf-8")
        path.write_text(re.sub(r"<visual\b.*?</visual>", "", text, flags=re.DOTALL), "utf-8")
    return folder


def main() -> int:
    """Run both, write the page, and return the exit status."""
    options = script_options(__doc__, source=Path, python=str, out=Path)
    with tempfile.TemporaryDirectory() as own:
        folder = Path(own)
        source = bare_copy(options.source or peer_source(folder / "source"), folder / "bare")
        python = options.python or str(environment(folder / "environment", *PACKAGES))
        out = folder / "peer.json"
        command = [python, str(ADAPTER), str(source), str(out)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        found = json.loads(out.read_text("utf-8"))
        return compare(source, found, options.out)


def compare(source: Path, found: dict[str, Any], out: Path | None) -> int:
    """Compare all models, write the page, and return the exit status."""
    rows = {key: [] for key in HEADS}
    far = []
    for name, theirs in found.items():
        model = Model(name, theirs["model"], source)
        states = list(model.run())
        mine = np.array([state.after for state in states])
        runs = {solver: model.together(run) for solver, run in theirs["runs"].items()}
        off = {solver: float(np.abs(run - mine).max()) for solver, run in runs.items()}
        path = of_barriers(states)
        motion = float(np.abs(mine - mine[0]).max())
        rows["trajectories"].append((
            name, model.given["steps"], *(number(off[s]) for s in SOLVERS),
            digits(off[TIGHT], motion), *map(number, path),
        ))  # fmt: skip
        roots = path[0] < ROOTS * path[1] and path[1] < ROOTS * path[2]
        if off[TIGHT] > AGREES and not roots:
            far.append(name)
        rows["worth"].append((name, *of_worth(model, runs[TIGHT])))
        rows["gradients"].append((name, *of_gradients(model, states, theirs["gradients"])))
        rows["smoothing"].append((name, *of_smoothing(model, theirs["barriers"])))
    texts = {key: "\n".join(markdown_table(HEADS[key], own, 1)) for key, own in rows.items()}
    show_page(PAGE.format(apart=APART, every=EVERY, **texts), out)
    if out is not None:
        hand = found[HAND]
        del hand["barriers"]
        hand["gradients"] = hand["gradients"][::EVERY]
        text_written(out.with_suffix(".json"), json.dumps(hand) + "\n")
    print(f"farther than its solver explains: {', '.join(far) or 'none'}", file=sys.stderr)
    return int(bool(far))


if __name__ == "__main__":
    sys.exit(main())

"""Models of others as steps: ``python -m validation.make.guests [--folder F] [--out FILE]``.

Each MJCF file of ``PACKAGES`` that loads and has coordinates settles in MuJoCo, from its first
keyframe if it has one. ``mujoco_step`` makes a step of its state, and ``solve_step`` answers it.
pip installs the packages into F, or a temporary folder, without what they need: of them only the
models are read. Of each answer, all forces are added up once more from MuJoCo's arrays.
Exit status 1 if one is not in balance, more than a tenth of the models are refused, or the second
opinion finds something in one of HEALTHY.
"""

import copy
import subprocess
import sys
import tempfile
import time
import warnings
from collections import Counter
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.optional.guests import touches
from quasistatic_ref.optional.guests.findings import Finding
from quasistatic_ref.optional.guests.mujoco import Coordinates, mujoco_step
from quasistatic_ref.optional.guests.mujoco_opinion import second_opinion
from quasistatic_ref.optional.guests.still import still
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import StepData
from validation.tools.scripts import script_options, show_page

mujoco = import_module("mujoco")
PACKAGES = (
    "gymnasium-robotics==1.4.2", "dm_control==1.0.50", "robosuite==1.5.2", "metaworld==3.1.1",
    "myosuite==3.0.0",
)  # fmt: skip
H = 0.01
"""Time step [s]."""
SETTLED, MOST = 1.5, 3000
"""Simulated time [s], and steps at most."""
AT_REST = 1e-2
"""Largest velocity of a state at rest [m/s, rad/s]."""
DEEP = 1e-3
"""Depth beyond which MuJoCo's forces may be those of its contacts' springs [m]."""
BALANCED = 1e-6
AGREES = 0.01
"""Relative difference of sums of normal forces, up to which they agree."""
FAR = 1e6
"""Margins of limits [m, rad], at which MuJoCo has rows for all of them."""
OBJECTS = "metaworld/assets/objects"
HEALTHY = (
    f"{OBJECTS}/assembly_peg.xml", f"{OBJECTS}/block.xml", f"{OBJECTS}/box.xml",
    f"{OBJECTS}/club.xml", f"{OBJECTS}/hammer.xml", f"{OBJECTS}/mug.xml",
    f"{OBJECTS}/peg_insert.xml", f"{OBJECTS}/soccer_ball.xml", f"{OBJECTS}/stick.xml",
    "gymnasium_robotics/envs/assets/adroit_hand/adroit_hammer.xml",
)  # fmt: skip
"""Scenes in which nothing is wrong, chosen before there were findings."""
MOST_WORDS = 3
"""Findings of a model that the table names."""


HEAD = (
    "model", "n_v", "contacts", "cone", "answer", "fastest", "speed",
    "deepest [mm]", "MuJoCo [N]", "here [N]", "off balance", "MuJoCo off",
    "why they differ", "second opinion",
)  # fmt: skip
PAGE = """# States of others as steps

Made by `python -m validation.make.guests` with MuJoCo {version}, of {packages}. Of their MJCF
files, {models} load and have coordinates. Each settles in MuJoCo for 1.5 s (3000 steps at most),
and its state is a step of 10 ms. {quiet} of them touch nothing, are answered and have no finding:
they have no row.

{answered} are answered ({kinds}), {refused} refused. A step takes {middle:.0f} ms (median) and
{longest:.1f} s at most. In {balanced} answers the forces, added up from MuJoCo's arrays, are in
balance to {limit:g} of the largest on each body, along the joints that move it (across them, joints
bear anything). {rest} rest and touch. In {agree} of them the sum of normal forces agrees with
MuJoCo's to 1 %; in {deep} bodies are deeper than 1 mm in each other.

Columns: the certificate of the answer, or what refuses it;
largest velocity in MuJoCo and of the answer [m/s, rad/s]; sums of normal forces, with a star where
single forces are not unique and the proof's are added; how far the forces of the answer are from
balance, over the largest; the same for MuJoCo's own forces without velocity, over the loads, in the
norm of H^-1; why sums of forces differ at rest:

- "deep": bodies are deeper than 1 mm;
- "left out": the difference is that of contacts which the step leaves out;
- "both balance": MuJoCo's forces are in balance to 1 %, too. Forces within the bodies differ, which
  balance does not determine; MuJoCo's are those of its springs where bodies are in each other;
- "damping": MuJoCo's forces are in balance to 1 % with the damping of a slow motion, not without;
- "no balance": they are not in balance with it either, so that the state still moves.

The last column is what `second_opinion` finds in the same state: bodies that creep, slide, turn or
rest in MuJoCo alone, and the depth of those that are pushed apart by more than their loads. {found}
models have a finding; the {healthy} that were chosen as healthy before there were findings have
{ill}.

{table}
"""


@dataclass
class Found:
    """What became of one model."""

    path: str
    n_v: int = 0
    contacts: int = 0
    fastest: float = 0.0
    deepest: float = 0.0
    theirs: float = 0.0
    theirs_left_out: float = 0.0
    theirs_off: tuple[float, float] = (0.0, 0.0)
    ours: float = 0.0
    several: bool = False
    speed: float = 0.0
    off: float = 0.0
    seconds: float = 0.0
    kind: str = ""
    cone: str = ""
    refused: str = ""
    opinion: str = ""

    @property
    def rests(self) -> bool:
        """Whether it is answered, rests and touches."""
        return bool(not self.refused and self.contacts and self.fastest < AT_REST)


def settled_state(model: Any) -> Any:
    """The state of a model after a while, from its first keyframe if it has one."""
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(min(MOST, round(SETTLED / model.opt.timestep))):
        mujoco.mj_step(model, data)
    return data


def imbalance(model: Any, data: Any, coordinates: Coordinates, answer: StepSolution) -> float:
    """How far forces on the coordinates are from balance, over the largest of them [-].

    Contact forces act on each body at its surface, by ``mj_applyFT``; limits and equalities act
    along rows of ``efc_J``, those that the step has; all else is ``qfrc_smooth``. What is left is
    K_q delta_q_a of actuated coordinates, and M delta_q_u / h^2 of the others.
    """
    step = answer.step
    wide = copy.copy(model)
    wide.jnt_margin[:] = wide.tendon_margin[:] = FAR
    wide.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    rest = copy.copy(data)
    rest.qvel[:] = 0.0
    mujoco.mj_forward(wide, rest)
    push = np.zeros(model.nv)
    for called, (f_1, f_2, f_n, tau) in zip(step.contacts.name, answer.wrench, strict=True):
        touch = rest.contact[touches.number(called)]
        n, d1, d2 = touch.frame.reshape(3, 3)
        force = f_n * n + f_1 * d1 + f_2 * d2
        for geom, side in zip(touch.geom, (-1.0, 1.0), strict=True):
            point = touch.pos + side * touch.dist / 2 * n
            body = model.geom_bodyid[geom]
            mujoco.mj_applyFT(model, rest, side * force, side * tau * n, point, body, push)
    T = coordinates.T
    p = int((coordinates.dofs < 0).sum())
    of_own = step.n_v - p  # what friction appends has no place in MuJoCo
    J = rest.efc_J.reshape(-1, model.nv)
    along = np.concatenate([J @ T, -J @ T])[:, :of_own]
    rubbed = np.zeros(step.n_v)
    rows = step.extra.A[:, :of_own]
    for k, force in enumerate(answer.lam_extra / step.h):
        if k >= len(rows) - 2 * p:
            rubbed[:of_own] += rows[k] * force
        elif force:
            same = int(np.abs(along - rows[k]).max(axis=1).argmin())
            push += np.concatenate([J, -J])[same] * force
    x = answer.delta_q
    n_a = step.n_a
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(wide, rest, M)
    taken = np.concatenate([step.K_q @ x[:n_a], (T.T @ M @ T)[n_a:, n_a:] @ x[n_a:] / step.h**2])
    parts = [T.T @ rest.qfrc_smooth, T.T @ push, rubbed, -taken]
    left = np.abs(sum(parts)[:of_own]).max(initial=0.0)
    return float(left / (np.abs(parts).max(initial=0.0) or 1.0))


def own_imbalance(model: Any, data: Any, step: StepData, T: Array) -> tuple[float, float]:
    """How far MuJoCo's forces are from balance, over the loads, in the norm of H^-1 [-].

    Without the forces that come from velocity, and with them.
    """
    rest = copy.copy(data)
    rest.qvel[:] = 0.0
    mujoco.mj_forward(model, rest)
    norm = energy_norm(step.H)
    loads = (rest.qfrc_bias, rest.qfrc_passive, rest.qfrc_actuator, data.qfrc_constraint)
    largest = max(norm.of_impulse(T.T @ load) for load in loads) or 1.0
    left = [
        norm.of_impulse(T.T @ (smooth + data.qfrc_constraint)) / largest
        for smooth in (rest.qfrc_smooth, data.qfrc_smooth)
    ]
    return left[0], left[1]


def opinion(model: Any, data: Any) -> str:
    """What the second opinion finds, in short."""
    try:
        found = second_opinion(model, data).findings
    except QuasistaticError as error:
        return f"none: {type(error).__name__}"
    words = list(dict.fromkeys(f"{f.body} {f.kind}" + size_words(f) for f in found))
    more = [f"and {len(words) - MOST_WORDS} more"] if len(words) > MOST_WORDS else []
    return "; ".join([*words[:MOST_WORDS], *more])


def size_words(finding: Finding) -> str:
    """How much, where it is a speed or a depth."""
    units = {"m": ("mm", 1e3), "m/s": ("mm/s", 1e3), "rad/s": ("rad/s", 1.0)}
    if finding.kind not in ("creeps", "penetrates"):
        return ""
    unit, size = units[finding.unit]
    return f" {size * finding.number:.3g} {unit}"


def census(path: Path, root: Path) -> Found | None:
    """What becomes of a file; None if it does not load or has no coordinates."""
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError:
        return None
    if not model.nv:
        return None
    found = Found(path.relative_to(root).as_posix(), model.nv)
    data = settled_state(model)
    mujoco.mj_forward(model, data)  # of the state after its last step
    found.contacts = int(data.ncon)
    found.fastest = float(np.abs(data.qvel).max())
    found.deepest = float(max((c.includemargin - c.dist for c in data.contact), default=0.0))
    forces = touches.forces(still(model, data), data)[:, 2]
    found.theirs = float(forces.sum())
    start = time.perf_counter()
    try:
        step, coordinates = mujoco_step(model, data, H)
        found.cone = step.cone
        answer = solve_step(step)
    except QuasistaticError as error:
        found.refused = f"{type(error).__name__}: {error}"
        return found
    found.seconds = time.perf_counter() - start
    found.kind = answer.certificate.kind
    found.off = imbalance(model, data, coordinates, answer)
    found.speed = float(np.abs(coordinates.T @ answer.delta_q).max() / H)
    kept = [touches.number(called) for called in step.contacts.name]
    found.theirs_left_out = found.theirs - float(forces[kept].sum())
    found.opinion = opinion(model, data)
    found.theirs_off = own_imbalance(model, data, step, coordinates.T)
    try:
        found.ours = float(answer.forces[:, 2].sum())
    except QuasistaticError:
        found.ours = float(answer.wrench[:, 2].sum())
        found.several = True
    return found


def agree(ours: float, theirs: float) -> bool:
    """Whether two sums of forces agree."""
    return abs(ours - theirs) <= AGREES * abs(theirs)


def differs(found: Found) -> str:
    """Why MuJoCo's normal forces are others, where they are."""
    if not found.rests or agree(found.ours, found.theirs):
        return ""
    if found.deepest > DEEP:
        return "deep"
    if agree(found.ours, found.theirs - found.theirs_left_out):
        return "left out"
    if found.theirs_off[0] <= AGREES:
        return "both balance"
    return "damping" if found.theirs_off[1] <= AGREES else "no balance"


def page(every: list[Found]) -> str:
    """The committed page."""
    answered = [f for f in every if not f.refused]
    rest = [f for f in answered if f.rests]
    rows = [
        (f.path, f.n_v, f.contacts, f.cone, f.kind or f.refused,
         f"{f.fastest:.1e}", f"{f.speed:.1e}", f"{1e3 * f.deepest:.3g}", f"{f.theirs:.4g}",
         f"{f.ours:.4g}{'*' * f.several}", f"{f.off:.0e}", f"{f.theirs_off[0]:.0e}",
         differs(f), f.opinion)
        for f in every
        if f.contacts or f.refused or f.opinion
    ]  # fmt: skip
    kinds = Counter(f.kind for f in answered)
    seconds = [f.seconds for f in answered]
    return PAGE.format(
        version=mujoco.__version__,
        packages=", ".join(PACKAGES),
        models=len(every),
        quiet=len(every) - len(rows),
        answered=len(answered),
        refused=len(every) - len(answered),
        rest=len(rest),
        kinds=", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())),
        agree=sum(not differs(f) for f in rest),
        deep=sum(differs(f) == "deep" for f in rest),
        middle=1e3 * float(np.median(seconds)),
        longest=max(seconds),
        balanced=sum(f.off <= BALANCED for f in answered),
        limit=BALANCED,
        found=sum(bool(f.opinion) for f in every),
        healthy=len(HEALTHY),
        ill=sum(bool(f.opinion) for f in every if f.path in HEALTHY) or "none",
        table="\n".join(markdown_table(HEAD, rows, 1)),
    )


def install(folder: Path) -> None:
    """Put the packages into a folder, if it is empty."""
    if not any(folder.iterdir()):
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target"]
        subprocess.run([*pip, str(folder), *PACKAGES], check=True)


def main() -> int:
    """Ask all models, write the page, and return the exit status."""
    options = script_options(__doc__, folder=Path, out=Path)
    with tempfile.TemporaryDirectory() as own, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # MuJoCo's, of what is deprecated
        folder = options.folder or Path(own)
        install(folder)
        all_of_them = (census(path, folder) for path in sorted(folder.rglob("*.xml")))
        every = [found for found in all_of_them if found is not None]
    show_page(page(every), options.out)
    refused = sum(bool(found.refused) for found in every)
    unbalanced = sum(found.off > BALANCED for found in every)
    ill = [found.path for found in every if found.path in HEALTHY and found.opinion]
    return int(refused > len(every) / 10 or unbalanced > 0 or bool(ill))


if __name__ == "__main__":
    sys.exit(main())

"""What proofs cost where bodies usually are: at rest, held by friction, sliding along an axis.

Run ``python -m validation.make.ordinary_states --out FILE`` (four minutes). There many numbers are
exactly zero. Cubes on a floor, each with four contacts, with and without torsion; many separate
cubes, pushed askew; stacks of five. ``--other`` FOLDER, another checkout, is measured in turn,
scene by scene, each in a process of its own. A scene's steps with and without a certificate take
turns, too. Processor time, so that other programs hardly matter.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.scenes.systems import body_text, system_of, world_plane
from quasistatic_ref.lab.study.measuring.environment import machine
from quasistatic_ref.simulate.simulator import Simulator
from validation.tools.scripts import asked, shown

SIDE, MASS, H = 0.04, 0.2, 0.02
"""Of a cube [m], [kg]; time step [s]."""
MU_V, MU_OMEGA = 0.5, 0.01
"""Friction [-], [m]."""
CUBE = body_text(MASS, (MASS * SIDE**2 / 6,) * 3, f'<box size="{SIDE} {SIDE} {SIDE}"/>')
PUSHES = {"rest": (0.0, 0.0), "sticks": (0.2, 0.0), "slides": (0.7, 0.0), "askew": (0.56, 0.42)}
"""Along x and y, as a share of the weight: friction holds half of it."""
BLOCK = 3
"""Steps after which the other simulator has its turn."""
TURNS = 20
"""Of each simulator, in all scenes as many: later steps may repeat the one before to the last bit,
and are proved in no time."""

FIRST = 5
"""First steps of new simulators."""

PLAIN = 4
"""Steps without `fast`, the first of which compiles the problem."""


class Scene(NamedTuple):
    """Stacks of cubes on a floor, far from each other.

    Parameters
    ----------
    stacks, height : int
    rows : int
        Of each contact.
    push : str
        Of each lowest cube, by its name.
    """

    stacks: int
    height: int
    rows: int
    push: str

    @property
    def name(self) -> str:
        """In words."""
        bodies = f"{self.stacks} cubes" if self.height == 1 else f"{self.stacks} stacks of five"
        return f"{bodies}, {self.rows} rows, {self.push}"


STATES = [Scene(n, 1, rows, push) for rows in (4, 6) for n in (1, 5, 25) for push in [*PUSHES][:3]]
MANY = [Scene(n, 1, 6, "askew") for n in (10, 40, 100, 200)]
STACKS = [Scene(n, 5, 6, "rest") for n in (8, 40)]
SCENES = STATES + MANY + STACKS


def simulator(scene: Scene, certify: str, *, fast: bool = True) -> Simulator:
    """Of a scene."""
    names = [f"cube{i}" for i in range(scene.stacks * scene.height)]
    starts = {
        name: {"xyz": (0.1 * (i // scene.height), 0.0, SIDE / 2 + SIDE * (i % scene.height))}
        for i, name in enumerate(names)
    }
    system = system_of(dict.fromkeys(names, CUBE), **starts)
    floor = world_plane()
    shapes = list(system.shapes)
    pairs = []
    for i, shape in enumerate(shapes):
        below = shapes[i - 1] if i % scene.height else floor
        name = f"{below.name}-{shape.name}"
        pairs.append(ContactPair(name, below, shape, MU_V, MU_OMEGA, scene.rows, 4))
    return Simulator(system, pairs, h=H, K_q=np.zeros((0, 0)), fast=fast, certify=certify)


def measured(scene: Scene) -> dict[str, float]:
    """Medians of its steps without and with a proof, the first with one, and a plain one [s].

    ``alone`` is a first step that is not compared with that of the plain path.
    """
    warm = simulator(Scene(1, 1, scene.rows, scene.push), "full")
    warm.step(warm.system.q_start, np.zeros(0))  # loads and checks the library
    both = {certify: simulator(scene, certify) for certify in ("off", "full")}
    force = np.zeros(both["off"].system.n_v)
    x, y = PUSHES[scene.push]
    force[0 :: 6 * scene.height] = x * MASS * 9.81
    force[1 :: 6 * scene.height] = y * MASS * 9.81
    first, alone = (first_step(scene, force, compared=compared) for compared in (False, True))
    q = {certify: one.system.q_start for certify, one in both.items()}
    times: dict[str, list[float]] = {"off": [], "full": []}
    for _ in range(TURNS):
        for certify, one in both.items():
            for _ in range(BLOCK):
                begin = time.process_time()
                q[certify] = one.step(q[certify], np.zeros(0), force).q
                times[certify].append(time.process_time() - begin)
    plain = []
    if scene in STATES:
        one = simulator(scene, "full", fast=False)
        for _ in range(PLAIN):
            begin = time.process_time()
            one.step(one.system.q_start, np.zeros(0), force)
            plain.append(time.process_time() - begin)
    off, full = (float(np.median(times[name][BLOCK:])) for name in ("off", "full"))
    least = min(plain, default=0.0)
    return {"off": off, "full": full, "first": first, "alone": alone, "plain": least}


def first_step(scene: Scene, force: np.ndarray, *, compared: bool) -> float:
    """Median of first steps with a proof [s]; `compared`, as if the plain path had agreed."""
    times = []
    for _ in range(FIRST):
        one: Any = simulator(scene, "full")
        one.compares &= not compared
        begin = time.process_time()
        one.step(one.system.q_start, np.zeros(0), force)
        times.append(time.process_time() - begin)
    return float(np.median(times))


def of_process(scene: Scene, folder: Path) -> dict[str, float]:
    """The same in a process of its own, with the package of a checkout."""
    command = [sys.executable, __file__, "--scene", str(SCENES.index(scene))]
    environment = os.environ | {"PYTHONPATH": str(folder), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE)
    times: dict[str, float] = json.loads(done.stdout)
    return times


def main() -> None:
    """Measure, and write the page; or one scene, as JSON."""
    options = asked(__doc__, scene=-1, other=Path, out=Path)
    if options.scene >= 0:
        print(json.dumps(measured(SCENES[options.scene])))
        return
    root = Path(__file__).parents[2]
    folders = [root] if options.other is None else [root, options.other.resolve()]
    m = machine()
    lines = [
        "# Steps of ordinary states",
        "",
        "Written by `python -m validation.make.ordinary_states` on "
        f"{m['processor']}, {m['cores']} cores, Python {m['python']}. Median processor time of a "
        "step with `fast` [ms], and of the first step with a proof; `alone`, without its check by "
        "the plain path. Cubes of 40 mm; friction holds half their weight: those that stick are "
        "pushed with a fifth of it, those that slide or are pushed askew with 0.7 of it. `ratio`: "
        "proved over uncertified. `before`: another checkout, in turn. `plain`: how many times "
        "longer a proved step takes without `fast`.",
        "",
    ]
    rows = []
    for scene in SCENES:
        every = [of_process(scene, folder) for folder in folders]
        now = every[0]
        cells = [now["off"], now["full"], now["first"], now["alone"]]
        row = [scene.name, *(f"{1e3 * t:.3f}" for t in cells)]
        row += [f"{now['full'] / now['off']:.1f}", f"{now['alone'] / now['full']:.1f}"]
        for other in every[1:]:
            row += [f"{1e3 * other[k]:.3f}" for k in ("off", "full")]
            row.append(f"{now['full'] / other['off']:.1f}")
        slower = now["plain"] / now["full"]
        row.append(f"{slower:.0f}" if slower else "")
        rows.append(row)
        print(*row, file=sys.stderr, flush=True)
    head = ["uncertified", "proved", "first", "alone", "ratio", "alone over proved"]
    before = ["uncertified before", "proved before", "proved over uncertified before"]
    heads = ["scene", *head, *(before if len(folders) > 1 else []), "plain"]
    shown("\n".join([*lines, *markdown_table(heads, rows)]), options.out)


if __name__ == "__main__":
    main()

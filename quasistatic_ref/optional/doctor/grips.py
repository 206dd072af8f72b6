"""Grips, contacts from opposite sides, and whether what they hold slips or turns away."""

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.numbers.arrays import Indices, Mask
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import centre, least
from quasistatic_ref.optional.doctor.task import Task
from quasistatic_ref.optional.doctor.telling import amount, length
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import SLIPPED

TURNED = 0.1
"""Turn of what a grip carries that counts as lost [rad]."""
TWISTED = 0.25
"""Torque of a weight about a grip, over the torsion that this bears, that may turn it away [-]."""


def lost(run: Run) -> Iterator[Finding]:
    """Grips along which what they hold slips by much, or in which what they carry turns."""
    task = Task(run)
    for table, pairs in task.tables.items():
        slips = {i: slip for i in pairs if (slip := task.accounts[i].slip) is not None}
        on = task.grips(pairs)
        if not (task.finished and slips and on.any()):
            continue
        ways = {i: float(slip[on].sum()) for i, slip in slips.items()}
        worst = max(ways, key=lambda i: ways[i] / least(run.pairs[i]))
        pair = run.pairs[worst]
        name = task.held(worst)
        way = ways[worst]
        slipped = way > SLIPPED * least(pair)
        k = int(np.where(on, slips[worst], 0.0).argmax() if slipped else on.argmax())
        contacts = task.contacts(pairs)
        pressed = float(run.at(k).forces[contacts, 2].sum())
        bears = pair.mu_v * pressed
        torsion = pair.mu_omega * pressed if pair.rows == 6 else 0.0
        body = name.partition("/")[0]
        weight = run.system.mass(body) * run.g
        arm = _arm(run, body, contacts, k)
        torque = weight * arm
        turn = _turn(task, worst, on)
        turns = turn > TURNED and torque > TWISTED * torsion and weight < bears
        if turns and (slipped or _carries(task, table, body, k)):
            rows = " (rows = 6)" if pair.rows == 4 else ""
            limit = f"mu_omega bears {torsion:.3g} N m"
            if torque < torsion:
                limit = f"of the {torsion:.3g} N m that mu_omega bears the weight leaves too little"
            yield Finding(
                "lost grip",
                True,
                f"raise mu_omega of contacts.{table}{rows}, or hold {name} nearer to its centre of "
                "mass",
                f"{name} turns by {amount(turn, 'rad')} in {task.holder(worst)} and slips by "
                f"{length(way)}: its weight, {length(arm)} beside the grip, asks for {torque:.3g} "
                f"N m of torsion, and {limit}, at {run['t'][k]:.2f} s",
                {"turn_rad": turn, "slip_mm": 1e3 * way, "torque_Nm": torque, "step": k},
            )
        elif slipped:
            more = ", and more than its weight pulls at it" if weight < bears else ""
            yield Finding(
                "lost grip",
                True,
                f"raise mu_v of contacts.{table}, or K_q of what closes it or how far it closes",
                f"{name} slips by {length(way)} along {task.holder(worst)}; at {run['t'][k]:.2f} s "
                f"the grip presses with {pressed:.3g} N in all, its friction bears {bears:.3g} N, "
                f"and {name} weighs {weight:.3g} N{more}",
                {"slip_mm": 1e3 * way, "bears_N": bears, "weight_N": weight, "step": k},
            )


def _turn(task: Task, i: int, on: Mask) -> float:
    """How far what a pair holds turns in what holds it, while a grip is on [rad]."""
    pair = task.run.pairs[i]
    ends = on.nonzero()[0][[0, -1]] + [0, 1]
    R = [task.run.system.kinematics(task.run["q"][k]).R for k in ends]
    seen = [of[pair.alpha.link].T @ of[pair.beta.link] for of in R]
    return float(Rotation.from_matrix(seen[1] @ seen[0].T).magnitude())


def _arm(run: Run, name: str, contacts: Indices, k: int) -> float:
    """Lever arm of a free body's weight about the normal of a grip in step k [m]; else 0."""
    pressing = contacts[run["wrench"][k, contacts, 2] > 0]
    if name not in run.free_bases or not run.g or not pressing.size:
        return 0.0
    away = centre(run.system, run.system.kinematics(run["q"][k]), name)
    away = away - run["beta"][k, pressing].mean(axis=0)
    return abs(float(np.cross(run.gravity / run.g, run["n"][k, pressing[0]]) @ away))


def _carries(task: Task, table: str, name: str, k: int) -> bool:
    """Whether nothing but a table touches a body in step k."""
    others = [i for i, account in enumerate(task.accounts) if account.table != table]
    return not any(
        task.accounts[i].touches[k] and name in task.run.bodies(task.run.pairs[i]) for i in others
    )

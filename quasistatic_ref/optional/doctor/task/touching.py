"""Whether what is actuated touches what it is to act on."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import least
from quasistatic_ref.optional.doctor.frame.tolerances import SLIPPED
from quasistatic_ref.optional.doctor.start.placed import inside
from quasistatic_ref.optional.doctor.texts import finding, length
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import FILLED


def finished(run: Run) -> bool:
    """Whether the run reaches the last of its waypoints."""
    times = [float(track.times[-1]) for track in run.tracks]
    return bool(times) and run.complete and max(times) <= (run.steps + 0.5) * run.h


def acting(run: Run) -> dict[str, list[int]]:
    """The pairs by which a driven body acts on a free one, by contact table."""
    by_table: dict[str, list[int]] = {}
    for i, pair in enumerate(run.pairs):
        links = [pair.alpha.link, pair.beta.link]
        if run.driven[links].any() and run.free[links].any():
            by_table.setdefault(pair.name.partition("(")[0], []).append(i)
    return by_table


def borne(run: Run, table: str) -> bool:
    """Whether any pair of a contact table touched, also pairs of bodies that stand."""
    names = [pair.name.partition("(")[0] for pair in run.pairs]
    return table in np.array(names)[run.touched]


def idle(run: Run) -> Iterator[Finding]:
    """Tables by which something driven was to act on something free, and never did.

    A finger that never touches what others do is named where its own joint leads it away.
    """
    tables = acting(run) if finished(run) else {}
    every = {i: table for table, pairs in tables.items() for i in pairs if run.touched[i]}
    acted = {(run.held_by(i)[0], table) for i, table in every.items()}
    for table, pairs in tables.items():
        held, _ = run.held_by(pairs[0])
        elsewhere = any(name == held and other != table for name, other in acted)
        if elsewhere or (borne(run, table) and not run.touched[pairs].any()):
            continue
        fingers: dict[str, list[int]] = {}
        for i in pairs:
            fingers.setdefault(run.held_by(i)[1], []).append(i)
        idle = {name: of for name, of in fingers.items() if not run.touched[of].any()}
        astray = {name: led for name, of in idle.items() if (led := _astray(run, of))}
        for name, (joint, way) in astray.items():
            why = f"{joint.name} leads {name} away from {held}, by {length(way)}, and no pair of "
            why += f"contacts.{table} that {name} is in ever touches"
            remedy = f"check the axis of {joint.name}, or the sign of its targets"
            yield finding("idle-contacts", why, remedy, away_mm=1e3 * way)
        if astray or len(idle) < len(fingers):
            continue
        i = min(pairs, key=lambda i: float(run.nearest[:, i].min()))
        k = int(run.nearest[:, i].argmin())
        near = float(run.nearest[k, i])
        apart = "none comes near enough to have a distance"
        numbers: dict[str, float] = {}
        if near < FILLED:
            apart = f"the nearest, {run.pairs[i].name}, is {length(near)} apart at "
            apart += f"{run['t'][k]:.2f} s"
            numbers = {"least_distance_mm": 1e3 * near, "step": k}
        why = f"no pair of contacts.{table} ever touches; {apart}"
        remedy = "check where {} stands and how far {} moves".format(*run.held_by(i))
        yield finding("idle-contacts", why, remedy, **numbers)


def _astray(run: Run, pairs: list[int]) -> tuple[Joint, float] | None:
    """The one joint that leads a finger away from its object, and how far [m]; or None.

    A finger that starts in what is hollow may open from within.
    """
    i = min(pairs, key=lambda i: float(run.nearest[0, i]))
    phi = run.nearest[:, i]
    pair, at = run.slices[i]
    away = float(run.gap[-1, at].min() - phi[0])
    link = pair.alpha.link if run.driven[pair.alpha.link] else pair.beta.link
    joints = [joint for joint in run.actuated if run.moves[link, joint.v].any()]
    leads = len(joints) == 1 and len(joints[0].coordinates) == 1 and phi.max() < FILLED
    if not leads or phi.min() < phi[0] / 2 or away <= SLIPPED * least(pair) or any(inside(run)):
        return None
    return joints[0], away

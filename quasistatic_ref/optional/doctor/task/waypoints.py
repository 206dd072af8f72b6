"""Whether what is actuated went where its waypoints lead it."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.frame.run import Run, in_world
from quasistatic_ref.optional.doctor.frame.start import least
from quasistatic_ref.optional.doctor.frame.tolerances import NEAR, SUNK
from quasistatic_ref.optional.doctor.grips import closed
from quasistatic_ref.optional.doctor.task.touching import acting, borne, finished
from quasistatic_ref.optional.doctor.texts import amount, finding
from quasistatic_ref.quoting import listed
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.standard_form import frame_jacobian

LAGS: Final = 0.1
"""Distance of a joint from its last target, over the way that its target went [-], that is more
than a spring's usual lag."""

STALLED: Final = 0.25
"""Distance of a joint from its last target over the shape that presses [-], of what is to push."""

PRESSES = 1e-3
"""Normal force of what presses, over the largest of the run [-]."""
HELD = 1e-12
"""What interpolation between equal waypoints leaves [m, rad, -]."""
TRIAL = 50
"""Steps of a run that may be a trial."""
LONG = 10.0
"""Time of a first waypoint over that of a run that does not come to it [-]."""


def first_ways(run: Run) -> dict[str, float]:
    """When the first waypoint of each joint is that is not where its track starts [s]."""
    moved = {x.joint.name: (x.values != x.values[0]).any(axis=1) for x in run.tracks}
    times = {track.joint.name: track.times for track in run.tracks}
    return {name: float(times[name][of.argmax()]) for name, of in moved.items() if of.any()}


def late(run: Run) -> Iterator[Finding]:
    """A run that ends long before the first waypoint of joints that have not moved by then.

    Who tries a scene takes its first steps alone: that is none.
    """
    end = run.steps * run.h
    joint, first = min(first_ways(run).items(), key=lambda way: way[1], default=("", 0.0))
    still = np.ptp(run["q_bar_a"], axis=0).max(initial=0.0) < NEAR
    if run.complete and still and run.steps >= TRIAL and first >= LONG * end:
        cause = f"the run ends at {end:.4g} s ({run.steps} steps of {run.h:g} s), before the first "
        cause += f"waypoint of {joint}, at {first:.4g} s"
        remedy = "raise steps or h, or check the times of waypoints, which are in seconds"
        yield finding("late-waypoints", cause, remedy, end_s=end, waypoint_s=first)


def still(run: Run) -> Iterator[Finding]:
    """Actuated joints that never reach what they are paired with, and have no target to go to.

    A scene of MuJoCo holds no targets, and may be run without any, to see how it stands.
    """
    n = run.system.n_q_a
    tables = [*acting(run)] if run.complete else []
    away = np.abs(run["q_bar_a"] - run["q"][0, :n]).max(initial=0.0)
    if not tables or away > HELD or first_ways(run) or any(borne(run, x) for x in tables):
        return
    bodies = sorted({joint.name.partition("/")[0] for joint in run.actuated})
    of_mjcf = run.system.of_mjcf
    remedy = f"add targets, {'--targets' if of_mjcf else f'[[bodies.{bodies[0]}.targets]]'}"
    why = f"all targets are where {listed(bodies)} starts, so that nothing is driven, and no pair "
    why += f"of {tables[0]} ever touches"
    yield finding("no-motion", why, remedy, listed(bodies), not of_mjcf, steps=run.steps)


def short(run: Run) -> Iterator[Finding]:
    """Joints and sprung bases that end far from their targets; only a note if they press.

    What contacts stop is where it is to be, unless it was to push what has not moved.
    """
    if not finished(run):
        return
    lag = run.system.actuated_difference(run["q"][-1], run["q_bar_a"][-1])
    springs = run.simulator.K_q @ lag
    for track in run.tracks:
        joint = track.joint
        scalar = len(joint.coordinates) == 1
        n = 1 if scalar else joint.lengths
        v = slice(joint.v.start, joint.v.start + n)
        way = float(np.linalg.norm(np.ptp(track.values[:, :n], axis=0)))
        error = float(np.linalg.norm(lag[v]))
        if not n or not way or error <= LAGS * way:
            continue
        spring = float(np.linalg.norm(springs[v]))
        along = lag[v] / error
        unit = joint.coordinates[0].unit
        if scalar:
            contacts = run.step(run.steps - 1).contacts
            J_n = frame_jacobian(contacts, contacts.J)[0][:, v]
            pushes = -run["wrench"][-1, :, 2] * (J_n @ along)
            stops = bool(pushes.sum() > spring / 2)
            if stops and unit == "m":
                stops = not _stalled(run, int(np.abs(pushes).argmax()), error)
        else:
            stops = -_load(run, joint, along, way) < spring / 2
        if not stops:
            presses = _presses(run, joint)
            K_q = spring / (LAGS * way)
            force = f"{spring:.3g} {'N' if unit == 'm' else 'N m'}"
            force = f" and presses with {force}" if presses else f", with {force} on its spring"
            cause = f"{joint.name} ends {amount(error, unit)} from its last target{force}"
            remedy = "" if presses else f"raise K_q of {joint.name} to {K_q:.3g} or more"
            numbers: dict[str, float] = {f"error_{unit}": error, "K_q": K_q}
            yield finding("far-from-target", cause, remedy, joint.name, not presses, **numbers)


def _load(run: Run, base: Joint, along: Array, way: float) -> float:
    """The load along a unit vector on a base, and on what has come along by half of its way [N]."""
    n = len(along)
    tau = run.noted("tau")[-1]
    load = tau[base.v][:n] @ along
    if n == 3:  # a floating base has its own axes
        along = in_world(run["q"][-1:, base.q][:, 3:], along[None])[0]
    for free in run.free_bases.values():
        q = run["q"][:, free.q]
        if (q[-1] - q[0])[:n] @ along > way / 2:
            load += in_world(q[-2:-1, 3:], tau[None, free.v][:, :3])[0, :n] @ along
    return float(load)


def _stalled(run: Run, contact: int, error: float) -> bool:
    """Whether a pushed body stays in place although the target lies far inside of it."""
    pair = run.pairs[run.pair_of[contact]]
    link = next((x.link for x in (pair.alpha, pair.beta) if run.free[x.link]), None)
    if link is None or error <= STALLED * least(pair):
        return False
    name = run.body(link)
    on = run.of_body(name) & run.touches[-1]
    start, end = (run.system.kinematics(run["q"][k]).t[link] for k in (0, -1))
    moved = np.linalg.norm(end - start) > SUNK * least(pair)
    return not moved and not closed(run.signs(name)[on, None] * run["n"][-1, on])


def _presses(run: Run, joint: Joint) -> bool:
    """Whether a joint ends pressing on what it moves against, or on a stop of its own."""
    stops = np.flatnonzero(run.rows.A[:, joint.v.start])
    if stops.size and (run["lam_extra"][-1, stops] > 0).any():
        return True
    moved: Mask = np.asarray(run.moves[:, joint.v].any(axis=1), dtype=np.bool_)
    on = np.array([moved[p.alpha.link] != moved[p.beta.link] for p in run.pairs], dtype=bool)
    f_n = run["wrench"][..., 2]
    return bool((f_n[-1, on[run.pair_of]] > PRESSES * f_n.max(initial=0.0)).any())

"""Whether a run did what its scene was made for: waypoints, and what is to touch."""

from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations
from typing import Final

import numpy as np

from quasistatic_ref.contact.distance import in_world, pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.measures import side
from quasistatic_ref.optional.doctor.placed import inside
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import joining, least
from quasistatic_ref.optional.doctor.telling import amount, length, rounded
from quasistatic_ref.optional.doctor.tolerances import NEAR, SLIPPED, SUNK
from quasistatic_ref.optional.doctor.undecided import Undecided
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud, Shape
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.text.quoting import listed
from quasistatic_ref.tolerances import FILLED

LAGS: Final = 0.1
"""Distance of a joint from its last target, over the way that its target went [-], that is none of
a spring's usual lag."""

STALLED: Final = 0.25
"""Distance of a joint from its last target over the shape that presses [-], of what is to push."""

OPPOSITE = -0.5
"""Cosine of two normals that grip [-]."""
PRESSES = 1e-3
"""Normal force of what presses, over the largest of the run [-]."""
HELD = 1e-12
"""What interpolation between equal waypoints leaves [m, rad, -]."""
TRIAL = 50
"""Steps of a run that may be a trial."""
LONG = 10.0
"""Time of a first waypoint over that of a run that does not come to it [-]."""
LOOKED = 8
"""Steps, spread over a run, in which bodies are looked for that pass through each other."""
MOST = 300
"""Pairs of shapes that are looked at."""


def finished(run: Run) -> bool:
    """Whether the run reaches the last of its waypoints."""
    times = [float(track.times[-1]) for track in run.tracks]
    return bool(times) and max(times) <= (run.steps + 0.5) * run.h


def acting(run: Run) -> dict[str, list[int]]:
    """The pairs by which a driven body acts on a free one, by contact table."""
    by_table: dict[str, list[int]] = {}
    for i, pair in enumerate(run.pairs):
        links = [pair.alpha.link, pair.beta.link]
        if run.driven[links].any() and run.free[links].any():
            by_table.setdefault(run.pair_measures[i].table, []).append(i)
    return by_table


def touched(run: Run, pairs: list[int]) -> bool:
    """Whether one of some pairs ever touched."""
    return any(run.pair_measures[i].touches.any() for i in pairs)


def borne(run: Run, table: str) -> bool:
    """Whether any pair of a contact table touched, also pairs of bodies that stand."""
    return any(pair.table == table and pair.touches.any() for pair in run.pair_measures)


def first_ways(run: Run) -> dict[str, float]:
    """When the first waypoint of each joint is that is not where its track starts [s]."""
    ways = {}
    for track in run.tracks:
        moved = (track.values != track.values[0]).any(axis=1)
        if moved.any():
            ways[track.joint.name] = float(track.times[moved.argmax()])
    return ways


def late(run: Run) -> Iterator[Finding]:
    """A run that ends long before the first waypoint of joints that have not moved by then.

    Who tries a scene takes its first steps alone: that is none.
    """
    end = run.steps * run.h
    ways = {t.joint.name: np.ptp(run["q_bar_a"][:, t.joint.q], axis=0).max() for t in run.tracks}
    first = {name: time for name, time in first_ways(run).items() if ways[name] < NEAR}
    moving = len(first) < len(first_ways(run))
    if not first or moving or run.steps < TRIAL or min(first.values()) < LONG * end:
        return
    joint = min(first, key=first.__getitem__)
    yield Finding(
        "late-waypoints",
        True,
        "raise steps or h, or check the times of waypoints, which are in seconds",
        f"the run ends at {end:.4g} s ({run.steps} steps of {run.h:g} s), before the "
        f"first waypoint of {joint}, at {first[joint]:.4g} s",
        {"end_s": end, "waypoint_s": first[joint]},
    )


def still(run: Run) -> Iterator[Finding]:
    """Actuated joints that never reach what they are paired with, and have no target to go to.

    A scene of MuJoCo holds no targets, and may be run without any, to see how it stands.
    """
    n = run.system.n_q_a
    tables = acting(run)
    touches = any(borne(run, table) for table in tables)
    if not n or first_ways(run) or not tables or touches:
        return
    if np.abs(run["q_bar_a"] - run["q"][0, :n]).max() <= HELD:
        bodies = sorted({j.name.partition("/")[0] for j in run.system.joints if j.actuated})
        where = "--targets" if run.system.of_mjcf else f"[[bodies.{bodies[0]}.targets]]"
        yield Finding(
            "no-motion",
            not run.system.of_mjcf,
            f"add targets, {where}",
            f"all targets are where {listed(bodies)} starts, so that nothing is driven, and no "
            f"pair of {next(iter(tables))} ever touches",
            {"steps": run.steps},
            listed(bodies),
        )


def through(run: Run) -> Iterator[Finding | Undecided]:
    """Bodies that come to be in each other and share no table: of each two the deepest."""
    system = run.system
    shapes = {s.name: s for s in (*system.shapes, *run.sides)}
    joined = {frozenset((_who(p.alpha), _who(p.beta))) for p in run.pairs}
    apart: list[ContactPair] = []
    for a, b in combinations(shapes.values(), 2):
        links = [a.link, b.link]
        one, other = map(run.body, links)
        moved = (run.driven | run.free)[links].any()
        if one != other and moved and frozenset((_who(a), _who(b))) not in joined:
            if len(apart) == MOST:
                yield Undecided("bodies that share no table", f"more than {MOST} pairs of shapes")
                return
            with suppress(ContactError):  # two clouds, or two half-spaces
                apart.append(ContactPair(f"{a.name}, {b.name}", a, b, 0.0, 0.0, 4, 1, hull=True))
    if not apart:
        return
    steps = np.unique(np.linspace(0, run.steps, 1 + LOOKED).round().astype(int)).tolist()
    radii = {name: _radius(placed.shape) for name, placed in shapes.items()}
    depths = np.array([_depths(run, k, apart, radii) for k in steps])
    sizes = np.array([least(pair) for pair in apart])
    deepest: dict[frozenset[str], Finding] = {}
    for i, j in np.argwhere((depths[0] <= 0) & (depths > SUNK * sizes)).tolist():
        depth = float(depths[i, j])
        names = [side(system, shape) for shape in (apart[j].alpha, apart[j].beta)]
        key = frozenset(name.partition("/")[0] for name in names)
        if key not in deepest or deepest[key].numbers["depth_mm"] < 1e3 * depth:
            deepest[key] = Finding(
                "passes-through",
                True,
                joining(run, listed(names)) + ", or keep them apart",
                f"nothing lets {listed(names)} touch, and they pass through each other, "
                f"{length(depth)} deep "
                f"at {steps[i] * run.h:.2f} s",
                {"depth_mm": 1e3 * depth, "step": steps[i] - 1},
            )
    yield from deepest.values()


def _who(placed: PlacedShape) -> str | int:
    """What a table joins: a link, or a shape of the world."""
    return placed.link or placed.name


def _depths(run: Run, k: int, pairs: list[ContactPair], radii: dict[str, float]) -> list[float]:
    """How deep each of some pairs is where step k starts [m]; NaN where that is not known."""
    at = run.system.kinematics(run["q"][k])
    depths = []
    for pair in pairs:
        depth = np.nan
        alpha, beta = in_world(pair, at.R, at.t)
        if np.linalg.norm(alpha.t - beta.t) > radii[pair.alpha.name] + radii[pair.beta.name]:
            depths.append(-np.inf)
            continue
        with suppress(ContactError):  # of bodies so deep that no normal is known
            depth = -float(pair_closest_points(pair, at.R, at.t).phi[0])
        depths.append(depth)
    return depths


def _radius(shape: Shape | PointCloud) -> float:
    """Radius of the smallest ball about the shape's origin that contains the shape [m]."""
    if isinstance(shape, PointCloud):
        return float(np.linalg.norm(shape.points, axis=1).max())
    if not np.isfinite(shape.extent):
        return np.inf
    axes = np.vstack([np.eye(3), -np.eye(3)])
    return float(np.linalg.norm(shape.support_value(axes).reshape(2, 3).max(axis=0)))


def idle(run: Run) -> Iterator[Finding]:
    """Tables by which something driven was to act on something free, and never did.

    A finger that never touches what others do is named where its own joint leads it away.
    """
    if not finished(run):
        return
    tables = acting(run)
    for table, pairs in tables.items():
        held, _ = run.held_by(pairs[0])
        if not touched(run, pairs) and borne(run, table):
            continue
        others = [each for other, each in tables.items() if other != table]
        if any(touched(run, each) and run.held_by(each[0])[0] == held for each in others):
            continue
        fingers: dict[str, list[int]] = {}
        for i in pairs:
            fingers.setdefault(run.held_by(i)[1], []).append(i)
        idle = {name: touch for name, touch in fingers.items() if not touched(run, touch)}
        named = False
        hollow = any(inside(run))  # fingers may open from within
        for name, touch in idle.items():
            touching = [i for i in pairs if run.held_by(i)[1] not in idle]
            astray = None if hollow else _astray(run, touch, touching)
            if astray is None:
                continue
            joint, way = astray
            named = True
            yield Finding(
                "idle-contacts",
                True,
                f"check the axis of {joint.name}, or the sign of its targets",
                f"{joint.name} leads {name} away from {run.held_by(touch[0])[0]}, by "
                f"{length(way)}, and no "
                f"pair of contacts.{table} that {name} is in ever touches",
                {"away_mm": 1e3 * way},
            )
        if named or len(idle) < len(fingers):
            continue
        i = min(pairs, key=lambda i: float(run.pair_measures[i].phi.min()))
        near = run.pair_measures[i]
        k = int(near.phi.argmin())
        apart = "none comes near enough to have a distance"
        numbers: dict[str, float] = {}
        if near.phi[k] < FILLED:
            apart = (
                f"the nearest, {near.name}, is {length(near.phi[k])} apart at {run['t'][k]:.2f} s"
            )
            numbers = {"least_distance_mm": 1e3 * float(near.phi[k]), "step": k}
        yield Finding(
            "idle-contacts",
            True,
            "check where {} stands and how far {} moves".format(*run.held_by(i)),
            f"no pair of contacts.{table} ever touches; {apart}",
            numbers,
        )


def _astray(run: Run, pairs: list[int], others: list[int]) -> tuple[Joint, float] | None:
    """The joint that leads a finger away from its object, and how far [m]; or None.

    Joints that move the fingers of `others` as well are those of an arm.
    """
    i = min(pairs, key=lambda i: float(run.pair_measures[i].phi[0]))
    phi = run.pair_measures[i].phi
    if phi[0] >= FILLED or phi.min() < phi[0] / 2:
        return None
    at = np.flatnonzero(run.pair_of == i)
    contact = at[run["phi"][0, at].argmin()]
    contacts = run.at(0).contacts
    ways = run.system.actuated_difference(run.q_start, run["q_bar_a"][-1])
    J_n = np.asarray(frame_jacobian(contacts, contacts.J)[0])
    opens = J_n[contact, : run.system.n_a] * ways
    links = [side.link for j in others for side in (run.pairs[j].alpha, run.pairs[j].beta)]
    arms = np.asarray(run.moves[links].any(axis=0))
    joints = [
        joint
        for joint in run.system.joints
        if joint.actuated and joint.v.stop == joint.v.start + 1 and not arms[joint.v.start]
    ]
    if not joints:
        return None
    joint = max(joints, key=lambda joint: float(opens[joint.v.start]))
    way = float(opens[joint.v.start])
    return (joint, way) if way > SLIPPED * least(run.pairs[i]) else None


def short(run: Run) -> Iterator[Finding]:
    """Joints and sprung bases that end far from their targets: a note of those that press.

    What a base carries, which has come along by half of its way, does not stop it.
    """
    if not finished(run):
        return
    lag = run.system.actuated_difference(run["q"][-1], run["q_bar_a"][-1])
    for track in run.tracks:
        joint = track.joint
        scalar = joint.v.stop == joint.v.start + 1
        if not (scalar or joint.lengths > 1):
            continue
        n = 1 if scalar else joint.lengths
        v = slice(joint.v.start, joint.v.start + n)
        way = float(np.linalg.norm(np.ptp(track.values[:, :n], axis=0)))
        error = float(np.linalg.norm(lag[v]))
        if not way or error <= LAGS * way:
            continue
        spring = float(np.linalg.norm((run.simulator.K_q @ lag)[v]))
        at = run.at(run.steps - 1)
        J_n = frame_jacobian(at.contacts, at.contacts.J)[0][:, v]
        pushes = run["wrench"][-1, :, 2] * (J_n @ lag[v]) / error  # of each contact along the way
        if not scalar:
            pushes = _stopping(run, joint, lag[v] / error, way, pushes)
        unit = joint.coordinates[0].unit
        if -pushes.sum() > spring / 2 and not (
            scalar and _stalled(run, int(np.abs(pushes).argmax()), error, unit)
        ):
            continue
        presses = _presses(run, joint)
        force = f"{spring:.3g} {'N' if unit == 'm' else 'N m'}"
        ends = f"{joint.name} ends {amount(error, unit)} from its last target"
        needed = rounded(spring / (LAGS * way), np.ceil)
        yield Finding(
            "far-from-target",
            not presses,
            "" if presses else f"raise K_q of {joint.name} to {needed:.3g} or more",
            f"{ends} and presses with {force}"
            if presses
            else f"{ends}, with {force} on its spring",
            {f"error_{unit}": error, "K_q": needed},
            joint.name,
        )


def _stopping(run: Run, base: Joint, along: Array, way: float, pushes: Array) -> Array:
    """What contacts exert on a base along its error, a unit vector of x, y, z, (n_c,) [N].

    What it carries, which has come along by half of its way, does not stop it: only what presses
    against that does, such as the wall to which a finger has pushed a box, or a palm on springs.
    """
    k = run.steps - 1
    at = run.at(k)
    moved = np.asarray(run.moves[:, base.v].any(axis=1))
    start, end = (run.system.kinematics(run["q"][j]).t[:, : len(along)] for j in (0, -1))
    carried = ((end - start) @ along > way / 2) & ~moved & ~run.driven
    links = np.array([[pair.alpha.link, pair.beta.link] for pair in run.pairs], dtype=int)
    alpha, beta = links.reshape(-1, 2)[run.pair_of].T
    c = at.contacts
    f = run["wrench"][-1]
    on_beta = f[:, :1] * c.d1 + f[:, 1:2] * c.d2 + f[:, 2:3] * c.n
    sign = np.where(carried[beta], 1.0, -1.0)
    outside = (carried[alpha] != carried[beta]) & ~(moved[alpha] | moved[beta])
    against = np.where(outside, sign * (on_beta[:, : len(along)] @ along), 0.0)
    return np.where((carried | moved)[alpha] & (carried | moved)[beta], 0.0, pushes) + against


def _stalled(run: Run, contact: int, error: float, unit: str) -> bool:
    """Whether a pushed body stays in place although the target lies far inside of it."""
    i = int(run.pair_of[contact])
    pair = run.pairs[i]
    table = acting(run).get(run.pair_measures[i].table)
    if not table or unit != "m" or error <= STALLED * least(pair) or _grips_at_the_end(run, table):
        return False
    link = pair.alpha.link if run.free[pair.alpha.link] else pair.beta.link
    start, end = (run.system.kinematics(run["q"][k]).t[link] for k in (0, -1))
    return float(np.linalg.norm(end - start)) < SUNK * least(pair)


def _grips_at_the_end(run: Run, pairs: list[int]) -> bool:
    """Whether two contacts of some pairs that touch in the last step face each other."""
    touching = [i for i in pairs if run.pair_measures[i].touches[-1]]
    n = run["n"][-1]
    n = np.where(run.free[run.simulator.layout.link_alpha][:, None], -n, n)
    n = n[np.isin(run.pair_of, touching)]
    return bool((n @ n.T).min(initial=0.0) < OPPOSITE)


def _presses(run: Run, joint: Joint) -> bool:
    """Whether a joint ends pressing on what it moves against, or on a stop of its own."""
    A = run.rows.A
    if len(A) and A[run["lam_extra"][-1, : len(A)] > 0, joint.v.start].any():
        return True
    moved: Mask = np.asarray(run.moves[:, joint.v].any(axis=1), dtype=np.bool_)
    sides = [(pair.alpha.link, pair.beta.link) for pair in run.pairs]
    on = np.array([bool(moved[a]) != bool(moved[b]) for a, b in sides])
    f_n = run["wrench"][-1, :, 2]
    return bool((f_n[on[run.pair_of]] > PRESSES * run["wrench"][..., 2].max()).any())

"""Bodies that nothing bears or holds, bodies that fall, and how far they do until they touch."""

from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.did.artifacts import LIGHT
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import SHORT, Start, joining
from quasistatic_ref.optional.doctor.frame.tolerances import NEAR, SUNK
from quasistatic_ref.optional.doctor.texts import distance, finding
from quasistatic_ref.quoting import listed
from quasistatic_ref.simulate.finding import Finding

ROUNDS = 100
"""Advances until a falling body touches; corners take one, round surfaces some ten."""
CLOSE = 1e-9
"""Up to this a gap counts as zero [m]."""
LEVEL = 1e-9
"""Cosine between a fall and a normal up to which the fall goes past a surface [-]."""


def unsupported(start: Start) -> Iterator[Finding]:
    """Free bodies with mass that no contact pair can bear."""
    joint = "pair of geoms" if start.system.of_mjcf else "table"
    for name in sorted(alone(start)) if start.g else ():
        if not sinks(start, name):
            continue
        touches = any(start.bodies(pair) != {name} for pair, _ in start.pairs_of.get(name, ()))
        weight = start.system.mass(name) * start.g
        cause = f"no {joint} joins {name}, which weighs {weight:.3g} N, to anything"
        cause += f"{' but to bodies that fall as well' * touches}: it falls"
        yield finding("unsupported-body", cause, _joining(start, name), weight_N=weight)


def _joining(start: Start, name: str) -> str:
    return joining(start, f"{name} and what should bear it")


def alone(start: Start) -> set[str]:
    """Free bodies that no chain of contact tables, welds or tendons joins to what stands."""
    left = {*start.free_bases}
    joined = [start.bodies(pair) for pair in start.pairs]
    while left:
        borne = {name for pair in joined if pair - left for name in pair & left}
        borne = borne or held(start, left)
        if not borne:
            break
        left -= borne
    return left


def in_the_air(start: Start) -> Iterator[Finding]:
    """A body that touches nothing at the start, and its height over what should bear it."""
    near = start.points.phi <= np.maximum(NEAR, SUNK * start.sizes)
    loose = [name for name in start.free_bases if name in start.pairs_of and start.g]
    loose = [name for name in loose if not near[start.of_body(name)].any()]
    holds = held(start, loose)
    for name in loose:
        if name in holds or not sinks(start, name):
            continue
        falls = [(fall(start, pair, name), pair.name) for pair, _ in start.pairs_of[name]]
        gap, pair = min(falls)
        if gap <= NEAR:  # MuJoCo, which alone says what touches, has missed it
            continue
        if np.isfinite(gap):
            height = distance(gap, 4)
            cause = f"{name} starts in the air, {height} above what may bear it ({pair})"
            remedy = f"lower {name} by {height}, or check its origin"
            yield finding("starts-in-the-air", cause, remedy, gap_mm=1e3 * gap)
        else:
            past = listed(sorted({pair for _, pair in falls}))
            cause = f"nothing that may touch {name} is below it: it falls past {past}"
            yield finding("unsupported-body", cause, _joining(start, name), pairs=len(falls))


def fall(start: Start, pair: ContactPair, name: str) -> float:
    """How far a body falls along gravity until a pair bears it [m]; infinity if none does.

    Of convex bodies the gap along their normal shrinks by as much as they come nearer along it, and
    they do not touch before it is closed: they are moved by that, and have a new normal, until they
    touch or the normal no longer faces the fall. Of a cloud the first of its points counts. With a
    margin they bear at that distance.

    Raises
    ------
    ContactError
        If the pair has no trustworthy normal on the way.
    """
    falls = start.body(pair.beta.link) == name
    link, sign = (pair.beta.link, -1.0) if falls else (pair.alpha.link, 1.0)
    every = replace(pair, k=pair.candidates if pair.has_cloud else 1)
    t = start.kinematics.t.copy()
    margin = start.system.margins.get(pair.name, 0.0)
    far = 0.0
    for _ in range(ROUNDS):
        near = pair_closest_points(every, start.kinematics.R, t)
        gaps = near.phi - margin
        if gaps.min() <= CLOSE:
            break
        nearer = sign * (near.n @ start.down)
        meets = nearer > LEVEL
        step = float((gaps[meets] / nearer[meets]).min(initial=np.inf))
        if not meets.any():
            return np.inf
        t[link] += step * start.down
        far += step
    return far


def sinks(start: Start, name: str) -> bool:
    """Whether the loads of a free body pull it down at the start, by 1e-3 of its weight or more.

    Others than gravity may bear it.
    """
    least = LIGHT * start.system.mass(name) * start.g
    return bool(start.load_at_start @ _sinking(start, name) > least)


def _sinking(start: Start, name: str) -> Array:
    """The motion of a free body by 1 m along gravity at the start, shape (n_v,) [m, rad]."""
    base = start.free_bases[name]
    columns = slice(base.v.start, base.v.start + base.lengths)
    motion = np.zeros(start.system.n_v)
    J = start.kinematics.J_of([start.system.link(name)])[0, :3]
    motion[columns] = start.down @ J[:, columns]
    return motion


def held(start: Start, loose: Collection[str]) -> set[str]:
    """The free bodies among `loose` that rows of an extension hold, such as taut tendons.

    A body is held if it cannot sink by NEAR: not even while other bodies that are `loose`, and
    links on sliding joints without an actuator, are shifted along with it. Then a chain of rows
    joins it to the world, to what is actuated, or to a body that lies on something.

    Parameters
    ----------
    start : Start
    loose : collection of str
        Free bodies that no contact bears.
    """
    if not len(start.rows.A) or not start.g:
        return set()
    resting = {base.name for name, base in start.free_bases.items() if name not in loose}
    shifts = [
        i
        for joint in start.system.joints
        if not joint.actuated and joint.name not in resting
        for i in range(joint.v.start, joint.v.start + joint.lengths)
    ]
    return {name for name in loose if _lowest(start, shifts, name) <= NEAR}


def _lowest(start: Start, shifts: list[int], name: str) -> float:
    """How far rows let a body sink, at most 2 NEAR, while all `shifts` are free [m]."""
    from scipy.optimize import linprog  # takes as long as a short run

    rows = start.rows
    own = start.free_bases[name].v
    others = [i for i in shifts if not own.start <= i < own.stop]
    free = np.eye(start.system.n_v)[:, others]
    motion = np.column_stack([_sinking(start, name), free])  # in units of NEAR
    best = linprog(
        [-1.0, *np.zeros(len(others))],
        A_ub=-rows.A @ motion,
        b_ub=-np.minimum(rows.b, 0.0) / NEAR,  # a row that is violated lets nothing sink
        bounds=[(0.0, 2.0), *[(None, None)] * len(others)],
    )
    if best.x is None:
        raise QuasistaticError(f"linprog: {best.message}")
    return NEAR * float(best.x[0])


class Fall(NamedTuple):
    """How a body falls until the end of a run.

    Parameters
    ----------
    first : int
        The first step in which nothing bears it.
    way : float
        From there [m].
    contacts : ndarray of bool, shape (n_c,)
        Its contacts.
    """

    first: int
    way: float
    contacts: Mask


def falling(run: Run) -> Iterator[Finding]:
    """Free bodies that move down in the last step while nothing bears them."""
    for name, fall in falls(run).items():
        cause = f"nothing bears {name} from step {fall.first} to the end, and it falls by "
        cause += f"{distance(fall.way)}, h^2 g = {1e3 * run.h**2 * run.g:.3g} mm a step"
        numbers = {"first_step": fall.first, "fallen_mm": 1e3 * fall.way}
        yield finding("free-fall", cause, _remedy(run, fall), **numbers)


def falls(run: Run) -> dict[str, Fall]:
    """The falls in the last step, by names of free bodies that nothing bears or holds.

    A force below 1e-3 of a body's weight does not bear it, but a soft spring under it does slowly.
    """
    sinking = {}
    for name, base in run.free_bases.items():
        falls = run.falls(base)
        if not falls[-1]:
            continue
        of_body = run.of_body(name)
        force = np.abs(run["wrench"][:, of_body, 2]).max(axis=1, initial=0.0)
        bears = (force > LIGHT * run.system.mass(name) * run.g) | ~falls
        first = int(np.flatnonzero(np.append(True, bears))[-1])
        if first < run.steps:
            way = float((run["q"][-1] - run["q"][first])[base.q][:3] @ run.down)
            sinking[name] = Fall(first, way, of_body)
    if not sinking:
        return {}
    driven = np.array([run.driven[[p.alpha.link, p.beta.link]].any() for p in run.pairs], bool)
    yields = run.touches[-1] & driven[run.pair_of]  # a soft spring does slowly bear it
    others = alone(run) | held(run, sinking)
    others |= {name for name, fall in sinking.items() if yields[fall.contacts].any()}
    return {name: fall for name, fall in sinking.items() if name not in others}


def _remedy(run: Run, fall: Fall) -> str:
    if fall.first:
        return "hold it more firmly or longer, or put something below it"
    touch = np.flatnonzero(fall.contacts & (np.abs(run["phi"][0]) <= SHORT * run.sizes))
    if touch.size:
        pair = run.pairs[run.pair_of[touch[0]]]
        return f"let what touches it at the start, {pair.name}, bear it"
    return "start it on what should bear it"

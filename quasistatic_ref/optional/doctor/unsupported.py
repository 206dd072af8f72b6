"""Bodies that nothing bears or holds, bodies that fall, and how far they do until they touch."""

from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import SHORT, Start, joining, least
from quasistatic_ref.optional.doctor.telling import distance
from quasistatic_ref.optional.doctor.tolerances import NEAR
from quasistatic_ref.optional.doctor.undecided import optimum
from quasistatic_ref.simulate.finding import Finding

ROUNDS = 100
"""Advances until a falling body touches; corners take one, round surfaces some ten."""
CLOSE = 1e-9
"""Gap that counts as none [m]."""
LEVEL = 1e-9
"""Cosine between a fall and a normal up to which the fall goes past a surface [-]."""


def sinks(start: Start, name: str) -> bool:
    """Whether the loads of a free body pull it down at the start, by 1e-3 of its weight or more.

    Others than gravity may bear it.
    """
    least = LIGHT * start.system.mass(name) * start.g
    return bool(start.load_at_start @ _down(start, name) > least)


def _down(start: Start, name: str) -> Array:
    """The motion of a free body by 1 m along gravity at the start, shape (n_v,) [m, rad]."""
    base = start.free_bases[name]
    columns = slice(base.v.start, base.v.start + base.lengths)
    down = np.zeros(start.system.n_v)
    J = start.kinematics.J_of([start.system.link(name)])[0, :3]
    down[columns] = start.gravity @ J[:, columns] / start.g
    return down


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


def unsupported(start: Start) -> Iterator[Finding]:
    """Free bodies with mass that no contact pair can bear."""
    joint = "pair of geoms" if start.system.of_mjcf else "table"
    for name in sorted(alone(start)) if start.g else ():
        if not sinks(start, name):
            continue
        touches = any(start.bodies(pair) != {name} for pair, _ in start.pairs_of.get(name, ()))
        others = " but to bodies that fall as well" if touches else ""
        weight = start.system.mass(name) * start.g
        yield Finding(
            "unsupported-body",
            True,
            joining(start, f"{name} and what should bear it"),
            f"no {joint} joins {name}, which weighs {weight:.3g} N, to anything{others}: it falls",
            {"weight_N": weight},
        )


def falling(run: Run) -> Iterator[Finding]:
    """Free bodies that move down in the last step while nothing bears them."""
    most = run.h**2 * run.g
    for name, fall in falls(run).items():
        yield Finding(
            "free-fall",
            True,
            _remedy(fall.contacts, run, fall.first),
            f"nothing bears {name} from step {fall.first} to the end, and it falls by "
            f"{distance(fall.way)}, h^2 g = {1e3 * most:.3g} mm a step",
            {"first_step": fall.first, "fallen_mm": 1e3 * fall.way},
        )


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


def falls(run: Run) -> dict[str, Fall]:
    """The falls in the last step, by names of free bodies that nothing bears or holds.

    A force below 1e-3 of a body's weight does not bear it, but a soft spring under it does slowly.
    """
    if not run.g:
        return {}
    system = run.system
    down = run.gravity / run.g
    most = run.h**2 * run.g
    sinking = {}
    for name, base in run.free_bases.items():
        drop = np.diff(run["q"][:, base.q][:, :3] @ down)
        if drop[-1] <= most / 2:
            continue
        of_body = run.of_body(name)
        force = np.abs(run["wrench"][:, of_body, 2]).max(axis=1, initial=0.0)
        free = (force <= LIGHT * system.mass(name) * run.g) & (drop > most / 2)
        if free[-1]:
            first = int(len(free) - np.argmin(free[::-1])) if not free.all() else 0
            sinking[name] = Fall(first, float(drop[first:].sum()), of_body)
    if not sinking:
        return {}
    others = alone(run) | held(run, sinking)
    driven = np.array([run.driven[[p.alpha.link, p.beta.link]].any() for p in run.pairs], bool)
    yields = run.touches[-1] & driven[run.pair_of]  # a soft spring does slowly bear it
    others |= {name for name, fall in sinking.items() if yields[fall.contacts].any()}
    return {name: fall for name, fall in sinking.items() if name not in others}


def _remedy(of_body: Mask, run: Run, first: int) -> str:
    if first:
        return "hold it more firmly or longer, or put something below it"
    gaps = run["phi"][0, of_body]
    if not gaps.size:  # it is only joined to one that touches
        return "start it on what should bear it"
    k = int(np.abs(gaps).argmin())
    pair = run.pairs[run.pair_of[of_body][k]]
    if gaps[k] <= SHORT * least(pair):
        return f"let what touches it at the start, {pair.name}, bear it"
    return "start it on what should bear it"


def fall(start: Start, pair: ContactPair, name: str) -> float:
    """How far a body falls along gravity until a pair touches [m]; infinity if none does.

    Of convex bodies the gap along their normal shrinks by as much as they come nearer along it, and
    they do not touch before it is closed: they are moved by that, and have a new normal, until they
    touch or the normal no longer faces the fall. Of a cloud the first of its points counts.

    Raises
    ------
    ContactError
        If the pair has no trustworthy normal on the way.
    """
    way = start.gravity / start.g
    falls = start.body(pair.beta.link) == name
    link, sign = (pair.beta.link, -1.0) if falls else (pair.alpha.link, 1.0)
    every = replace(pair, k=pair.candidates if pair.has_cloud else 1)
    t = start.kinematics.t.copy()
    far = 0.0
    for _ in range(ROUNDS):
        near = pair_closest_points(every, start.kinematics.R, t)
        if near.phi.min() <= CLOSE:
            break
        nearer = sign * (near.n @ way)
        meets = nearer > LEVEL
        if not meets.any():
            return np.inf
        step = float((near.phi[meets] / nearer[meets]).min())
        t[link] += step * way
        far += step
    return far


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
    if not len(start.rows.A) or not start.g or not loose:
        return set()
    resting = {base.name for name, base in start.free_bases.items() if name not in loose}
    shifts = [
        i
        for joint in start.system.joints
        if not joint.actuated and joint.name not in resting
        for i in range(joint.v.start, joint.v.start + joint.lengths)
    ]
    return {name for name in loose if _sinks(start, shifts, name) <= NEAR}


def _sinks(start: Start, shifts: list[int], name: str) -> float:
    """How far rows let a body sink, at most 2 NEAR, while all `shifts` are free [m]."""
    from scipy.optimize import linprog  # takes as long as a short run

    rows = start.rows
    down = _down(start, name)
    own = start.free_bases[name].v
    others = [i for i in shifts if not own.start <= i < own.stop]
    motion = np.column_stack([down, np.eye(len(down))[:, others]])  # in units of NEAR
    best = linprog(
        [-1.0, *np.zeros(len(others))],
        A_ub=-rows.A @ motion,
        b_ub=-np.minimum(rows.b, 0.0) / NEAR,  # a row that is violated lets nothing sink
        bounds=[(0.0, 2.0), *[(None, None)] * len(others)],
    )
    return NEAR * float(optimum(best)[0])

"""What a second opinion finds, in words of physics.

A body that touches is looked at by its contacts. Those that let it move are found in both: a
contact slips, or spins, faster than the tolerance at its surface.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.compared import Bearing, Body, Contact, Mover
from quasistatic_ref.optional.mujoco.tolerances import (
    DEEP,
    FAST,
    FORCES_AGREE,
    INSIDE_CONE,
    PIERCES,
    PRESSES,
)
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import CREEP

if TYPE_CHECKING:
    from mujoco import MjModel


STRONGER = "raise friction of the geoms, or what presses the bodies together"
SPINS = "set condim 4 of the geoms, and the second number of their friction"
HOLDS = "raise the second number of friction of the geoms, or what presses the bodies together"
RESTS = "leave out rolling friction, which a step does not have"
STIFFER = "change solref and solimp of the geoms, or take masses that differ less"
APART = "change size or pos, or add contact/exclude for bodies that may overlap"
SETTLES = "put something below it, hold it, or let the scene settle for longer (--settle)"
YIELDS = "MuJoCo documents that its friction yields to any force"
EDGES = "; in the pyramidal cone noslip leaves an axis 1/(condim - 1) of mu N"
"""It keeps the sum of each pair of opposite edges."""

Named = tuple[str, Finding]
"""The body that a finding is about, and the finding."""


def findings(
    contacts: Sequence[Contact],
    bodies: Sequence[Body],
    weight: float,
    tolerance: float,
    model: MjModel,
) -> Iterator[Named]:
    """All findings of a second opinion.

    Parameters
    ----------
    contacts : sequence of Contact
    bodies : sequence of Body
    weight : float
        Of the whole model [N].
    tolerance : float
        Speed up to which a contact holds [m/s].
    model : mujoco.MjModel
        Its options decide how friction yields.
    """
    every = _meetings(contacts, bodies)
    movers = {meeting.contacts[0].bodies: meeting.mover for meeting in every}
    for body in bodies:
        touching = [c for c in contacts if movers[c.bodies] is body]
        yield from _motion(body, touching, tolerance, model)
    for meeting in every:
        least = min(body.size for body in meeting.bodies)
        if meeting.depth > PIERCES * least:
            yield _inside(meeting, least)
        elif all(body.rests or body.steady for body in meeting.bodies) and (
            meeting.depth > DEEP or not _borne(contacts, meeting.bodies)
        ):
            yield from _penetration(meeting, weight)


class _Meeting(NamedTuple):
    """Two bodies that touch: their contacts, and which of the two can move."""

    contacts: list[Contact]
    bodies: list[Body]

    @property
    def mover(self) -> Body:
        """The body that moves more: the other is at rest, or nearly."""
        return max(self.bodies, key=lambda b: b.fastest(b.theirs) + b.fastest(b.exact))

    @property
    def depth(self) -> float:
        """The depth of the two bodies in each other [m]."""
        return max(c.depth for c in self.contacts)

    @property
    def theirs(self) -> float:
        """MuJoCo's normal force [N]."""
        return sum(c.theirs.normal for c in self.contacts)

    @property
    def exact(self) -> float:
        """The exact normal force [N]."""
        return sum(c.exact.normal for c in self.contacts if c.exact)


def _meetings(contacts: Sequence[Contact], bodies: Sequence[Body]) -> list[_Meeting]:
    by_name = {body.name: body for body in bodies}
    return [
        _Meeting(
            [c for c in contacts if c.bodies == two],
            [by_name[name] for name in two if name in by_name],
        )
        for two in dict.fromkeys(c.bodies for c in contacts)
    ]


def _borne(contacts: Sequence[Contact], bodies: Sequence[Body]) -> bool:
    """Whether MuJoCo's forces balance the loads of some bodies inside the cones of a step."""
    names = {body.name for body in bodies}
    shares = [c.theirs.share for c in contacts if names & {*c.bodies} and c.theirs.normal > 0]
    inside = max(shares, default=0.0) <= 1 + FORCES_AGREE
    return inside and all(body.balanced and not _rolls(body, contacts) for body in bodies)


def _rolls(body: Body, contacts: Sequence[Contact]) -> bool:
    """Whether MuJoCo's rolling friction has a part in what holds a body."""
    normal = sum(c.theirs.normal for c in contacts if body.name in c.bodies)
    return body.rolling > FORCES_AGREE * normal * body.size


def moving(movers: Sequence[Mover], v: Array) -> Iterator[Named]:
    """Bodies that only contacts hold, and that move fast at MuJoCo's mean velocity v, (nv,)."""
    for mover in movers:
        speed = mover.fastest(v)
        if mover.free and speed > FAST:
            cause = f"{mover.name} moves by up to {1e3 * speed:.3g} mm/s in MuJoCo, and the exact "
            cause += "answer of one instant does not say why"
            numbers = {"speed_mm_s": 1e3 * speed}
            yield mover.name, Finding("moving", True, SETTLES, cause, numbers)


def not_unique(contacts: Sequence[Contact], bodies: Sequence[Body], weight: float) -> Iterator[str]:
    """Which contacts have other normal forces in MuJoCo, which balance the loads as well.

    `weight` is that of the whole model [N].
    """
    for meeting in _meetings(contacts, bodies):
        more = abs(meeting.theirs - meeting.exact)
        rest = all(body.rests and body.fastest(body.exact) <= CREEP for body in meeting.bodies)
        bound = FORCES_AGREE * max(meeting.theirs, weight)
        if rest and more > bound and _borne(contacts, meeting.bodies):
            alike = "MuJoCo's balance the loads inside the cones, as the exact ones do"
            yield f"{_pairs(meeting.contacts)}: forces are not unique; {alike}"


def _motion(
    body: Body, touching: Sequence[Contact], tolerance: float, model: MjModel
) -> Iterator[Named]:
    """Findings on a body that slides, turns or creeps on its contacts."""
    moved = [c for c in touching if c.exact and _motion_of(c.exact, body) > tolerance]
    slides = [c for c in moved if c.exact and c.exact.slip > tolerance]
    yielding = {c.pair for c in touching if _creep(c, body) > tolerance}
    creeps = [c for c in touching if c.pair in yielding and _share(touching, c.pair) < INSIDE_CONE]
    rests = body.fastest(body.theirs) <= tolerance
    stays = body.steady and body.fastest(body.theirs) <= FAST
    moves = body.fastest(body.exact) > tolerance
    if (rests or stays) and moves and _rolls(body, touching):
        yield _moves(body, touching, rests)
    elif slides:
        yield _slides(body, slides)
    elif moved:
        yield _turns(body, moved, model)
    elif creeps and stays:
        yield _creeps(body, creeps, model)
    elif touching and rests and moves:
        yield _moves(body, touching, rests)


def _motion_of(side: Bearing, body: Body) -> float:
    """How fast the surfaces of a contact that bears move on each other [m/s]."""
    return max(side.slip, side.spin * body.size) if side.normal > 0 else 0.0


def _share(touching: Sequence[Contact], pair: str) -> float:
    """The share of what the contacts of a pair could bear that MuJoCo's forces use [-]."""
    sides = [c.theirs for c in touching if c.pair == pair and c.theirs.normal > 0]
    normal = sum(side.normal for side in sides)
    return sum(side.share * side.normal for side in sides) / normal if normal else 0.0


def _creep(contact: Contact, body: Body) -> float:
    """MuJoCo's motion of a contact that friction resists [m/s]."""
    slip = contact.theirs.slip if contact.mu_v else 0.0
    spin = contact.theirs.spin if contact.mu_omega else 0.0
    return _motion_of(replace(contact.theirs, slip=slip, spin=spin), body)


def _creeps(body: Body, through: Sequence[Contact], model: MjModel) -> Named:
    turn = body.theirs.turn
    creeps = _turning(body)
    numbers = {"turn_rad_s": turn}
    slip = 1e3 * max(c.theirs.slip for c in through)
    if 1e3 * body.size * turn <= slip:
        creeps = f"{body.name} slips by {slip:.3g} mm/s"
        numbers = {"slip_mm_s": slip}
    bears = f"{body.bears:.3g} N and {body.needed:.3g} N is"
    if any(c.mu_omega and c.theirs.spin * body.size > c.theirs.slip for c in through):
        most = sum(c.mu_omega * c.exact.normal for c in through if c.exact)
        torque = sum(c.exact.torque for c in through if c.exact)
        bears = f"{1e3 * most:.3g} N mm of torque and {1e3 * torque:.3g} N mm is"
    cause = f"{creeps}, where its contacts could bear {bears} asked for; in the exact answer it "
    cause += f"sticks; {YIELDS}"
    above = f"impratio above {model.opt.impratio:g}"
    slower = f"set option {above}, or noslip_iterations"
    if not model.opt.cone:  # the pyramidal one
        cause += EDGES
        slower = f'set option cone="elliptic" first, then {above} and noslip_iterations'
    return _finding("creeps", body, through, slower, cause, numbers)


def _slides(body: Body, through: Sequence[Contact]) -> Named:
    cause = f"{body.name} slides: its friction is at its limit"
    share = 1.0
    if body.free and body.bears < body.needed:  # else it slips because it turns
        share = body.bears / body.needed
        cause = f"{body.name} slides: its contacts hold {share:.2g} of what its load needs, "
        cause += f"{body.bears:.3g} N of {body.needed:.3g} N"
    verb = "sinks" if body.theirs.sinks > body.theirs.speed / 2 else "moves"
    cause += f"; in MuJoCo, {body.name} {verb} by {1e3 * body.theirs.speed:.3g} mm/s"
    return _finding("slides", body, through, STRONGER, cause, {"share": share})


def _turns(body: Body, through: Sequence[Contact], model: MjModel) -> Named:
    mu_omega = 1e3 * max(c.mu_omega for c in through)
    about = "the line of the two points" if len(through) == 2 else "the normal"
    sides = [c.exact for c in through if c.exact]
    torque = body.torque + sum(side.torque for side in sides)
    rubs = sum(side.friction for side in sides)
    # What turns falls, and asks for less friction than what would be held.
    held = max(1.0, body.needed / rubs) if body.free and rubs else 1.0
    room = sum(_room(c, c.exact, held, model.opt.cone) for c in through if c.exact)
    needed = 1e3 * torque / room if room else 0.0
    cause = f"torsional friction {mu_omega:.3g} mm: {body.name} turns about {about}"
    cause += f"; {_raised(needed):.3g} mm or more would hold it" if needed else ""
    cause += f"; in MuJoCo, {_turning(body)}"
    remedy = HOLDS if mu_omega else SPINS
    return _finding("turns", body, through, remedy, cause, {"mu_omega_mm": mu_omega})


def _raised(number: float) -> float:
    """The next number of three digits above a positive one, or that itself [its unit]."""
    place = 10.0 ** (np.floor(np.log10(number)) - 2)
    return float(np.ceil(number / place) * place)


def _room(contact: Contact, side: Bearing, held: float, elliptic: int) -> float:
    """What friction, `held` times as large, leaves of a normal force for torque [N].

    Over mu_omega the torque may be as large: the shares of the normal force that friction and
    torque take add up to it in the pyramid, and their squares to its square in the ellipsoid.
    """
    taken = side.share * side.normal
    of_torque = side.torque / contact.mu_omega if contact.mu_omega else 0.0
    if not elliptic:
        return max(side.normal - held * (taken - of_torque), 0.0)
    of_friction = held**2 * (taken**2 - of_torque**2)
    return float(np.sqrt(max(side.normal**2 - of_friction, 0.0)))


def _turning(body: Body) -> str:
    return f"{body.name} turns by {np.degrees(body.theirs.turn):.3g} degrees/s"


def _moves(body: Body, through: Sequence[Contact], rests: bool) -> Named:
    cause = f"{body.name} {'rests' if rests else 'creeps'} in MuJoCo"
    numbers = {"speed_mm_s": 1e3 * body.fastest(body.exact)}
    if _rolls(body, through):
        cause += f" by rolling friction of {1e3 * body.rolling:.3g} N mm"
        numbers["rolling_N_mm"] = 1e3 * body.rolling
    cause += "; its contacts, loads and joints alone let it move"
    return _finding("moves", body, through, RESTS, cause, numbers)


def _penetration(meeting: _Meeting, weight: float) -> Iterator[Named]:
    """Whether two bodies are pushed apart by more than their loads."""
    theirs, ours = meeting.theirs, meeting.exact
    pushes = theirs - ours > FORCES_AGREE * max(theirs, weight)
    if not pushes or (meeting.depth <= DEEP and theirs <= PRESSES * ours):
        return
    cause = f"and are pushed apart with {theirs:.3g} N where their loads ask for {ours:.3g} N"
    yield _penetrates(meeting, cause, APART)


def _inside(meeting: _Meeting, size: float) -> Named:
    """The finding that two bodies overlap so deeply that they cannot be rigid."""
    cause = f"{meeting.depth / size:.0%} of the distance from the middle to the farthest point of "
    cause += "the smaller one; rigid bodies do not"
    return _penetrates(meeting, cause, STIFFER)


def _penetrates(meeting: _Meeting, cause: str, remedy: str) -> Named:
    body, depth = meeting.mover, 1e3 * meeting.depth
    other = next(name for name in meeting.contacts[0].bodies if name != body.name)
    cause = f"{body.name} and {other} penetrate by {depth:.3g} mm, {cause}"
    return _finding("penetrates", body, meeting.contacts, remedy, cause, {"depth_mm": depth})


def _finding(
    kind: str, body: Body, through: Sequence[Contact], remedy: str, cause: str,
    numbers: Mapping[str, float],
) -> Named:  # fmt: skip
    """A finding whose cause begins with its contacts, each pair once."""
    return body.name, Finding(kind, True, remedy, f"{_pairs(through)}: {cause}", numbers)


def _pairs(contacts: Sequence[Contact]) -> str:
    return " and ".join(dict.fromkeys(c.pair for c in contacts))

"""Findings of statics: what bodies lack, and what the model adds to forces and motions."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.optional.doctor.bodies import COUNTS
from quasistatic_ref.optional.doctor.compared import SLIP, SPIN, TORQUE
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.slow import SAME
from quasistatic_ref.optional.doctor.telling import amount
from quasistatic_ref.optional.doctor.undecided import Undecided, undecided
from quasistatic_ref.optional.doctor.unsupported import alone, falls
from quasistatic_ref.simulate.finding import Finding

UNITS = ("N", "N", "N m", "m", "rad")
"""Of normal force, friction, torque, slip and spin."""
TOLD = 0.01
"""Part of what the model adds most [-] from which on another part is in a sentence."""


def out_of_balance(run: Run) -> Iterator[Finding | Undecided]:
    """Bodies whose loads no forces of Coulomb's law bear, by the run's cone.

    A body that falls until the end because its contacts bear nothing is in free fall.
    """
    yield from undecided("equilibrium", run.asked.unknown)
    falling = falls(run)
    unsupported = alone(run)
    for body, (k, lack) in run.asked.lacks.items():
        weight = body.mass * run.g
        if run.asked.in_corners(body) or body.name in unsupported:
            continue
        if body.name in falling and lack.force >= (1 - COUNTS) * weight:
            continue
        does = "bears"
        if lack.turning > 1 - COUNTS:
            does = "resists the spin of" if body.free else "resists the turn of"
        yield Finding(
            "equilibrium",
            False,
            "",
            f"nothing {does} {body.named(lack)}: up to {lack} are missing (step {k})",
            {
                "missing_N": lack.force,
                "missing_Nm": lack.torque,
                "step": k,
            },
            body.named(lack),
        )


def corners(run: Run) -> Iterator[Finding | Undecided]:
    """Bodies that an ellipsoid would hold, or the body that lacks most without corners."""
    asked = run.asked
    yield from undecided("corners", asked.unknown_round)
    here = run.simulator.cone
    remedy = 'set cone = "ellipsoid"'
    held = {body.name: asked.lacks[body][0] for body in asked.round if asked.in_corners(body)}
    if held:
        k = min(held.values())
        cause = "the ellipsoid, whose friction is the same in all directions, holds "
        cause += f"{listed([*held])}, and the {here} does not (step {k})"
        yield Finding("corners", False, remedy, cause, {"step": k}, listed([*held]))
        return
    most = 0.0
    found: Finding | None = None
    for body, there in asked.round.items():
        k, lack = asked.lacks[body]
        if there is None:
            continue
        off = float(np.linalg.norm(lack.r - there.r))
        if off > max((1 + SAME) * most, COUNTS * float(np.linalg.norm(lack.r))):
            most = off
            cause = f"{body.name} lacks {lack} in the {here}, and in the ellipsoid {there}, "
            cause += f"in another direction or by another amount (step {k})"
            numbers = {"missing_N": lack.force, "ellipsoid_N": there.force, "step": k}
            found = Finding("corners", False, remedy, cause, numbers, body.name)
    if found is not None:
        yield found


def artifact(run: Run) -> Iterator[Finding | Undecided]:
    """The pair of which drag and the boundary layer change most."""
    yield from undecided("artifacts", run.asked.unknown_changes)
    change = run.asked.change
    if change is None or change.share <= COUNTS:
        return
    pair = run.pairs[change.pair]
    unit = UNITS[change.what]
    of_drag = abs(change.drag) >= abs(change.layer)
    if change.what in (SLIP, SPIN):
        length = change.what == SLIP
        way = amount(float(run.ways(change.pair)[change.what - SLIP]), unit)
        by = "drag" if of_drag else "the boundary layer"
        how = f"slips by {way}" if length else f"turns by {way}"
        cause = f"{pair.name} {how} in the run, because of {by}: slowly it sticks"
    else:
        noun = ("", " of friction", "")[change.what]
        parts = {"drag": change.drag, "the boundary layer": change.layer}
        most = max(map(abs, parts.values()))
        shares = [f"{x:.3g} {unit} by {what}" for what, x in parts.items() if abs(x) >= TOLD * most]
        bears = "bears a torque of" if change.what == TORQUE else "has"
        cause = f"{pair.name} {bears} {change.here:.3g} {unit}{noun}, slowly {change.slowly:.3g} "
        cause += f"{unit}: {', '.join(shares)}"
    remedy = "move more slowly, or take a larger h"
    if not of_drag:
        remedy = 'move more slowly, take a smaller h, or set law = "coulomb"'
    yield Finding(
        "artifact",
        False,
        remedy,
        f"{cause} (step {change.k})",
        {
            f"run_{unit}".replace(" ", ""): change.here,
            f"slowly_{unit}".replace(" ", ""): change.slowly,
            f"drag_{unit}".replace(" ", ""): change.drag,
            f"layer_{unit}".replace(" ", ""): change.layer,
            "step": change.k,
        },
        pair.name.partition("(")[0],
    )

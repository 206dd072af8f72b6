"""Bodies that nothing can bear, and bodies that fall."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.compared import FARTHEST, SHORT
from quasistatic_ref.optional.doctor.falls import held
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start, bodies, free_bases, joining, least
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import Mask
from quasistatic_ref.tolerances import FILLED


def alone(start: Start) -> set[str]:
    """Free bodies that no chain of contact tables, welds or tendons joins to what stands."""
    left = {*free_bases(start.system)}
    joined = [bodies(start.system, pair) for pair in start.pairs]
    while left:
        borne = {name for pair in joined if pair - left for name in pair & left}
        borne = borne or held(start, left)
        if not borne:
            break
        left -= borne
    return left


def unsupported(start: Start) -> Iterator[Finding]:
    """Bodies that are joined to nothing, if they weigh anything."""
    joined = [bodies(start.system, pair) for pair in start.pairs]
    joint = "pair of geoms" if start.system.of_mjcf else "table"
    for name in sorted(alone(start)) if start.g else ():
        touching = [pair - {name} for pair in joined if name in pair]
        others = " but to bodies that fall as well" if any(touching) else ""
        weight = start.system.mass(name) * start.g
        yield Finding(
            "unsupported body",
            True,
            joining(start, f"{name} and what should bear it"),
            f"no {joint} joins {name}, which weighs {weight:.3g} N, to anything{others}: it falls",
            {"weight_N": weight},
        )


def falling(run: Run) -> Iterator[Finding]:
    """Free bodies that nothing bears in the last step, and that move down in it."""
    most = run.h**2 * run.g
    for name, fall in falls(run).items():
        yield Finding(
            "free fall",
            True,
            _remedy(fall.own, run, fall.first),
            f"nothing bears {name} from step {fall.first} to the end, and it falls by "
            f"{1e3 * fall.way:.3g} mm, h^2 g = {1e3 * most:.3g} mm a step",
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
    own : ndarray of bool, shape (n_c,)
        Its contacts.
    """

    first: int
    way: float
    own: Mask


def falls(run: Run) -> dict[str, Fall]:
    """Free bodies, by name, that nothing bears or holds in the last step, and that move down in it.

    A force below 1e-3 of a body's weight does not bear it.
    """
    if not run.g:
        return {}
    system = run.system
    down = run.gravity / run.g
    most = run.h**2 * run.g
    touched = [bodies(system, pair) for pair in run.pairs for _ in range(pair.n_c)]
    sinking = {}
    for name, base in free_bases(system).items():
        own = np.array([name in names for names in touched], dtype=bool)
        force = np.abs(run["wrench"][:, own, 2]).max(axis=1, initial=0.0)
        drop = np.diff(run["q"][:, base.q][:, :3] @ down)
        free = (force <= LIGHT * system.mass(name) * run.g) & (drop > most / 2)
        if free[-1]:
            first = int(len(free) - np.argmin(free[::-1])) if not free.all() else 0
            sinking[name] = Fall(first, float(drop[first:].sum()), own)
    others = alone(run) | held(run, sinking)
    return {name: fall for name, fall in sinking.items() if name not in others}


def _remedy(own: Mask, run: Run, first: int) -> str:
    if first:
        return "hold it more firmly or longer, or put something below it"
    gaps = run["phi"][0, own]
    if not gaps.size:  # it is only joined to one that touches
        return "start it on what should bear it"
    k = int(np.abs(gaps).argmin())
    pair = [pair for pair in run.pairs for _ in range(pair.n_c)][int(np.flatnonzero(own)[k])]
    if gaps[k] <= SHORT * min(least(pair), FARTHEST):
        return f"let what touches it at the start, {pair.name}, bear it"
    beyond = gaps[k] >= FILLED  # farther away than what has a distance
    return "start it on what should bear it" + (
        "" if beyond else f", {1e3 * gaps[k]:.4g} mm away at the start"
    )

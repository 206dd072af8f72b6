"""Bodies that nothing can bear, and bodies that fall."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.falls import held
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start, bodies, free_bases, joining
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import BEARS, FILLED


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
    """Free bodies that nothing touches or holds in the last step, and that move down in it."""
    if not run.g:
        return
    system = run.system
    down = run.gravity / run.g
    most = run.h**2 * run.g
    touched = [bodies(system, pair) for pair in run.pairs for _ in range(pair.n_c)]
    said = alone(run)
    sinking = {}
    for name, base in free_bases(system).items():
        own = np.array([name in names for names in touched], dtype=bool)
        force = np.abs(run["wrench"][:, own, 2]).max(axis=1, initial=0.0)
        drop = np.diff(run["q"][:, base.q][:, :3] @ down)
        falls = (force <= BEARS * system.mass(name) * run.g) & (drop > most / 2)
        if falls[-1]:
            sinking[name] = own, drop, falls
    borne = held(run, sinking)
    for name, (own, drop, falls) in sinking.items():
        if name not in said and name not in borne:
            first = int(len(falls) - np.argmin(falls[::-1])) if not falls.all() else 0
            fallen = float(drop[first:].sum())
            yield Finding(
                "free fall",
                True,
                _remedy(own, run, first),
                f"nothing touches {name} from step {first} to the end, and it falls by "
                f"{1e3 * fallen:.3g} mm, h^2 g = {1e3 * most:.3g} mm a step",
                {"first_step": first, "fallen_mm": 1e3 * fallen},
            )


def _remedy(own: Array, run: Run, first: int) -> str:
    if first:
        return "hold it more firmly or longer, or put something below it"
    gaps = run["phi"][0, own]  # none of a body that is only joined to one that touches
    gap = float(gaps[np.abs(gaps).argmin()]) if gaps.size else FILLED
    beyond = gap >= FILLED  # farther away than what has a distance
    return "start it on what should bear it" + (
        "" if beyond else f", {1e3 * gap:.4g} mm away at the start"
    )

"""Drag that is not small against the friction that contacts bear."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.optional.doctor.artifacts import Drag, drags, moved
from quasistatic_ref.optional.doctor.run import Run, wrenches
from quasistatic_ref.optional.doctor.start import free_bases
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.solve.solve import solved
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.solve.units import DenseStepInBothUnits, in_natural
from quasistatic_ref.step.arrays import without_warnings
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import ACCURACY, SLOW

ALONG = 0.1
"""Share of a motion downwards by which a body that settles may move aside [-]."""
STILL = 1e-9
"""Motion in a step [m] that is none."""
ROUNDING = 1e-9
"""Of the rates at which rows open, over the largest, and of residuals in natural units [-]."""
SURELY = 0.95
"""Of the largest share [-], to cover the rounding of another."""
SLOWER = 16.0
"""By what M_u is divided, and with it the drag, to see what contacts bear without drag."""


def drag(run: Run) -> Iterator[Finding]:
    """The worst step, if its drag exceeds a tenth of the friction of the same step without drag.

    Drag increases normal forces, too: a pusher has to overcome it. This raises the friction that
    contacts can bear, and makes the share too small. So the friction is that of the same step with
    M_u / 16 and the same loads.
    """
    shares = run.noted("pushed").copy()
    shares[: _settled(run)] = np.nan
    if np.isnan(shares).all() or np.nanmax(shares) <= SLOW / 2:
        return  # what drag adds to friction is a share of itself
    k = int(np.nanargmax(shares))
    found = [x for x in _without_doing(run, k) if x.touched[0]]
    worst = max(found, key=_share, default=None)
    share = float(shares[k]) if worst is None else _share(worst)
    if share <= SLOW:
        return
    on = "a free body"
    of = "what its contacts can bear"
    numbers = {"share": share, "step": k}
    if worst is not None:
        drag_N = float(worst.drag[0])
        bears_N = float(worst.bears[0])
        on = f"{worst.body}, {drag_N:.3g} N"
        friction = "friction that its contacts can bear" if worst.rubs[0] else "its weight"
        of = f"the {bears_N:.3g} N of {friction}"
        numbers |= {"drag_N": drag_N, "bears_N": bears_N}
    yield Finding(
        "drag",
        False,
        "move more slowly or take larger steps",
        f"the spurious drag m v / h on {on}, is {share:.2g} times {of}, in step {k}",
        numbers,
    )


def _settled(run: Run) -> int:
    """The first step in which a free body moves otherwise than down: none is carried before."""
    moves = np.full(run.steps, not run.g)
    for base in free_bases(run.system).values() if run.g else ():
        moved = np.diff(run["q"][:, base.q][:, :3], axis=0)
        down = moved @ run.gravity / run.g
        moves |= np.linalg.norm(moved, axis=1) > (1 + ALONG) * np.maximum(down, 0.0) + STILL
    return int(moves.argmax()) if moves.any() else run.steps


def _without_doing(run: Run, k: int) -> list[Drag]:
    """The drags of step k over what contacts bear without them; none where it is not solved."""
    if not run.searched:
        return []
    step = run.step_data(k)
    lighter = step.replace(M_u=step.M_u / SLOWER)
    found = _surely_small(run, k, lighter) if run.simulator.fast else None
    if found is not None:
        return found
    wrench: Array | None = wrenches(lighter)
    if wrench is None:
        return []
    return drags(run.system, [step], [run["delta_q"][k]], wrench[None], run.g)


def _surely_small(run: Run, k: int, lighter: StepData) -> list[Drag] | None:
    """Drags of step k that are small whatever the multipliers without drag are; else None.

    Contacts bear mu_v f_n by friction. Where y opens each row without slack at a rate of the mu_v
    of its contact, the sum of mu_v f_n is y'A'lam / h, and A'lam is unique. A backend's answer will
    do, if its residuals are small.
    """
    solver = solver_for(lighter, fast=True)
    both = without_warnings(solver.in_both_units, lighter)
    if not isinstance(both, DenseStepInBothUnits):
        return None
    try:
        solution = without_warnings(solved, both, solver, ACCURACY, "off")
    except StepNotSolved:
        return None
    residuals = both.natural_residuals(*in_natural(solution.delta_q, solution.lam, both.units))
    step = run.step_data(k)
    found = drags(run.system, [step], [run["delta_q"][k]], solution.wrench[None], run.g)
    small = all(x.rubs[0] and x.share[0] <= SURELY * SLOW for x in found)
    if step.cone != PYRAMID or not (small and residuals.worst <= ROUNDING):
        return None
    form = both.si_form
    tight = form.A @ solution.delta_q - form.b <= STILL
    for base in free_bases(run.system).values():
        mu = np.where(moved(step.contacts, base.v.start), step.contacts.mu_v, 0.0)
        wanted = np.repeat(mu, step.counts)[tight]
        y = np.linalg.lstsq(form.A[tight], wanted)[0]
        if np.abs(form.A[tight] @ y - wanted).max(initial=0.0) > ROUNDING * mu.max():
            return None
    return found


def _share(drag: Drag) -> float:
    """The share of a drag in one step; 0 where there is none."""
    return float(np.nan_to_num(drag.share[0]))

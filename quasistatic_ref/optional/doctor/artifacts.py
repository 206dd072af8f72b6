"""How far a run is from physics: its drag, its quasi-dynamic number and its boundary layer."""

import math
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import BEARS, SLOW


def drag_share(system: System, solution: StepSolution, g: float) -> float | None:
    """Spurious drag on a free body over the friction that its contacts can bear, (R13).

    Of a floating base that is not actuated, the drag is the force ||M_u delta_q_u / h^2|| on its
    translation, and what its contacts can bear is the sum of mu_v f_n. Where they bear nothing by
    friction, the drag is divided by the body's weight: in free fall the share is 1.

    Parameters
    ----------
    system : System
    solution : StepSolution
    g : float
        Length of gravity [m/s^2].

    Returns
    -------
    float or None
        Of the body that has the largest share; None where no body floats, or none that floats rubs
        or weighs anything, or where float64 has no number for it.
    """
    step, friction = solution.step, _friction(solution)
    momentum = step.momentum(solution.delta_q)
    shares = []
    for base in _free_bases(system):
        x = base.v.start
        drag = _quotient(np.linalg.norm(momentum[x - step.n_a : x - step.n_a + 3]), step.h**2)
        if drag is None:
            continue
        weight = system.mass(base.name.removesuffix("/base")) * g
        bears = float(friction[x]) if friction[x] > BEARS * drag else weight
        shares.append(_quotient(drag, bears))
    return max((share for share in shares if share is not None), default=None)


def _quotient(over: Any, under: Any) -> float | None:
    """Quotient of two numbers >= 0; None where it is beyond the range of float64, or 0/0.

    A friction coefficient may be as small as 5e-324: a product with it underflows to 0, a quotient
    by it overflows.
    """
    over, under = float(over), float(under)
    within = over < (sys.float_info.max * under if under < 1 else math.inf)
    return over / under if under > 0 and within else None


def _free_bases(system: System) -> list[Joint]:
    return [j for j in system.joints if j.kind == "floating" and not j.actuated]


def _friction(solution: StepSolution) -> Array:
    """For each coordinate that translates a base: sum of mu_v f_n [N] over its body's contacts.

    Shape (n_v,), or (n_v + 1,) in blocks; other entries mean nothing. A coordinate that translates
    a base moves the points of its body's contacts by one metre per metre, and others not at all.
    """
    contacts, f_n = solution.step.contacts, solution.wrench[:, 2]
    bears = contacts.mu_v * np.where(f_n > BEARS * f_n.max(initial=0.0), f_n, 0.0)
    blocks = getattr(contacts, "blocks", None)  # of many bodies
    J = contacts.J if blocks is None else blocks.J
    moved = np.linalg.norm(J[:, :3], axis=1) > 0.5  # it is 1 or 0, but for rounding
    if blocks is None:
        return np.asarray(bears @ moved)
    friction = np.zeros(blocks.n_v + 1)
    np.add.at(friction, blocks.column, bears[:, None] * moved)
    return friction


def quasi_dynamic_number(system: System, step: StepData, delta_q: Array, g: float) -> float | None:
    """Pi = v / (mu_v g h) of one step: the drag m v / h over the friction mu_v m g.

    mu_v m g is the friction of a body that rests by its own weight, not of a body that is held. v
    is the speed of the fastest un-actuated floating base, mu_v the least of the contacts that rub.

    Parameters
    ----------
    system : System
    step : StepData
    delta_q : ndarray, shape (n_v,)
    g : float
        Length of gravity [m/s^2].

    Returns
    -------
    float or None
        None where nothing floats, nothing rubs or nothing weighs, or where float64 has no number
        for it, as with a mu_v of 1e-323.
    """
    bases = [base.v.start for base in _free_bases(system)]
    rough = step.contacts.mu_v[step.contacts.mu_v > 0]
    if not (bases and rough.size and g > 0):
        return None
    moved = max(float(np.linalg.norm(delta_q[start : start + 3])) for start in bases)
    v = _quotient(moved, step.h)
    return None if v is None else _quotient(v, float(rough.min()) * g * step.h)


def gap_after(solution: StepSolution, n_v: int) -> Array:
    """Gap phi + n'J delta_q [m] of each contact after the step, to first order, shape (n_c,).

    Of delta_q count the first n_v coordinates: private rises are not in the gap.
    """
    contacts, delta_q = solution.step.contacts, solution.delta_q.copy()
    delta_q[n_v:] = 0.0
    motion = contacts.motion(delta_q)[:, :3]
    return np.asarray(contacts.phi + np.sum(contacts.n * motion, axis=1))


def boundary_layer(gap: Array, solution: StepSolution) -> float:
    """Largest gap [m] that a contact with load has after the step; 0 without load.

    Parameters
    ----------
    gap : ndarray, shape (n_c,)
        Of :func:`gap_after` [m].
    solution : StepSolution
    """
    force = solution.wrench[:, 2]
    loaded = force > BEARS * force.max(initial=0.0)
    return max(0.0, float(gap[loaded].max(initial=0.0)))


def warning(header: Mapping[str, Any]) -> str | None:
    """One sentence on a run whose drag is not small against what contacts bear, or None."""
    share = header["largest_drag_share"]
    if share is None or share <= SLOW:
        return None
    return (
        f"the spurious drag m v / h on a free body reaches {share:.2g} times the friction that its "
        "contacts can bear (its weight, where they bear none); move more slowly or take larger "
        "steps (the documentation's page 'Where the model is wrong')"
    )

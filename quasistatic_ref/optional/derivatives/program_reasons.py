"""Which rows of the program, and which targets, stand in the way of derivatives."""

from collections.abc import Sequence, Set

import numpy as np

from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.optional.derivatives.data_rates import Places
from quasistatic_ref.optional.derivatives.model.tangent import half_turns
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.optimum_rates import OptimumRates
from quasistatic_ref.optional.derivatives.step.reason import Reason
from quasistatic_ref.optional.derivatives.step.touching import Touching
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Mask
from quasistatic_ref.tolerances import ON_RIM


def target_reasons(simulator: Simulator, change: Array) -> list[Reason]:
    """Joints whose target is half a turn away.

    Parameters
    ----------
    simulator : Simulator
    change : ndarray, shape (n_a,)
        q_bar_a (-) q_a [m, rad].
    """
    names = half_turns(simulator.system.joints, change, ON_RIM)
    says = "the target is half a turn away, where (-) jumps"
    return [
        Reason(reason.HALF_TURN, (name,), ("dq_dq", "dq_dq_bar_a"), f"{name}: {says}")
        for name in names
    ]


def row_reasons(
    simulator: Simulator,
    rates: StepRates,
    touching: Touching,
    found: OptimumRates,
    near: Set[tuple[int, ...]],
) -> list[Reason]:
    """Rows that stand in the way of some parameters.

    Parameters
    ----------
    simulator : Simulator
    rates : StepRates
    touching : Touching
    found : OptimumRates
    near : set of (int, int)
        Contact and row of those that nearly touch, or nearly bear no load.
    """
    step = rates.result.step
    names = step.contacts.name
    row_names = cone(step.cone).row_names
    reasons = []

    def fields(bad: Mask) -> tuple[str, ...]:
        return tuple(name for name, place in rates.places.items() if bad[place].any())

    together: dict[tuple[str, ...], Mask] = {}
    for contacts, bad in found.contradicts:
        where = tuple(names[j] for j in sorted(contacts))
        together[where] = together.get(where, np.zeros_like(bad)) | bad
    for where, bad in together.items():
        says = f"the equations of {listed(where)} would contradict each other"
        reasons.append(Reason(reason.CONTRADICTION, where, fields(bad), says))
    for (j, i), bad in zip(touching.idle.tolist(), found.opens, strict=True):
        if bad.any():
            where = (names[j], row_names[i])
            row = f"row {row_names[i]} of {names[j]}"
            kind = reason.WEAK
            says = f"{row} touches without load: it holds on one side only"
            if (j, i) in near:
                kind = reason.NEARLY
                says = f"settled: nearly a kink at {row}"
            reasons.append(Reason(kind, where, fields(bad), says))
    touched = {names[j].rpartition("/")[0] for j in touching.contacts}
    for pair in simulator.pairs:
        for key, used in (("mu_v", True), ("mu_omega", pair.rows == 6)):
            if pair.name in touched and used and getattr(pair, key) == 0:
                says = f"{key} of {pair.name} is zero, cannot be smaller, and the pair touches"
                reasons.append(Reason(reason.ZERO_FRICTION, (pair.name,), (f"dq_d{key}",), says))
    return reasons


def forbidden(
    found: OptimumRates, reasons: Sequence[Reason], places: Places, pairs: Sequence[str]
) -> Mask:
    """Which columns have no derivative.

    Parameters
    ----------
    found : OptimumRates
    reasons : sequence of Reason
    places : Mapping
        As `Places`.
    pairs : sequence of str
        Their names, in the order of the columns by their friction.

    Returns
    -------
    ndarray of bool, shape (P,)
    """
    bad = np.asarray(found.opens.any(axis=0))
    for _, own in found.contradicts:
        bad = bad | own
    by_field = (*reason.ONE_SIDED, reason.CONTRADICTION)
    for why in reasons:
        for name in why.fields if why.kind not in by_field else ():
            own = bad[places[name]]
            if why.kind == reason.ZERO_FRICTION:  # that of the pair alone
                own[list(pairs).index(why.where[0])] = True
            else:
                own[:] = True
    return np.asarray(bad)

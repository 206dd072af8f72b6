"""Which rows of the program, and which targets, stand in the way of derivatives."""

from collections.abc import Set

import numpy as np

from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.numbers.arrays import Mask
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.optimum_rates import OptimumRates
from quasistatic_ref.optional.derivatives.step.reason import Obstacle, Reason
from quasistatic_ref.optional.derivatives.step.touching import Touching
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.cones import cone
from quasistatic_ref.tolerances import ON_RIM


def target_obstacles(simulator: Simulator, rates: StepRates) -> list[Obstacle]:
    """Joints whose target is half a turn away.

    Parameters
    ----------
    simulator : Simulator
    rates : StepRates
    """
    change = rates.result.step.delta_q_bar_a
    obstacles = []
    for joint in simulator.system.joints:
        turn = change[joint.v][joint.lengths :]
        if (
            joint.unit_vector
            and joint.v.stop <= len(change)
            and np.linalg.norm(turn) >= np.pi - ON_RIM
        ):
            says = f"{joint.name}: the target is half a turn away, where (-) jumps"
            fields = ("dq_dq", "dq_dq_bar_a")
            obstacles.append(rates.obstacle(reason.HALF_TURN, (joint.name,), fields, says))
    return obstacles


def row_obstacles(
    simulator: Simulator,
    rates: StepRates,
    touching: Touching,
    optimum_rates: OptimumRates,
    near: Set[tuple[int, ...]],
) -> list[Obstacle]:
    """Rows that stand in the way of some parameters.

    Parameters
    ----------
    simulator : Simulator
    rates : StepRates
    touching : Touching
    optimum_rates : OptimumRates
    near : set of (int, int)
        Contact and row of those that nearly touch, or nearly bear no load.
    """
    step = rates.result.step
    names = step.contacts.name
    row_names = cone(step.cone).row_names
    obstacles = []

    def add(kind: str, where: tuple[str, ...], bad: Mask, sentence: str) -> None:
        fields = tuple(name for name, place in rates.places.items() if bad[place].any())
        obstacles.append(Obstacle(Reason(kind, where, fields, sentence), bad))

    for contacts, bad in optimum_rates.contradicts.items():
        where = tuple(names[j] for j in contacts)
        says = f"the equations of {listed(where)} would contradict each other"
        add(reason.CONTRADICTION, where, bad, says)
    for (j, i), bad in zip(touching.idle.tolist(), optimum_rates.opens, strict=True):
        if bad.any():
            row = f"row {row_names[i]} of {names[j]}"
            kind = reason.WEAK
            says = f"{row} touches without load: it holds on one side only"
            if (j, i) in near:
                kind = reason.NEARLY
                says = f"settled: nearly a kink at {row}"
            add(kind, (names[j], row_names[i]), bad, says)
    touched = {names[j].rpartition("/")[0] for j in touching.contacts}
    for p, pair in enumerate(simulator.pairs):
        for key, used in (("mu_v", True), ("mu_omega", pair.rows == 6)):
            if pair.name in touched and used and getattr(pair, key) == 0:
                says = f"{key} of {pair.name} is zero, cannot be smaller, and the pair touches"
                bad = np.zeros(len(rates.units), dtype=bool)
                bad[rates.places[f"dq_d{key}"].start + p] = True
                add(reason.ZERO_FRICTION, (pair.name,), bad, says)
    return obstacles

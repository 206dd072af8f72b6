"""What a solution asks of parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.parts import needing

if TYPE_CHECKING:
    from quasistatic_ref.certify.optimum import ContactForces
    from quasistatic_ref.numbers.arrays import Array
    from quasistatic_ref.step.data import StepData


def contact_forces(step: StepData, near: tuple[Array, Array] | None) -> ContactForces:
    """``forces``: those of a step's contacts, sought from where a solution shows them to be.

    Parameters
    ----------
    step : StepData
    near : (ndarray, ndarray), optional
        delta_q, shape (n_v,) [m, rad], and wrenches, shape (n_c, 4) [N, N m], of the solution.
    """
    with needing("forces"):
        from quasistatic_ref.optional.forces.forces import contact_forces as forces
    return forces(step, near=near)

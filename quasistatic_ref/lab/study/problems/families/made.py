"""What a family yields: a step, and what is worth knowing about it."""

from dataclasses import dataclass, field

import numpy as np

from quasistatic_ref.step.data import StepData


@dataclass(frozen=True, eq=False)
class Made:
    """One step of a family.

    Parameters
    ----------
    id : str
    family : str
    step : StepData
    mass_ratio : float
        Largest diagonal entry of M_u over the smallest [-]; entries have different units, so a
        single body has one too. Of a family that sets it, the ratio that was set.
    k : int
        Closest points per pair; 0 where nothing was selected.
    dial : float or None
        The number that the family scales [the unit of its dial].
    tags : tuple of str
        What else tells it from others of its family.
    sequence : (str, int) or None
        The sequence of steps that it is one of, and its place there.
    """

    id: str
    family: str
    step: StepData
    mass_ratio: float
    k: int
    dial: float | None = None
    tags: tuple[str, ...] = field(default=())
    sequence: tuple[str, int] | None = None


def mass_ratio(step: StepData) -> float:
    """Largest over smallest diagonal entry of M_u; 1 where nothing is un-actuated [-]."""
    masses = np.diag(step.M_u)
    return float(masses.max() / masses.min()) if masses.size else 1.0

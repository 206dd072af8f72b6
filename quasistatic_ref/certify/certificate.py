"""What is claimed about an answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import HasPage
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.files import step_sha256

Claims = Mapping[str, tuple[str, ...]]
"""The kinds of certificate in a cone, each with its further fields in a solution file."""

CLAIMS: Claims = {
    "exact": (
        "active", "multipliers_unique", "differentiable", "smallest_inactive_slack",
        "smallest_active_multiplier", "error_bound",
    ),
    "residual": (),
    "none": (),
}  # fmt: skip
"""Those of a polyhedral cone."""


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Plain, HasPage):
    """What is known about an answer, and how.

    Parameters
    ----------
    kind : str
        ``"exact"`` (delta_q is the exact optimum, correctly rounded), ``"enclosure"`` (in the
        ellipsoid: delta_q is proved to be as near to the optimum as error_bound says),
        ``"residual"`` (optimality residuals were computed and are small) or ``"none"``.
    residuals : mapping of str to float
        Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` in natural units [-]. They differ in the last
        places from processor to processor, prove nothing, and never enter a solution file.
    active : tuple of (int, int)
        Contact and row of each member of the working set; the user's own rows count as those of
        one contact more. The rows of the working set are independent, their multipliers positive
        and their slacks zero. In the ellipsoid, for ``"exact"``: the first independent rows of the
        contacts that bear load.
    multipliers_unique : bool or None
        Whether lam may be compared component by component. Here and below None: nothing is claimed.
    differentiable : bool or None
        Whether delta_q is differentiable with respect to the forces and targets (g).
    smallest_inactive_slack : float or None
        Smallest slack [m] of the rows that are not strictly active: 0.0 where delta_q is not
        differentiable. None if there are no such rows.
    smallest_active_multiplier : float or None
        Smallest multiplier [N s] of the working set. None if that is empty.
    error_bound : float or None
        Of an enclosure: a bound of the error of delta_q, by its one definition (certify/norm.py)
        [-]. 0.0 for ``"exact"``, where the only error is the correct rounding of each entry.
    gap : float or None
        The duality gap of lam in the ellipsoid, no distance: a bound of f(delta_q*) - d(lam)
        [N m s].
    step : StepData or None
        What it is about. Only kind ``"none"``, which claims nothing, is about no step.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.solve_step(step).certificate.kind
    'exact'
    """

    kind: str
    residuals: Mapping[str, float] = field(default_factory=dict)
    active: tuple[tuple[int, int], ...] = ()
    multipliers_unique: bool | None = None
    differentiable: bool | None = None
    smallest_inactive_slack: float | None = None
    smallest_active_multiplier: float | None = None
    error_bound: float | None = None
    gap: float | None = None
    step: StepData | None = None

    @property
    def step_sha256(self) -> str | None:
        """SHA-256 of the step that it is about, as in a solution file; formed when it is read."""
        return None if self.step is None else step_sha256(self.step)

    def is_of(self, step: StepData) -> bool:
        """Whether it is about this step: the same object, or one with the same SHA-256."""
        return self.step is step or self.step_sha256 == step_sha256(step)

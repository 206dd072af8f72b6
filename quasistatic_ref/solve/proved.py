"""What is said of a proved answer: what takes time is formed when it is read.

A step of a run is proved, and mostly nobody asks how its rows touch, or how near its backend came.
No exact form outlives the step: these follow from the step and its answer once more.
"""

from __future__ import annotations

from functools import cached_property

from quasistatic_ref.certify.degeneracy import Degeneracy, step_degeneracy
from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.groups import contact_rows
from quasistatic_ref.certify.norm import correct_digits
from quasistatic_ref.certify.solution import Certificate, SolverStatistics
from quasistatic_ref.formats.plain import Late
from quasistatic_ref.numbers.arrays import Array, without_warnings
from quasistatic_ref.solve.units import ScaledStep, in_natural, natural_form
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form
from quasistatic_ref.step.units import Units


class _ByGroups(ScaledStep):
    """A step whose standard form is built group by group, in natural units."""

    @cached_property
    def natural_by_group(self) -> list[StandardForm]:
        """The standard form of each group in the natural units of the step."""
        units = self.units
        return [
            natural_form(standard_form(part), units._replace(coordinate=units.coordinate[of_step]))
            for (of_step, *_), part in self.groups
        ]


class ExactCertificate(Late, Certificate):
    """The certificate of an exact optimum; its other fields are computed when they are read.

    Attributes
    ----------
    working_set : tuple of int
        Rows of the step.
    units : Units
        Its natural units.
    delta_q, lam : ndarray, shapes (n_v,) and (m,)
        The answer [m, rad], [N s].
    """

    formed = (
        "active",
        "residuals",
        "multipliers_unique",
        "differentiable",
        "smallest_inactive_slack",
    )
    kept_instead = ("working_set", "units", "delta_q", "lam")
    working_set: tuple[int, ...]
    step: StepData
    units: Units
    delta_q: Array
    lam: Array

    @cached_property
    def active(self) -> tuple[tuple[int, int], ...]:
        """Contact and row of each member of the working set."""
        return contact_rows(self.step, self.working_set)

    @cached_property
    def residuals(self) -> dict[str, float]:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at the rounded answer, in natural units [-]."""
        return without_warnings(answer_residuals, self.step, self.units, self.delta_q, self.lam)

    @cached_property
    def degeneracy(self) -> Degeneracy:
        """Whether multipliers are unique and delta_q is differentiable at the optimum."""
        return without_warnings(step_degeneracy, self.step, self.working_set)

    @property
    def multipliers_unique(self) -> bool:
        """Whether lam may be compared component by component."""
        return self.degeneracy.multipliers_unique

    @property
    def differentiable(self) -> bool:
        """Whether delta_q is differentiable with respect to the forces and targets (g)."""
        return self.degeneracy.differentiable

    @property
    def smallest_inactive_slack(self) -> float | None:
        """Smallest slack [m] of the rows that are not strictly active."""
        return self.degeneracy.smallest_inactive_slack


def exact_certificate(step: StepData, optimum: ExactOptimum, units: Units) -> Certificate:
    """The certificate of an exact optimum.

    Parameters
    ----------
    step : StepData
    optimum : ExactOptimum
        That of the step.
    units : Units
        Natural units of the step.
    """
    certificate: Certificate = ExactCertificate.unchecked(
        kind="exact",
        working_set=optimum.working_set,
        smallest_active_multiplier=optimum.smallest_active_multiplier,
        error_bound=0.0,
        gap=None,
        step=step,
        units=units,
        delta_q=optimum.delta_q,
        lam=optimum.lam,
    )
    return certificate


class ProofStatistics(Late, SolverStatistics):
    """The statistics of a solver whose answer can be compared with the optimum.

    Attributes
    ----------
    step : StepData
    answer, delta_q : ndarray, shape (n_v,)
        The solver's displacement and the optimum [m, rad].
    """

    formed = ("digits",)
    kept_instead = ("step", "answer", "delta_q")
    step: StepData
    answer: Array
    delta_q: Array

    @cached_property
    def digits(self) -> float:
        """Correct digits of the backend's delta_q, 0 to 16."""
        return without_warnings(correct_digits, self.step, self.answer, self.delta_q)


def proof_statistics(
    statistics: SolverStatistics, seconds: float, step: StepData, answer: Array, delta_q: Array
) -> SolverStatistics:
    """Statistics of a solver that gave an answer, with the time of the proof and the digits.

    Parameters
    ----------
    statistics : SolverStatistics
    seconds : float
        Wall time of the proof [s].
    step : StepData
    answer, delta_q : ndarray, shape (n_v,)
        Its answer, and the optimum [m, rad].
    """
    fields = vars(statistics) | {"proof_time": seconds}
    del fields["digits"]
    complete: SolverStatistics = ProofStatistics.unchecked(
        **fields, step=step, answer=answer, delta_q=delta_q
    )
    return complete


def answer_residuals(step: StepData, units: Units, delta_q: Array, lam: Array) -> dict[str, float]:
    """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at an answer [-], by name.

    Parameters
    ----------
    step : StepData
    units : Units
        Its natural units.
    delta_q, lam : ndarray, shapes (n_v,) and (m,)
        [m, rad], [N s].
    """
    scaled = _ByGroups(step, units)
    return dict(vars(scaled.residuals(*in_natural(delta_q, lam, units))))

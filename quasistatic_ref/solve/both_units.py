"""A step in SI units and in natural units."""

import math
from functools import cached_property
from typing import Protocol

import numpy as np

from quasistatic_ref.certify.residuals import Residuals, optimality_residuals
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.solve.units import (
    Units,
    hessian_in_both_units,
    natural_form,
    natural_step,
    squared_lengths,
    units_of,
)
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form


class StepInBothUnits(Protocol):
    """A step in SI units and in its natural units, in which answers are judged."""

    si_step: StepData
    units: Units

    @property
    def si_form(self) -> StandardForm:
        """Its standard form in SI units; H and A may be sparse."""

    @property
    def natural_form(self) -> StandardForm:
        """The same in natural units."""

    def natural_residuals(self, delta_q: Array, lam: Array) -> Residuals:
        """Residuals of delta_q (n_v,) and lam (m,), all in natural units [-]."""


class DenseStepInBothUnits:
    """A step of dense matrices, with its standard form, in SI units and in natural units.

    Parameters
    ----------
    si_step : StepData

    Raises
    ------
    StepDataError
        If products of its numbers leave the range of float64.
    """

    def __init__(self, si_step: StepData) -> None:
        self.si_step = si_step
        self.si_form = standard_form(si_step)
        try:
            self.hessian = hessian_in_both_units(self.si_form.H)
            self.units = units_of(self.si_form, self.hessian)
        except np.linalg.LinAlgError:
            raise out_of_range(si_step) from None
        check_units(self.units, si_step, self.hessian.usable)

    @cached_property
    def natural_step(self) -> StepData:
        """The step in its natural units."""
        try:
            return natural_step(self.si_step, self.units)
        except StepDataError:
            raise out_of_range(self.si_step) from None

    @cached_property
    def natural_form(self) -> StandardForm:
        """Its standard form in natural units."""
        return natural_form(self.si_form, self.units, self.hessian.natural_H)

    @property
    def row_ratio(self) -> float:
        """Length of the longest row over that of the shortest, rows of zeros left out [-]."""
        squares = squared_lengths(self.si_form, self.hessian)
        first = int(squares.searchsorted(0.0, side="right"))
        return math.sqrt(squares[-1] / squares[first]) if first < len(squares) else 1.0

    def natural_residuals(self, delta_q: Array, lam: Array) -> Residuals:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at delta_q (n_v,), lam (m,) in units [-]."""
        judge = cone(self.si_step.cone).judge(self.si_step)
        return optimality_residuals(self.natural_form, delta_q, lam, judge)


def check_units(units: Units, step: StepData, usable: bool = True) -> None:
    """Refuse a step whose units, or those of its coordinates, are not finite and positive.

    Raises
    ------
    StepDataError
    """
    if not (usable and 0 < units.length < math.inf and 0 < units.size < math.inf):
        raise out_of_range(step)


def out_of_range(step: StepData) -> StepDataError:
    """The error about a step whose numbers are finite, but not what is made of them."""
    step.replace()  # says so, if they are not
    return StepDataError(
        "its numbers are too large, too small or too different: products of them exceed the "
        "range of float64; look for a wrong unit"
    )

"""A step beside itself in natural units."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.solve.units import Metric, metric, to_natural, units_of
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import standard_form


class Scaled:
    """A step, its standard form and its natural units.

    Parameters
    ----------
    step : StepData
        SI units.
    like : Metric, optional
        Of an earlier step: taken over if H is the same array.

    Raises
    ------
    StepDataError
        If products of its numbers leave the range of float64.
    """

    def __init__(self, step: StepData, like: Metric | None = None) -> None:
        self.step, self.form = step, standard_form(step)
        try:
            kept = like if like is not None and like.H is self.form.H else None
            self.metric = metric(self.form.H) if kept is None else kept
            self.units = units_of(self.form, self.metric)
        except np.linalg.LinAlgError:
            raise out_of_range(step) from None
        finite = 0 < self.units.length < math.inf and 0 < self.units.size < math.inf
        if not (finite and self.metric.usable):
            raise out_of_range(step)

    @cached_property
    def natural(self) -> StepData:
        """The step in its natural units."""
        try:
            return to_natural(self.step, self.units)
        except StepDataError:
            raise out_of_range(self.step) from None


def out_of_range(step: StepData) -> StepDataError:
    """The error about a step whose numbers are finite, but not what is made of them."""
    step.replace(contacts=replace(step.contacts))  # says so, if they are not
    return StepDataError(
        "its numbers are too large, too small or too unlike each other: their products leave the "
        "range of float64; look for a wrong unit"
    )

"""A step in natural units, with what is known of them before."""

import numpy as np

from quasistatic_ref.solve.natural_step import DenseStep, check_units, out_of_range
from quasistatic_ref.solve.units import NaturalHessian, Units, natural_hessian, units_of
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form


class KeptStep(DenseStep):
    """A step in natural units that takes over what is known of them.

    Parameters
    ----------
    step : StepData
    template : NaturalHessian or None
        Of an earlier step: taken over if H is the same array.
    form : StandardForm, optional
        That of the step, where it is known.
    units : Units, optional
        Its natural units, where they are known.
    """

    def __init__(
        self,
        step: StepData,
        template: NaturalHessian | None,
        form: StandardForm | None = None,
        units: Units | None = None,
    ) -> None:
        self.step = step
        self.form = standard_form(step) if form is None else form
        try:
            if template is None or template.H is not self.form.H:
                template = natural_hessian(self.form.H)
            self.metric = template
            self.units = units_of(self.form, template) if units is None else units
        except np.linalg.LinAlgError:
            raise out_of_range(step) from None
        check_units(self.units, step, template.usable)

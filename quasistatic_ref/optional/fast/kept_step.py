"""A step in both units, with what is known of them before."""

from quasistatic_ref.solve.units import (
    DenseStepInBothUnits,
    HessianInBothUnits,
    Units,
    check_units,
    units_of,
)
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form


class KeptStepInBothUnits(DenseStepInBothUnits):
    """A step in SI and natural units that takes over what is known of them.

    Parameters
    ----------
    si_step : StepData
    hessian : HessianInBothUnits or None
        Of an earlier step: taken over if H is the same array.
    si_form : StandardForm, optional
        That of the step, where it is known.
    units : Units, optional
        Its natural units, where they are known.
    """

    def __init__(
        self,
        si_step: StepData,
        hessian: HessianInBothUnits | None,
        si_form: StandardForm | None = None,
        units: Units | None = None,
    ) -> None:
        if hessian is None or hessian.H is not si_step.H:
            super().__init__(si_step)
            return
        self.si_step = si_step
        self.si_form = standard_form(si_step) if si_form is None else si_form
        self.hessian = hessian
        self.units = units_of(self.si_form, hessian) if units is None else units
        check_units(self.units, si_step, hessian.usable)

"""A step without an answer that can be trusted: unsolved, proved to have none, or ill-posed."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.certify.farkas import FarkasVector
from quasistatic_ref.certify.residuals import Residuals
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData


class StepNotSolved(QuasistaticError):
    """A solver gave no answer that can be trusted.

    Carries everything that is needed to replay the step.

    Parameters
    ----------
    backend : str
        Name in the table of backends.
    status : str
        What the solver said, or why its answer was not taken.
    step : StepData
        The step in SI units, as given.
    accuracy : float
        The accuracy of the call, in natural units [-].
    residuals : Residuals, optional
        Residuals of the refused answer, where there was one.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> walls = qr.Extra(names=("up", "down"), A=np.eye(6)[2] * [[1], [-1]], b=[1e-3, 1e-3])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepNotSolved as error:
    ...     print(error.status, error.step.n_v)
    infeasible 6
    """

    def __init__(
        self,
        backend: str,
        status: str,
        step: StepData,
        accuracy: float,
        residuals: Residuals | None = None,
    ) -> None:
        self.backend = backend
        self.status = status
        self.step = step
        self.accuracy = accuracy
        self.residuals = residuals
        super().__init__(
            f"{backend} did not solve the step ({status}; accuracy {accuracy:g}); "
            "try another backend, or check the step"
        )


class StepInfeasible(StepNotSolved):
    """No displacement satisfies the rows of the step; this is proved, not a solver's opinion.

    Parameters
    ----------
    step : StepData
        The step in SI units, as given.
    farkas : FarkasVector
        The proof: a combination of the rows that reads 0 >= something positive.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> walls = qr.Extra(names=("up", "down"), A=np.eye(6)[2] * [[1], [-1]], b=[1e-3, 1e-3])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepInfeasible as error:
    ...     print(error.status)
    infeasible
    """

    def __init__(self, step: StepData, farkas: FarkasVector) -> None:
        super().__init__("exact", "infeasible", step, 0.0)
        self.farkas = farkas
        remedy = "widen these gaps, or make one of the bodies compliant"
        if np.count_nonzero(farkas.y) == 1:
            remedy = "its coefficients are all zero, so that nothing moves it: leave it out"
        self.args = (
            f"the step has no solution: {farkas.in_words} (proved without rounding); {remedy}",
        )


class StepIllPosed(StepNotSolved):
    """The exact optimum is known and absurd: the rows contradict each other but for rounding.

    Parameters
    ----------
    step : StepData
        The step in SI units, as given.
    delta_q : ndarray, shape (n_v,)
        The exact optimum [m, rad], correctly rounded.
    length : float
        Its length in the H norm, over the largest that the loads or a row ask for alone [-].

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> A = [[1, 0, 0, 0, 0, 0], [-1, 1e-12, 0, 0, 0, 0]]  # opposite but for 1e-12
    >>> walls = qr.Extra(names=("left", "right"), A=A, b=[1e-3, 1e-3])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepIllPosed as error:
    ...     print(error.length > 1e6)
    True
    """

    def __init__(self, step: StepData, delta_q: Array, length: float) -> None:
        super().__init__("exact", "ill-posed", step, 0.0)
        self.delta_q = delta_q
        self.length = length
        self.args = (
            f"the exact optimum is {length:.0e} times longer than the step's forces, targets and "
            "gaps explain, because its contacts almost contradict each other; look for opposite "
            "normals",
        )

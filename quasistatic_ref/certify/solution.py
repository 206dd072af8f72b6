"""The answer of one step."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from quasistatic_ref.certify.certificate import Certificate
from quasistatic_ref.certify.contact_forces import ContactForces
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import Array, read_only, without_warnings
from quasistatic_ref.parts import contact_forces
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import contact_wrenches

UNKNOWN = "are not known: a step holds no costs or nonlinear constraints"


@dataclass(frozen=True, eq=False)
class SolverStatistics(Plain):
    """What the solver said and what it cost; never evidence, never written to a solution file.

    Parameters
    ----------
    backend : str
    status : str
        The solver's own word.
    iterations : int or None
    solve_time : float or None
        Time inside the solver [s], where it reports one.
    accuracy : float
        The accuracy that was asked of the solver, in natural units [-].
    digits : float or None
        Correct digits of the backend's delta_q, 0 to 16, where the exact answer is known.
    interface : str
        The interface by which the solver was called: ``"cvxpy"``, ``"qpsolvers"``, ``"native"``;
        ``"none"`` without a backend.
    proof_time : float
        Wall time of the proof, or of the residuals [s]; 0 where nothing is claimed.
    unanswered : bool
        Whether the backend was wanted, and gave no answer: it has no digits then.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.solve_step(step, "clarabel").statistics.status
    'optimal'
    """

    backend: str
    status: str
    iterations: int | None
    solve_time: float | None
    accuracy: float
    digits: float | None = None
    interface: str = "cvxpy"
    proof_time: float = 0.0
    unanswered: bool = False


@dataclass(frozen=True, eq=False, repr=False)
class StepSolution(Plain, Shown):
    """The optimum of Eq. :eq:`eq-13`.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
        Displacement [m, rad] in the paper's order.
    lam : ndarray, shape (m,)
        Multipliers of all rows, contact-major: impulses [N s]. In the ellipsoid, each contact's
        impulse (n, d1, d2, spin) [N s, N s, N s, N m s]. Those of the user's own rows come last
        [N s, for rows in m].
    step : StepData
        The step whose optimum this is.
    certificate : Certificate
    statistics : SolverStatistics
        Not compared by ``==``, because it holds wall times.
    net_impulse : ndarray, shape (n_v,), or None
        A'lam [N s, N m s] of a certified optimum, correctly rounded, in the ellipsoid to within the
        enclosure; None where nothing is proved.
    alone : bool
        Whether the step is all that was solved: no costs or nonlinear constraints of an extension.

    Notes
    -----
    The arrays are not copied, but made read-only.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> solution = qr.solve_step(step)
    >>> solution.delta_q.shape, solution.wrench.shape
    ((6,), (1, 4))
    """

    delta_q: Array
    lam: Array
    step: StepData
    certificate: Certificate
    statistics: SolverStatistics = field(compare=False)
    net_impulse: Array | None = None
    alone: bool = True

    def __post_init__(self) -> None:
        for array in (self.delta_q, self.lam, self.net_impulse):
            if array is not None:
                array.setflags(write=False)

    @cached_property
    def forces(self) -> Array:
        """Each contact's (f_d1, f_d2, f_n, tau_n) on beta's body, shape (n_c, 4) [N, N m].

        They are those of the step in which each contact gives way a little, and therefore unique;
        see :mod:`~quasistatic_ref.optional.forces.forces`. They are formed from the step when
        they are read, however it was solved.

        Raises
        ------
        InputError
            If the step is not all that was solved, or there is no ``optional/forces``.
        """
        return self.compliant.wrench

    @property
    def imbalance(self) -> float:
        """The share of the load that the forces leave, at most some 1e-6 as a rule [-].

        That of :class:`~quasistatic_ref.certify.contact_forces.ContactForces`.
        """
        return self.compliant.imbalance

    @cached_property
    def compliant(self) -> ContactForces:
        """The forces, and delta_q of the step with compliance; InputError as of `forces`."""
        if not self.alone:
            raise InputError(UNKNOWN, field="forces")
        return contact_forces(self.step, (self.delta_q, self.wrench))

    @cached_property
    def wrench(self) -> Array:
        """What lam combines to, as (f_d1, f_d2, f_n, tau_n) [N, N m], shape (n_c, 4).

        It is the proof's: one of several where multipliers are not unique.
        """
        step = self.step
        lam = self.lam[: step.offsets[-1]]
        wrench = without_warnings(contact_wrenches, step.contacts, lam, step.h, step.cone)
        return read_only(wrench)

    @property
    def proved(self) -> bool:
        """Whether it is proved: to be the optimum, or within its certificate's error bound."""
        return self.certificate.kind in ("exact", "enclosure")

    @property
    def lam_extra(self) -> Array:
        """Multipliers of the user's own rows, the last of lam, shape (extra rows,) [N s]."""
        return self.lam[self.step.offsets[-1] :]

    @property
    def backend(self) -> str:
        """The backend that was asked."""
        return self.statistics.backend

    @property
    def cone(self) -> str:
        """The friction cone of its contacts."""
        return self.step.cone

    @property
    def status(self) -> str:
        """Always ``"optimal"``: a step without an accepted answer raises ``StepNotSolved``."""
        return "optimal"

"""A step's answer as data: its optimum, what is proved of it, and what the solver reported."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, read_only, without_warnings
from quasistatic_ref.parts import part
from quasistatic_ref.shown import HasPage, Shown
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.text import step_sha256
from quasistatic_ref.text.plain import Plain

ForcesOfStep = Callable[[StepData, None, tuple[Array, Array] | None], "ContactForces"]
"""A step, compliances (its own), and delta_q (n_v,) [m, rad] and wrenches (n_c, 4) [N, N m] to
begin from -> the forces of its contacts."""
Kind = Literal["exact", "enclosure", "residual", "none"]
"""What is proved of an answer."""
BORNE = 1e-4
"""Share of the load [-] that forces of single contacts may leave without a warning."""
UNKNOWN = "are not known: a step holds no costs or nonlinear constraints"


@dataclass(frozen=True, eq=False)
class SolverStatistics(Plain):
    """What the solver reported and how long it took: no evidence, and in no solution file.

    A :class:`.StepSolution` has them; their constructor checks nothing.

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

    ``solve_step`` makes it; its constructor checks nothing.

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
        they are read, however it was solved. A warning says so where they leave more than 1e-4 of
        the load.

        Raises
        ------
        InputError
            If the step is not all that was solved, or there is no ``optional/forces``.
        """
        warn_of_imbalance(self.imbalance)
        return self.compliant.wrench

    @property
    def imbalance(self) -> float:
        """The share of the load that the forces do not balance [-], mostly below 1e-6.

        That of :class:`~quasistatic_ref.step.solution.ContactForces`.
        """
        return self.compliant.imbalance

    @cached_property
    def compliant(self) -> ContactForces:
        """The forces, and delta_q of the step with compliance; InputError as of `forces`."""
        if not self.alone:
            raise InputError(UNKNOWN, field="forces")
        contact_forces: ForcesOfStep = part("contact_forces")
        return contact_forces(self.step, None, (self.delta_q, self.wrench))

    @cached_property
    def wrench(self) -> Array:
        """Contact wrenches that lam adds up to, (f_d1, f_d2, f_n, tau_n) [N, N m], (n_c, 4).

        It is the proof's: one of several where multipliers are not unique.
        """
        step = self.step
        lam = self.lam[: step.offsets[-1]]
        wrench = without_warnings(contact_wrenches, step.contacts, lam, step.h, step.cone)
        return read_only(wrench)

    @property
    def proved(self) -> bool:
        """Whether delta_q is proved: the optimum, or within the certificate's error bound of it."""
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


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Plain, HasPage):
    """What is proved about an answer, and the kind of proof.

    ``solve_step`` makes it; its constructor checks nothing.

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

    kind: Kind
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
        """SHA-256 of the step that this certificate is about, as in a solution file."""
        return None if self.step is None else step_sha256(self.step)

    def is_of(self, step: StepData) -> bool:
        """Whether the certificate is about this step: the same object or the same SHA-256."""
        return self.step is step or self.step_sha256 == step_sha256(step)


@dataclass(frozen=True, eq=False, repr=False)
class ContactForces(Shown):
    """The forces of a step's contacts.

    ``contact_forces`` makes them; their constructor checks nothing.

    Parameters
    ----------
    wrench : ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m].
    delta_q : ndarray, shape (n_v,)
        Where the step with compliance ends [m, rad].
    compliance : ndarray, shape (n_c,)
        c of each contact [m/N].
    imbalance : float
        The share of the load that the forces leave, the largest of all groups [-]: they balance
        the step at `delta_q`, not at the displacement x of the step without compliance. It is
        ||delta_q - x||_H over the norm ||h J'f||_{H^-1} of what the forces f exert; infinite where
        this is zero, as of a step without solution.
    sensitivity : float
        At most how much a force changes if each phi of its group changes by 1 m, over the sum of
        the group's normal forces, (R42), the largest of all groups [1/m].

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.contact_forces(step).imbalance < 1e-6
    True
    """

    wrench: Array
    delta_q: Array
    compliance: Array
    imbalance: float
    sensitivity: float

    def __post_init__(self) -> None:
        for array in (self.wrench, self.delta_q, self.compliance):
            read_only(array)


def warn_of_imbalance(imbalance: float) -> None:
    """Warn whoever reads forces that leave a share `imbalance` of the load [-], which is finite."""
    if BORNE < imbalance < float("inf"):
        words = f"forces of single contacts leave {imbalance:.1e} of the load: read wrench in "
        warnings.warn(f"{words}their place, or raise mu_v or mu_omega", stacklevel=3)

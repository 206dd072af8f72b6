"""What a friction cone without linear rows, such as the ellipsoid, has to provide."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, Protocol

from quasistatic_ref.certify.residuals import Judge, row_violations
from quasistatic_ref.certify.solution import CLAIMS, Certificate, Claims, Verdict
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import FrictionCone, Rows, cone
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    import cvxpy as cp


class Enclosed(Protocol):
    """The proved optimum of a step in a curved cone."""

    @property
    def delta_q(self) -> Array:
        """Shape (n_v,) [m, rad]."""

    @property
    def lam(self) -> Array:
        """Shape (m,) [N s]."""

    @property
    def net(self) -> Array:
        """A'lam, shape (n_v,) [N s, N m s]."""

    def certificate(self, step: StepData, residuals: Mapping[str, float]) -> Certificate:
        """The certificate of this optimum, with the given residuals in natural units [-]."""


class CurvedCone(FrictionCone):
    """A friction cone without linear rows: it proves the answers of its own steps.

    Each contact has four rows in A, J_n and its slips and spin, and as many multipliers. Everything
    that :class:`~quasistatic_ref.step.cones.PolyhedralCone` does by its rows, and the core by exact
    rows, it does itself.
    """

    polyhedral = False
    claims: ClassVar[Claims]
    """The kinds of certificate in it, each with its further fields in a solution file."""

    @abstractmethod
    def constraints(self, motion: Rows) -> list[cp.Constraint]:
        """The constraints on CVXPY's gap, slip_1, slip_2 and spin [m], each (n_c,)."""

    @abstractmethod
    def multipliers(self, constraints: Sequence[cp.Constraint], mu: Array) -> Array:
        """Lam of solved :meth:`constraints`, contact-major, shape (m,); `mu` as of contacts."""

    @abstractmethod
    def judge(self, mu: Array) -> Judge:
        """A function that measures the violation of Eqs. :eq:`eq-10`-:eq:`eq-12`.

        Parameters
        ----------
        mu : ndarray, shape (n_c, 3)
            As of contacts.

        Returns
        -------
        callable
            As :func:`~quasistatic_ref.certify.residuals.row_violations`, of all rows of A.
        """

    @abstractmethod
    def optimum(self, step: StepData, start: tuple[Array, Array] | None) -> Enclosed | None:
        """The optimum of a step with a proved error bound; None if the proof fails.

        Parameters
        ----------
        step : StepData
        start : (ndarray, ndarray), optional
            A backend's delta_q and lam, shapes (n_v,) [m, rad] and (m,) [N s].
        """

    @abstractmethod
    def in_words(self, certificate: Certificate) -> str:
        """What a certificate of kind ``"exact"`` claims, in a sentence."""

    @abstractmethod
    def forces(
        self, step: StepData, compliance: float, near: tuple[Array, Array]
    ) -> tuple[Array, Array]:
        """Contact forces of a group, (n_c, 4) [N, N m], and its displacement, (n_v,) [m, rad].

        Parameters
        ----------
        step : StepData
        compliance : float
            Of each contact [m/N].
        near : (ndarray, ndarray)
            delta_q (n_v,) [m, rad] and wrenches (n_c, 4) [N, N m] of the step without compliance.
        """

    @abstractmethod
    def verdict(
        self,
        step: StepData,
        delta_q: Array,
        active: Sequence[tuple[int, int]],
        lam: Array | None,
        claims: Certificate | None,
    ) -> Verdict:
        """As :func:`~quasistatic_ref.certify.verification.verify`."""


def curved_cone(step: StepData) -> CurvedCone | None:
    """The curved cone of a step; None if the step's cone is polyhedral."""
    of_step = cone(step.cone)
    return of_step if isinstance(of_step, CurvedCone) else None


def judge_of(step: StepData) -> Judge:
    """A function that measures the violation of Eqs. :eq:`eq-10`-:eq:`eq-12` in a step's cone."""
    curved = curved_cone(step)
    return row_violations if curved is None else curved.judge(step.contacts.mu)


def claims_of(step: StepData) -> Claims:
    """The claims that each kind of certificate makes in the cone of a step."""
    curved = curved_cone(step)
    return CLAIMS if curved is None else curved.claims

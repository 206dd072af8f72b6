"""What a friction cone without linear rows, such as the ellipsoid, has to provide."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Protocol

from quasistatic_ref.exact.verdict import Verdict
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import FrictionCone, cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import Certificate


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
        net: Array | None = None,
    ) -> Verdict:
        """Whether an answer in this cone holds, its wrench left out; as of ``verify_answer``.

        `net` is A'lam, shape (n_v,) [N s, N m s].
        """


def curved_cone(step: StepData) -> CurvedCone:
    """The cone of a step that is not polyhedral."""
    of_step = cone(step.cone)
    assert isinstance(of_step, CurvedCone)
    return of_step

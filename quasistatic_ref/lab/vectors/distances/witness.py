"""Closest points of two solids, in exact numbers."""

from dataclasses import dataclass, replace
from typing import Any

from quasistatic_ref.lab.vectors.exact.precision import Real, Vector


@dataclass(frozen=True, eq=False)
class Witness:
    """Closest points in the world frame: beta - alpha = phi n.

    Parameters
    ----------
    phi : number
        Signed distance [m].
    alpha, beta : vector
        [m].
    n : vector
        Of length one, from alpha's solid to beta's, also in penetration.
    unique : bool
        Whether alpha, beta and n have no alternative.
    """

    phi: Real
    alpha: Vector
    beta: Vector
    n: Vector
    unique: bool

    def swapped(self) -> "Witness":
        """The same with alpha and beta exchanged."""
        return Witness(self.phi, self.beta, self.alpha, -self.n, self.unique)

    def inflated(self, margin_alpha: Real, margin_beta: Real) -> "Witness":
        """The same of solids that have a ball about every point."""
        phi = self.phi - margin_alpha - margin_beta
        alpha = self.alpha + margin_alpha * self.n
        return replace(self, phi=phi, alpha=alpha, beta=self.beta - margin_beta * self.n)

    def table(self) -> dict[str, Any]:
        """The fields of the layer's output."""
        return {"phi": self.phi, "alpha": self.alpha, "beta": self.beta, "n": self.n}

"""How far a run may go before it is stopped: what lies beyond is a mistake, not a motion."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.numbers.arrays import Array, positive_number
from quasistatic_ref.simulate.record.failures import LimitExceeded
from quasistatic_ref.step.data import StepData


@dataclass(frozen=True)
class Limits:
    """The ``[limits]`` of a scenario.

    Parameters
    ----------
    penetration : float
        Deepest penetration at which a step is still taken [m]. The step's rows hold to first
        order, and push it out at once, with a force of m |phi| / h^2: bodies that start in each
        other, or pass through each other in one step, are thrown apart. 0.05 by default.
    reach : float
        Farthest that the origin of a link may come from that of the world [m]; 100 by default.

    Raises
    ------
    InputError
        If one of them is no number greater than 0.

    Examples
    --------
    >>> system = qr.System([qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3)])
    >>> qr.Simulator(system, [], h=0.01, K_q=1.0, limits=qr.Limits(reach=2.0)).limits.reach
    2.0
    """

    penetration: float = 0.05
    reach: float = 100.0

    def __post_init__(self) -> None:
        for name in ("penetration", "reach"):
            limit = positive_number(getattr(self, name), f"limits.{name}")
            object.__setattr__(self, name, limit)

    def out_of_reach(self, links: Sequence[str], t: Array) -> str | None:
        """Which link is out of the scene, in words; None if none is.

        Parameters
        ----------
        links : sequence of str
        t : ndarray, shape (L, 3)
            Origins of the links [m], world frame.
        """
        if np.vdot(t, t) <= self.reach * self.reach:  # all of them together
            return None
        distance = np.hypot.reduce(t, axis=1)
        beyond = np.flatnonzero(~(distance <= self.reach))  # NaN is beyond, too
        if not beyond.size:
            return None
        i = beyond[0]
        return (
            f"link {links[i]} is {distance[i]:.3g} m from the origin, farther than "
            f"limits.reach = {self.reach:g} m; support it, check its wrenches and targets, or "
            "raise the limit"
        )

    def check_reach(self, step: StepData, links: Sequence[str], t: Array) -> None:
        """Refuse a step after which a link is out of the scene.

        Raises
        ------
        LimitExceeded
        """
        problem = self.out_of_reach(links, t)
        if problem is not None:
            raise LimitExceeded(problem, step)

    def check_penetration(self, step: StepData) -> None:
        """Refuse a step that starts deeper in penetration than any step should.

        Raises
        ------
        LimitExceeded
        """
        if step.deepest > self.penetration:
            phi = step.contacts.phi
            j = int(phi.argmin())
            raise LimitExceeded(
                f"contact {step.contacts.name[j]} is {-phi[j]:.3g} m deep, deeper than "
                f"limits.penetration = {self.penetration:g} m; start the bodies apart, move "
                "slower or take a smaller h, or raise the limit",
                step,
            )

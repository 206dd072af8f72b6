"""What a scenario and a simulator have in common: bodies, contacts, and how steps are solved."""

from dataclasses import dataclass, field, fields
from typing import Any

from quasistatic_ref.errors import check_kind
from quasistatic_ref.numbers.arrays import Array, Mask, freeze_copies, positive_number
from quasistatic_ref.simulate.distance_source import CLOSED, Distances, measured_pairs
from quasistatic_ref.simulate.law import CONVEX, Law, check_law
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.scene import Scene
from quasistatic_ref.solve.backends import CERTIFY, DEFAULT, Certify, check_backend, name_here
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.tolerances import ACCURACY


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Settings(Scene):
    """The checked settings that a scenario and a simulator share.

    Parameters
    ----------
    system, pairs
        As of :class:`~quasistatic_ref.simulate.scene.Scene`.
    h : float
        Time step [s].
    K_q : ndarray, shape (n_a, n_a)
        Stiffness of the actuated coordinates [N/m, N m/rad].
    gravity : ndarray, shape (3,)
        [m/s^2], world frame.
    gravity_acts : ndarray of bool, shape (n_a,)
        Whether gravity acts on each actuated coordinate.
    backend, accuracy, certify
        As of :func:`~quasistatic_ref.solve.solve.solve_step`, the backend by its name.
    cone : str
        Friction cone of every contact; see :mod:`~quasistatic_ref.step.cones`.
    law : str
        ``"convex"``, the model's, or ``"coulomb"``, without the rise of sliding contacts.
    distances : str
        ``"closed"``, closed forms, or ``"coal"``, coal's distances of points of clouds as they are.
    limits : Limits
        Penetration and reach beyond which a run ends.

    Raises
    ------
    InputError
        If the accuracy, what is to be certified, the law, the distances or the backend is
        none, or they do not go together.
    ContactError
        If the distances do not suit a pair.
    """

    h: float
    K_q: Array
    gravity: Array
    gravity_acts: Mask
    backend: str = DEFAULT
    accuracy: float = ACCURACY
    certify: Certify = CERTIFY[0]
    cone: str = PYRAMID
    law: Law = CONVEX
    distances: Distances = CLOSED
    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        check_kind(self.limits, Limits, "limits", "Limits(penetration=..., reach=...)")
        object.__setattr__(self, "accuracy", positive_number(self.accuracy, "accuracy"))
        check_law(self.law, self.certify)
        measured_pairs(self.pairs, self.distances)
        object.__setattr__(self, "backend", name_here(self.backend))
        check_backend(self.backend, self.cone, self.certify)
        freeze_copies(self, "K_q", "gravity", "gravity_acts")

    def settings(self) -> dict[str, Any]:
        """All settings by name."""
        return {setting.name: getattr(self, setting.name) for setting in fields(Settings)}

"""The solvers of a study, by the interface through which they are called, and their settings."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from quasistatic_ref.lab.study.calling.guests import EVERY
from quasistatic_ref.solve.backends import Backend

INTERFACES = ("cvxpy", "qpsolvers", "native", "package", "callable", "executable")


@dataclass(frozen=True)
class Setting:
    """One column of a study.

    Parameters
    ----------
    name : str
    accuracy : float or None
        Of residuals and gap, in the units of the problem as given [-]; None: the default.
    promised : float
        Correct digits [-] of delta_q that an "optimal" promises.
    tuned : bool
        The options that the simulator uses in place of the plain ones.
    """

    name: str
    accuracy: float | None
    promised: float
    tuned: bool = False


# By strong convexity ||x - x*||_H^2 <= 2 gap, so that an accuracy of eps promises an error of
# sqrt(2 eps) in natural units, about half of its digits. A default is expected to give at least 3.
SETTINGS = (
    Setting("default", None, 3.0),
    Setting("low", 1e-3, 1.0),
    Setting("mid", 1e-6, 2.5),
    Setting("high", 1e-9, 4.0),
    Setting("tuned", 1e-12, 5.5, tuned=True),
)


@dataclass(frozen=True)
class Solver:
    """One solver of a study.

    Parameters
    ----------
    name : str
    interface : str
        One of ``INTERFACES``.
    target : str or tuple of str
        The solver's name there; ``module:function``; or a command with its arguments.
    options : mapping of str to mapping
        Options of its own by setting, in place of ours.
    """

    name: str
    interface: str
    target: str | tuple[str, ...]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """Interface and name, unique in a study."""
        return f"{self.interface}:{self.name}"

    @property
    def warm(self) -> bool:
        """Whether a start can be handed to it."""
        return self.known and self.interface in self.entry.warm

    @property
    def known(self) -> bool:
        """Whether its options are in our table."""
        return self.interface in ("cvxpy", "qpsolvers", "native")

    @property
    def entry(self) -> Backend:
        """What the table says of it, if it is known."""
        return EVERY[str(self.target)]

    def takes(self, setting: Setting) -> bool:
        """Whether a setting means anything to it."""
        if setting.name in self.options:
            return True
        has_accuracy = self.known and self.entry.plain is not None
        return setting.accuracy is None or has_accuracy

    def settings_of(self, setting: Setting, seconds: float) -> dict[str, Any]:
        """The options that a setting is to this solver.

        Parameters
        ----------
        setting : Setting
        seconds : float
            The time limit of a problem [s].
        """
        if setting.name in self.options:
            return dict(self.options[setting.name])
        if not self.known:
            return {}
        entry, accuracy = self.entry, setting.accuracy
        limit: dict[str, Any] = {entry.time_limit: seconds} if entry.time_limit else {}
        if accuracy is None or entry.plain is None:
            return limit
        return entry.first(accuracy) | limit if setting.tuned else limit | entry.plain(accuracy)

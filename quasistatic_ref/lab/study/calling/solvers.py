"""The solvers of a study, by the interface through which they are called, and their settings."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from quasistatic_ref.lab.study.calling.claims import claim
from quasistatic_ref.lab.study.calling.options import has_accuracy, option_file, options_at
from quasistatic_ref.lab.study.calling.promises import RESIDUALS, Promise, promise_of, resolved
from quasistatic_ref.lab.study.calling.study_only import EVERY
from quasistatic_ref.solve.backends import BACKENDS, Backend

INTERFACES = ("cvxpy", "qpsolvers", "native", "package", "callable", "executable")


@dataclass(frozen=True)
class Setting:
    """One column of a study.

    Parameters
    ----------
    name : str
    accuracy : float or None
        Of residuals and gap, in the units of the problem as given [-]; None: the default.
    promised : float or None
        Correct digits [-] of delta_q that an "optimal" promises; None: residuals, as each solver
        promises them.
    tuned : bool
        The options that the simulator uses in place of the plain ones.
    """

    name: str
    accuracy: float | None
    promised: float | None = None
    tuned: bool = False


SETTINGS = (
    Setting("default", None),
    Setting("low", 1e-3),
    Setting("mid", 1e-6),
    Setting("high", 1e-9),
    Setting("tuned", 1e-12, tuned=True),
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
    promised : mapping of str to number or mapping
        By setting, what its author promises: digits [-], or residuals as in ``promises.py``.
    """

    name: str
    interface: str
    target: str | tuple[str, ...]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    promised: Mapping[str, float | Mapping[str, Any]] = field(default_factory=dict)

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
        return setting.accuracy is None or (self.known and has_accuracy(str(self.target)))

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
        name = str(self.target)
        entry = self.entry
        accuracy = setting.accuracy
        always = option_file(name).get("always", {})
        limit: dict[str, Any] = {entry.time_limit: seconds} if entry.time_limit else {}
        limit |= always
        if accuracy is None or not has_accuracy(name):
            return limit
        if setting.tuned and name in BACKENDS:
            return entry.first(accuracy) | limit
        tuned = option_file(name).get("tuned", {}) if setting.tuned else {}
        return limit | options_at(name, self.interface, accuracy) | tuned

    def promises(self, setting: Setting) -> Promise:
        """What its "optimal" promises at a setting.

        It is what its author says, else what a study file says of the setting, else what its
        documentation says of its options.
        """
        said = self.promised.get(setting.name, setting.promised)
        options = self.settings_of(setting, 1.0)
        if isinstance(said, int | float):
            return {"digits": float(said)}
        if said is not None:
            return resolved(said, options)
        if self.known:
            return promise_of(str(self.target), self.interface, options)
        return resolved(
            {} if setting.accuracy is None else dict.fromkeys(RESIDUALS, setting.accuracy), {}
        )

    def claim(self, status: str) -> str:
        """What a status of it claims, as :func:`.claims.claim` says."""
        return claim(self.interface, str(self.target), status)

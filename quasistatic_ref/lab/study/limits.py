"""What the calls of a study may take."""

from dataclasses import dataclass

from quasistatic_ref.errors import InputError


@dataclass(frozen=True)
class Limits:
    """Limits of time and memory for the calls of a study.

    Parameters
    ----------
    time_limit : float
        Of one call; a solver that takes longer is ended [s].
    warm_up : float
        Of the first call of a shape, at a setting, in a process, which is not counted, since a
        solver may compile in it [s].
    repetitions : int
        Calls of a measurement that are timed.
    budget : float
        Of one solver, all its calls together, each time that a study runs; calls beyond it are left
        out [s].
    memory : float
        Of one solver's process and what it starts [bytes].

    Raises
    ------
    InputError
        If one is not positive.
    """

    time_limit: float = 2.0
    warm_up: float = 10.0
    repetitions: int = 5
    budget: float = 600.0
    memory: float = 4e9

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value > 0:
                raise InputError("must be greater than 0", field=f"limits.{name}", value=value)

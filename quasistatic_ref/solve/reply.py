"""What one call of a solver gives back; ``solver.py`` judges it."""

from dataclasses import dataclass

from quasistatic_ref.formats.quoting import one_line
from quasistatic_ref.numbers.arrays import Array


@dataclass(eq=False)
class Reply:
    """The unchecked answer of a solver; that to a step is in natural units.

    Parameters
    ----------
    x : ndarray, shape (n,), or None
        The answer to min 1/2 x'Hx - g'x, A x >= b; any shape if the solver is broken.
    lam : ndarray, shape (m,), or None
        Multipliers of A x >= b, >= 0 but for the solver's tolerance.
    solved : bool
        Whether it claims a full solution.
    status : str
        Its own word, or what it raised; of other letters than can be written, their numbers.
    iterations : int or None
    seconds, setup : float or None
        Of solving and of setting up [s], by the solver's own account, where it gives one.
    call_seconds : float
        Of the whole call [s], in a study.
    accuracy : float
        That the solver was asked for in this call, in natural units [-].
    """

    x: Array | None
    lam: Array | None
    solved: bool
    status: str
    iterations: int | None = None
    seconds: float | None = None
    call_seconds: float = 0.0
    setup: float | None = None
    accuracy: float = 0.0

    def __post_init__(self) -> None:
        self.status = one_line(self.status)

    @property
    def answer(self) -> tuple[Array, Array]:
        """The solver's x (n,) and multipliers lam (m,) [-]; None unless it gave both."""
        assert self.x is not None
        assert self.lam is not None
        return self.x, self.lam


def check_not_interrupted(status: str) -> None:
    """KeyboardInterrupt if a solver says that Ctrl-C, which it took for itself, has ended it."""
    if status.lower().startswith("interrupted"):
        raise KeyboardInterrupt

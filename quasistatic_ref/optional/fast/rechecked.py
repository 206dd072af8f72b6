"""Some of the proofs of compiled code, checked again by the exact method of the core.

The test of a library (``compiled/selftest.py``) has a limited number of steps. So the first proof
of each kind in a process, and then one in ``EVERY``, is compared with what the core's exact signs
say.
"""

from collections import Counter

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.step.data import StepData

EVERY = 1000
LARGEST = 64
"""Most coordinates of a group that is checked again: of more, the exact method takes seconds."""

DETERMINED = ("delta_q", "net", "slack", "multipliers_unique", "differentiable")
"""What of an optimum is unique."""

WHOLE = "all groups of a step at once"
GROUP = "a group of a step"
_proofs: Counter[str] = Counter()
"""Of this process, by their kind."""


class WrongProof(StepNotSolved):
    """Compiled code has proved what is not so.

    Parameters
    ----------
    step : StepData
        In SI units.
    what : str
        What is wrong.
    """

    def __init__(self, step: StepData, what: str) -> None:
        super().__init__("compiled code", "wrong proof", step, 0.0)
        self.args = (
            f"compiled code has proved a step wrongly: {what} is not what the exact method finds "
            f"({library.described()}); set {library.VARIABLE}={library.NONE}, and report the step",
        )


def is_due(kind: str, n: int) -> bool:
    """Whether the turn of a proof has come: one of a kind, of a group of n coordinates."""
    _proofs[kind] += 1
    return _proofs[kind] % EVERY == 1 and n <= LARGEST


def check(step: StepData, found: ExactOptimum) -> None:
    """Check what compiled code has proved of a step that is one group.

    Parameters
    ----------
    step : StepData
    found : ExactOptimum

    Raises
    ------
    WrongProof
    """
    right = form_optimum(exact_form(step), found.working_set)
    if isinstance(right, Farkas):
        raise WrongProof(step, "that it has a solution")
    names = [*DETERMINED, "lam"] if right.multipliers_unique else DETERMINED
    for name in names:
        if bits(getattr(found, name)) != bits(getattr(right, name)):
            raise WrongProof(step, name)

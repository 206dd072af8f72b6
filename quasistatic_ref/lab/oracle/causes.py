"""What makes a step end as another program's does: classic mistakes.

Each is tried on steps that the other program took: the plain program with it has to end where that
program did, wherever it does not end where the reference does.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.vectors.check.patched import Program, program
from quasistatic_ref.lab.vectors.check.table import MISTAKES, PATCHES
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.model.system import System
from quasistatic_ref.step.arrays import Array


class Taken(NamedTuple):
    """A step that another program took.

    Parameters
    ----------
    case : dict
        As an input of the layer ``step``.
    q_next : ndarray, shape (n_q,)
        Where that program ended.
    allowed : float
        How far from there is near enough: the largest entry of the difference [m, rad].
    """

    case: Json
    q_next: Array
    allowed: float


class Cause(NamedTuple):
    """What would make a program end where the other one did.

    Parameters
    ----------
    layer : str
    name : str
        A classic mistake's.
    sentence : str
    """

    layer: str
    name: str
    sentence: str


def causes(system: System, wrong: Sequence[Taken], right: Sequence[Taken]) -> list[Cause]:
    """The classic mistakes that explain all wrong steps and spoil no right one.

    Parameters
    ----------
    system : System
    wrong, right : sequence of Taken
        `wrong` must not be empty; the first one is tried first.
    """
    found = []
    for mistake in MISTAKES:
        for patch in PATCHES.get(mistake.name, {}).get("step", ()):
            if "FACTOR" in patch:
                continue
            if all(ends_there(system, program(patch), one) for one in (*wrong, *right)):
                layer, *_ = patch.partition("\n")[0].partition(": ")[2].split(", ")
                found.append(Cause(layer, mistake.name, mistake.sentence))
                break
    return found


def ends_there(system: System, made: Program, one: Taken) -> bool:
    """Whether a program ends a step where the other one did."""
    try:
        with np.errstate(all="ignore"):
            q = system.normalised(made("step", one.case)["q_next"])
            off = np.abs(system.difference(one.q_next, q)).max(initial=0.0)
    except (QuasistaticError, ArithmeticError, LookupError, TypeError, ValueError):
        return False  # a mistake with which this step comes to nothing
    return bool(off <= one.allowed)

"""Which parts of a scene another program moves wrongly in a step, and in which way.

Coordinates that neither H nor a contact couples are a part: each moves as if it were alone.
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.norm import (
    energy_norm,
    error_length,
    load_length,
    relative_digits,
    single_loads,
)
from quasistatic_ref.model.system import System
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.groups import groups
from quasistatic_ref.step.standard_form import standard_form

ENDED = "no step"
"""The way of a part whose program takes no step."""
NOTHING = 1e-9
"""How far a part may be off, over the largest displacement of its step [-]."""
NEAR = 1e-5
"""What is rounding of a force, over that of g, or of a row, over its terms [-]."""


class Part(NamedTuple):
    """Coordinates that move by themselves.

    Parameters
    ----------
    name : str
        Of their first one.
    way : str
        In which they are wrong, as :func:`way_of` says it; "" if they are right.
    off : ndarray, shape (n,)
        Where the program ended less where the reference does, times the roots of H_ii
        [J^0.5 s^0.5].
    """

    name: str
    way: str
    off: Array


def parts_of(
    system: System, result: StepResult, q_next: Array | None, digits: float, least: float = 0.0
) -> tuple[Part, ...]:
    """The parts of a scene, right and wrong.

    Parameters
    ----------
    system : System
    result : StepResult
        The reference's step.
    q_next : ndarray, shape (n_q,), or None
        Where another program's step from the same state ends; None if it takes none.
    digits : float
        Of a part that counts as right [-].
    least : float
        What counts as rounding [m, rad].
    """
    form = standard_form(result.step)
    contacts = result.step.contacts
    q = result.q if q_next is None else q_next
    assert result.q_start is not None
    off = system.difference(result.q, q)
    delta_q = system.difference(result.q_start, q)
    small = max(least, NOTHING * np.abs(result.solution.delta_q).max(initial=0.0))
    loads = single_loads(result.step)
    found = []
    for group in groups(result.step):
        mine = group.coordinates[group.coordinates < system.n_v]  # without an extension's
        if not len(mine):
            continue
        H = form.H[np.ix_(mine, mine)]
        g = form.g[mine]
        norm = energy_norm(H)
        load = load_length(norm, loads[:, mine])
        length = error_length(norm, np.diag(H), g, result.solution.delta_q[mine], load)
        right = relative_digits(norm.of_displacement(off[mine]), length)
        way = ENDED if q_next is None else ""
        if right < digits and np.abs(off[mine]).max() > small:
            J = contacts.J[group.contacts][:, :, mine].reshape(-1, len(mine))
            rows = form.A[np.ix_(group.rows, mine)], form.b[group.rows]
            way = way_of(J, *rows, H, g, delta_q[mine])
        name = system.coordinates[int(mine[0])].name
        found.append(Part(name, way, off[mine] * np.sqrt(np.diag(H))))
    return tuple(found)


def way_of(J: Array, A: Array, b: Array, H: Array, g: Array, delta_q: Array) -> str:
    """In which way a displacement is wrong: three words.

    Parameters
    ----------
    J : ndarray, shape (4 n_c, n)
        Of the contacts that the reference has.
    A : ndarray, shape (m, n)
    b : ndarray, shape (m,)
    H : ndarray, shape (n, n)
    g, delta_q : ndarray, shape (n,)

    Returns
    -------
    str
        Whether the impulse H delta_q - g that makes the program end there is ``none``, or one that
        these contacts can give, or ``another``; whether its least row is ``below``, ``at`` or
        ``above`` b. Without contacts, ``free``.
    """
    if not len(J):
        return "free"
    root = np.sqrt(np.diag(H))
    impulse = H @ delta_q - g
    given = np.linalg.lstsq(J.T, impulse, rcond=None)[0] @ J
    size = NEAR * np.linalg.norm(g / root)
    kind = "another" if np.linalg.norm((impulse - given) / root) > size else "of contacts"
    kind = "none" if np.linalg.norm(impulse / root) <= size else kind
    slack = A @ delta_q - b
    small = NEAR * (np.abs(A) @ np.abs(delta_q) + np.abs(b))
    row = "below" if np.any(slack < -small) else "at" if np.any(slack <= small) else "above"
    return f"{kind}, {row}"

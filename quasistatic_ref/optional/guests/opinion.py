"""A second opinion on the contacts of a MuJoCo state: MuJoCo's forces and motions next to exact."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.quoting import aligned
from quasistatic_ref.optional.guests import touches
from quasistatic_ref.optional.guests.compared import WINDOW, Body, Compared, Contact
from quasistatic_ref.optional.guests.findings import Finding, findings
from quasistatic_ref.optional.guests.mujoco import mujoco_step
from quasistatic_ref.optional.guests.settled import velocities
from quasistatic_ref.optional.guests.still import still
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.tolerances import CREEP

FORMAT, VERSION = "quasistatic-ref/opinion", 1
SHOWN = 1e-6
"""Smallest number that is printed, in its unit; a difference, in a thousandth of what differs."""
SHORT = 0.01
"""Time step for forces of what slides, over MuJoCo's [-]: lift-off is 1e-4 of the former."""
MOST_LINES = 5
"""Sentences about what is left out that are printed."""


@dataclass(frozen=True, eq=False)
class Opinion(Plain):
    """What MuJoCo and the exact model say of the same contacts.

    Parameters
    ----------
    h : float
        Time step of the exact answer, MuJoCo's own [s].
    tolerance : float
        Speed up to which a contact holds [m/s].
    certificate : str
        Kind of proof of the exact answer.
    contacts : tuple of Contact
    bodies : tuple of Body
        Those that touch and can move.
    findings : tuple of Finding
    left_out : tuple of str
        What the exact answer does not have, or holds as it is.
    """

    h: float
    tolerance: float
    certificate: str
    contacts: tuple[Contact, ...]
    bodies: tuple[Body, ...]
    findings: tuple[Finding, ...]
    left_out: tuple[str, ...]

    @property
    def record(self) -> dict[str, Any]:
        """All of it as plain data, of the schema that ``quasistatic-ref schema opinion`` prints."""
        return {"format": FORMAT, "version": VERSION, **asdict(self)}

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        sides = [(c.mujoco, c.exact) for c in self.contacts]
        yield "MuJoCo's numbers, the exact ones, and how they differ"
        yield from aligned(_table(
            "contact", [c.name for c in self.contacts], sides,
            {"normal [N]": ("normal", 1), "friction [N]": ("friction", 1),
             "torque [N mm]": ("torque", 1e3), "of its limit": ("share", 1)},
        ))  # fmt: skip
        yield ""
        motions = [(b.mujoco, b.exact) for b in self.bodies]
        yield from aligned(_table(
            "body", [b.name for b in self.bodies], motions,
            {"moves [mm/s]": ("speed", 1e3), "turns [deg/s]": ("turn", 180 / np.pi)},
        ))  # fmt: skip
        yield ""
        yield from (f"- {finding.sentence}" for finding in self.findings)
        if not self.findings:
            yield "no finding" if self.contacts else "no finding: nothing touches"
        moving = [b.name for b in self.bodies if b.fastest(b.mujoco) > self.tolerance]
        if moving and {*moving} - {finding.body for finding in self.findings}:
            yield f"in MuJoCo, these still move: {', '.join(moving)}; a state at rest says more"
        yield from (f"  {sentence}" for sentence in self.left_out[:MOST_LINES])
        if len(self.left_out) > MOST_LINES:
            yield f"  and {len(self.left_out) - MOST_LINES} more; --json has all of them"


def _table(
    first: str,
    names: Sequence[str],
    sides: Sequence[tuple[Any, Any]],
    columns: Mapping[str, tuple[str, float]],
) -> list[tuple[str, ...]]:
    """Rows with three columns for each number: MuJoCo's, the exact one, how they differ."""
    rows = [(first, *(word for column in columns for word in (column, "exact", "diff")))]
    for name, (theirs, exact) in zip(names, sides, strict=True):
        cells = []
        for field, unit in columns.values():
            its = unit * getattr(theirs, field)
            ours = None if exact is None else unit * getattr(exact, field)
            cells += [_digits(its), "-", "-"] if ours is None else [
                _digits(its), _digits(ours), _digits(its - ours, max(1.0, 1e3 * its, 1e3 * ours))
            ]  # fmt: skip
        rows.append((name, *cells))
    return rows


def _digits(number: float, size: float = 1.0) -> str:
    """Three digits of a number; zero for what is rounding of `size`."""
    return f"{number if abs(number) > SHOWN * size else 0.0:.3g}"


def second_opinion(model: Any, data: Any, tolerance: float = CREEP) -> Opinion:
    """What MuJoCo says of the contacts of a state, and what rigid bodies with that friction do.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData
        Neither is changed. A state that has settled says most.
    tolerance : float
        Speed up to which a contact holds [m/s].

    Returns
    -------
    Opinion
        It prints as tables and sentences.

    Raises
    ------
    InputError
        If `tolerance` is not positive.
    ModelError
        As of ``mujoco_step``, and if MuJoCo's simulation is unstable.

    Examples
    --------
    >>> import mujoco
    >>> box = '<body name="box" pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05"/>'
    >>> floor = '<geom name="floor" type="plane" size="1 1 1"/>'
    >>> text = f"<mujoco><worldbody>{floor}{box}</body></worldbody></mujoco>"
    >>> model = mujoco.MjModel.from_xml_string(text)
    >>> opinion = qr.second_opinion(model, mujoco.MjData(model))
    >>> opinion.findings, round(opinion.contacts[0].exact.normal, 4)  # a quarter of 1 kg [N]
    ((), 2.4525)
    """
    if not 0 < tolerance < np.inf:
        raise InputError("must be a positive speed [m/s]", field="tolerance", value=tolerance)
    h = float(model.opt.timestep)
    step, coordinates = mujoco_step(model, data, h)
    T = coordinates.T
    answer = solve_step(step)
    state = still(model, data)
    state.run()
    now = copy.copy(data)
    state.mujoco.mj_forward(model, now)
    means = velocities(model, now, WINDOW)
    exact = T @ answer.delta_q / h
    both = Compared(state, now, answer, exact / h, *means, exact)
    contacts = tuple(both.contacts())
    if any(c.exact and c.exact.slip > tolerance for c in contacts):
        # What slides lifts off by a part of its way, about a h^2, against what presses it.
        short = solve_step(mujoco_step(model, data, h * SHORT)[0])
        acceleration = T @ short.delta_q / (h * SHORT) ** 2
        both = Compared(state, now, short, acceleration, *means, exact)
        contacts = tuple(both.contacts())
    bodies = tuple(both.bodies())
    reasons = {name: reason for name, _, reason in touches.deep(state, step)}
    slower = (
        f'option: cone="elliptic" with impratio above {model.opt.impratio:g}, or noslip_iterations'
    )
    weight = float(model.body_mass.sum() * np.linalg.norm(model.opt.gravity))
    found = tuple(findings(contacts, bodies, reasons, weight, tolerance, slower))
    kind = answer.certificate.kind
    return Opinion(h, tolerance, kind, contacts, bodies, found, coordinates.left_out)

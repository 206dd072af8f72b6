"""A second opinion on the contacts of a state: MuJoCo's forces and motions next to exact."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from quasistatic_ref.files.finding import finding_table
from quasistatic_ref.optional.mujoco.compared import Body, Contact
from quasistatic_ref.quoting import aligned
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.text.declared import Field, Tables
from quasistatic_ref.text.plain import Plain

FORMAT = "quasistatic-ref/opinion"
VERSION = 3
ENGINE = "MuJoCo"
SHOWN = 1e-6
"""Smallest number that is printed, in its unit; a difference, in a thousandth of what differs."""
MOST_LINES = 5
"""Sentences about what is left out that are printed."""

TOP, CONTACT, BODY, FINDING = "opinion", "contact", "body", "finding"
MOVES = "in MuJoCo, these still move: "
"""How a sentence on what is not at rest begins."""
BEARING, MOTION = "bearing", "motion"
NULL = {"anyOf": [{"$ref": f"#/definitions/{BEARING}"}, {"type": "null"}]}

TABLES = Tables({
    TOP: {
        "format": Field("text", "what it is", choices=(FORMAT,)),
        "version": Field("integer", "of this schema", choices=(VERSION,)),
        "engine": Field("text", "whose answer it is about", choices=(ENGINE,)),
        "h": Field("number", "time step of the exact answer: MuJoCo's own", "s", above=0),
        "tolerance": Field("number", "speed up to which a contact holds", "m/s", above=0),
        "certificate": Field("text", "proof of the exact answer",
                             choices=("exact", "enclosure", "residual")),
        "contacts": Field("list of tables", "all contacts of MuJoCo's", of=CONTACT),
        "bodies": Field("list of tables", "bodies that touch and can move", of=BODY),
        "findings": Field("list of tables", "what is found; exit status 1 if any", of=FINDING),
        "left_out": Field("list of words", "what the exact answer does not have"),
    },
    CONTACT: {
        "name": Field("text", "its number and geoms"),
        "bodies": Field("list of words", "the two bodies; world for what cannot move"),
        "depth": Field("number", "by how much they penetrate", "m"),
        "mu_v": Field("number", "friction", "-", least=0),
        "mu_omega": Field("number", "torsional friction", "m", least=0),
        "pair": Field("text", "what touches, without the number of the contact"),
        "theirs": Field("table", "MuJoCo's answer; a mean over 0.1 s of what hops", of=BEARING),
        "exact": Field("a table or null", "null where joints or equalities bear any force",
                       schema=NULL),
    },
    BEARING: {
        "normal": Field("number", "normal force", "N"),
        "friction": Field("number", "friction force", "N", least=0),
        "torque": Field("number", "torque about the normal", "N m", least=0),
        "share": Field("number", "of what friction may be at this normal force", "-", least=0),
        "slip": Field("number", "speed of one surface along the other", "m/s", least=0),
        "spin": Field("number", "rate about the normal", "rad/s", least=0),
    },
    BODY: {
        "name": Field("text", "MuJoCo's name"),
        "size": Field("number", "its farthest point from its centre of mass", "m", least=0),
        "rests": Field("boolean", "whether MuJoCo has it at rest in the state itself"),
        "steady": Field("boolean", "whether MuJoCo's motion of it stays as it is"),
        "free": Field("boolean", "whether nothing but contacts holds it"),
        "needed": Field("number", "the friction that balances its loads", "N", least=0),
        "bears": Field("number", "the sum of mu_v times normal force", "N"),
        "torque": Field("number", "moment that nothing balances", "N m"),
        "rolling": Field("number", "moment of MuJoCo's rolling friction", "N m", least=0),
        "balanced": Field("boolean", "whether MuJoCo's forces on it add up to none"),
        "theirs": Field("table", "MuJoCo's answer, a mean over 0.1 s", of=MOTION),
        "exact": Field("table", "the exact answer, one step from rest", of=MOTION),
    },
    MOTION: {
        "speed": Field("number", "of the centre of mass", "m/s", least=0),
        "turn": Field("number", "rate of rotation", "rad/s", least=0),
        "sinks": Field("number", "speed along gravity", "m/s"),
    },
    FINDING: {
        "name": Field("text", "what is found",
                      choices=("creeps", "slides", "turns", "moves", "moving", "penetrates")),
        "grave": Field("boolean", "true"),
        "sentence": Field("text", "the cause, then the remedy"),
        "remedy": Field("text", "the option or element that changes it"),
        "numbers": Field("table", "what was measured, by names that end in the unit"),
        "of": Field("text", "empty"),
    },
})  # fmt: skip
"""Fields by the kind of object."""


@dataclass(frozen=True, eq=False)
class Opinion(Plain):
    """MuJoCo's and the exact model's answers for the same contacts, and what is found.

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
        """The opinion as plain data, as ``quasistatic-ref schema opinion`` describes it."""
        findings = [finding_table(finding) for finding in self.findings]
        head = {"format": FORMAT, "version": VERSION, "engine": ENGINE}
        return {**head, **asdict(self), "findings": findings}

    @property
    def still(self) -> bool:
        """Whether nothing moves in MuJoCo by more than the tolerance."""
        return not any(sentence.startswith(MOVES) for sentence in self.left_out)

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        sides = [(c.theirs, c.exact) for c in self.contacts]
        yield "MuJoCo's numbers, the exact ones, and how they differ"
        yield from aligned(_table(
            "contact", [c.name for c in self.contacts], sides,
            {"normal [N]": ("normal", 1), "friction [N]": ("friction", 1),
             "torque [N mm]": ("torque", 1e3), "of its limit": ("share", 1)},
        ))  # fmt: skip
        yield ""
        motions = [(b.theirs, b.exact) for b in self.bodies]
        yield from aligned(_table(
            "body", [b.name for b in self.bodies], motions,
            {"moves [mm/s]": ("speed", 1e3), "turns [deg/s]": ("turn", 180 / np.pi)},
        ))  # fmt: skip
        yield ""
        yield from (f"- {finding}" for finding in self.findings)
        if not self.findings:
            nothing = "no finding" if self.contacts else "no finding: nothing touches"
            yield nothing if self.still else "nothing explains what still moves"
        yield from (f"  {sentence}" for sentence in self.left_out[:MOST_LINES])
        if len(self.left_out) > MOST_LINES:
            yield f"  and {len(self.left_out) - MOST_LINES} more; left_out has all of them"


def _table(
    first: str,
    names: Sequence[str],
    sides: Sequence[tuple[object, object]],
    columns: Mapping[str, tuple[str, float]],
) -> list[tuple[str, ...]]:
    """Rows with three columns for each number: MuJoCo's, the exact one, their difference."""
    rows = [(first, *(word for column in columns for word in (column, "exact", "diff")))]
    for name, (theirs, exact) in zip(names, sides, strict=True):
        cells = []
        for field, unit in columns.values():
            its = unit * getattr(theirs, field)
            cells.append(_digits(its))
            if exact is None:
                cells += ["-", "-"]
                continue
            ours = unit * getattr(exact, field)
            cells += [_digits(ours), _digits(its - ours, max(1.0, 1e3 * its, 1e3 * ours))]
        rows.append((name, *cells))
    return rows


def _digits(number: float, size: float = 1.0) -> str:
    """Three digits of a number; zero for what is rounding of `size`."""
    return f"{number if abs(number) > SHOWN * size else 0.0:.3g}"

"""The answer of a step as JSON: ``quasistatic-ref/solution``, version 2.

Besides the answer itself a file holds only claims that `verify` proves: no timings, and no name of
a backend.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np

from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.verification import rounded_wrenches, verify_answer
from quasistatic_ref.errors import StepDataError, about_file, check_kind
from quasistatic_ref.exact.verdict import Verdict
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.solution import Certificate, Kind, StepSolution
from quasistatic_ref.step.text import step_sha256
from quasistatic_ref.text.content import json_read, text_written
from quasistatic_ref.text.declared import Field, Tables, head
from quasistatic_ref.text.json_text import json_text
from quasistatic_ref.text.table_reader import TableReader

UNPROVED = ("residual", "none")
"""Kinds of certificate that claim nothing which could be proved."""
SOLUTION_FORMAT = "quasistatic-ref/solution"
VERSION = 2
TOP = "a solution"
CERTIFICATE = "certificate"
_PAIR = {"type": "array", "items": {"type": "integer"}, "minItems": 2, "maxItems": 2}
TABLES = Tables({
    TOP: {
        **head(SOLUTION_FORMAT, VERSION),
        "status": Field("text", "what is claimed", choices=("optimal", "infeasible")),
        "cone": Field("text", "that of the step"),
        "step_sha256": Field("text", "hash of the step, 64 hexadecimal digits in lower case"),
        "delta_q": Field("numbers", "displacement", "m, rad", shape=("n_v",)),
        "lam": Field(
            "list of lists of numbers",
            "for each contact the multiplier of each of its rows in A; in the ellipsoid those of "
            "J_n, J_1, J_2 and J_w [N m s]",
            "N s", schema={"items": {"type": "array", "items": {"type": "number"}}},
        ),
        "lam_extra": Field("numbers", "multipliers of the user's own rows", shape=("own rows",)),
        "wrench": Field(
            "numbers", "(f_d1, f_d2, f_n, tau_n) of each contact: computed from lam as it stands "
            "in this file, and rounded once", "N, N m", shape=("n_c", 4),
        ),
        "certificate": Field("table", "what is proved", of=CERTIFICATE),
        "farkas": Field(
            "list of fractions", "if infeasible, in the place of the fields from delta_q on: "
            "p/q or p as a text, for each row of A", schema={"items": {"type": "string"}},
        ),
    },
    CERTIFICATE: {
        "kind": Field("text", "of proof", choices=get_args(Kind)),
        "active": Field("list of pairs", "contact and row of each active row",
                        schema={"items": _PAIR}),
        "multipliers_unique": Field("boolean", "whether lam is the only one"),
        "differentiable": Field("boolean", "whether delta_q is, with respect to g"),
        "smallest_inactive_slack": Field("number", "null if no row is inactive", "m", null=True),
        "smallest_active_multiplier": Field("number", "null if no row is active", "N s", null=True),
        "error_bound": Field("number", "of delta_q", "-"),
        "gap": Field("number", "duality gap of lam", "N m s"),
    },
})  # fmt: skip
"""Every field of a solution's file; which ones it has depends on its status and its cone."""


@dataclass(frozen=True, eq=False)
class SolutionFile:
    """What a solution file claims about a step; ``verdict`` proves or refutes it.

    ``load_solution`` makes it; its constructor checks nothing.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,), or None
        None for an infeasible step. If step_sha256 is that of another step, all but `step` are
        None.
    lam : ndarray, shape (m,), or None
        The user's own rows last.
    wrench : ndarray, shape (n_c, 4), or None
    certificate : Certificate or None
    farkas : tuple of str or None
        For an infeasible step: the proof, as fractions ``"p/q"``.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.verify(qr.SolutionFile(step, farkas=("1", "1/2"))).reason
    'the Farkas vector has 2 entries, the step 6 rows'
    """

    step: StepData
    delta_q: Array | None = None
    lam: Array | None = None
    wrench: Array | None = None
    certificate: Certificate | None = None
    farkas: tuple[str, ...] | None = None

    def verdict(self) -> Verdict:
        """Whether all claims of the file are proved: an answer with wrenches, or infeasibility.

        Raises
        ------
        InputError
            If nothing can be proved in this thread: see :mod:`~quasistatic_ref.numbers.precision`.
        """
        step = self.step
        check_step(step)
        if self.farkas is not None:
            reason = farkas_refutation(step, self.farkas)
            return Verdict(reason is None, reason or "")
        if self.certificate is None or self.delta_q is None or self.lam is None:
            return Verdict(False, "the solution belongs to another step: step_sha256 differs")
        kind = self.certificate.kind
        if kind in UNPROVED:
            problem = f"a certificate of kind {kind!r} proves nothing; solve with full"
            return Verdict(False, problem)
        claims = self.certificate
        wrench = np.zeros((0, 4)) if self.wrench is None else self.wrench
        return verify_answer(step, self.delta_q, claims.active, self.lam, claims, wrench)


def solution_text(solution: StepSolution) -> str:
    """The solution of a step as one line of JSON."""
    step = solution.step
    certificate = solution.certificate
    lam = solution.lam[: step.offsets[-1]]
    kind = certificate.kind
    record = _head(step, "optimal") | {
        "delta_q": solution.delta_q,
        "lam": [lam[a:b] for a, b in pairwise(step.offsets)],
        "lam_extra": solution.lam_extra,
        "wrench": rounded_wrenches(step.contacts, lam, step.h, step.cone),
        "certificate": {"kind": kind}
        | {name: getattr(certificate, name) for name in cone(step.cone).claims[kind]},
    }
    return json_text(record) + "\n"


def save_solution(path: str | Path, solution: StepSolution) -> Path:
    """Write a solution file, whole or not at all.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.save_solution(Path(tempfile.mkdtemp()) / "solution.json", qr.solve_step(step)).name
    'solution.json'
    """
    check_kind(solution, StepSolution, "solution", "a StepSolution: save_solution(path, solution)")
    return text_written(path, solution_text(solution))


def infeasible_text(step: StepData, farkas: Sequence[str]) -> str:
    """The proof that a step has no solution, as one line of JSON."""
    return json_text(_head(step, "infeasible") | {"farkas": list(farkas)}) + "\n"


def load_solution(path: str | Path, step: StepData) -> SolutionFile:
    """Read a solution file, whatever program wrote it: what `verify` takes.

    Raises
    ------
    InputError
        Naming the file, the field and the value.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> solution = qr.solve_step(step)
    >>> path = qr.save_solution(Path(tempfile.mkdtemp()) / "solution.json", solution)
    >>> bool(qr.verify(qr.load_solution(path, step)))
    True
    """
    check_step(step)
    with about_file(path):
        return _solution(TableReader(json_read(path), error=StepDataError), step)


def _head(step: StepData, status: str) -> dict[str, Any]:
    return {
        "format": SOLUTION_FORMAT,
        "version": VERSION,
        "status": status,
        "cone": step.cone,
        "step_sha256": step_sha256(step),
    }


def _solution(top: TableReader, step: StepData) -> SolutionFile:
    sizes = {"n_v": step.n_v, "n_c": step.contacts.n_c, "own rows": len(step.extra.names)}
    take = TABLES.fields(top, TOP, **sizes)
    take("format"), take("version")
    status = take("status")
    named = take("cone")
    if named != step.cone:
        raise top.error_about("cone", f"must be that of the step, {step.cone!r}", named)
    if take("step_sha256") != step_sha256(step):
        return SolutionFile(step)  # its shapes are another step's
    if status == "infeasible":
        farkas = take("farkas")
        if not all(isinstance(y, str) for y in farkas):
            raise top.error_about("farkas", 'must be a list of fractions such as "1/3"', farkas)
        top.close()
        return SolutionFile(step, farkas=tuple(farkas))
    lam = _nested(top, take("lam"), step)
    claims = take("certificate")
    solution = SolutionFile(
        step,
        delta_q=take("delta_q"),
        lam=np.concatenate([lam, take("lam_extra")]),
        wrench=take("wrench"),
        certificate=_certificate(claims, step),
    )
    top.close()
    return solution


def _nested(top: TableReader, value: list[Any], step: StepData) -> Array:
    if len(value) != step.contacts.n_c:
        raise top.error_about(
            "lam", f"must have one list for each of {step.contacts.n_c} contacts", value
        )
    each = TableReader({f"lam[{j}]": part for j, part in enumerate(value)}, error=StepDataError)
    parts = [each.array(f"lam[{j}]", (int(rows),)) for j, rows in enumerate(step.counts)]
    return np.concatenate([np.zeros(0), *parts])


def _certificate(table: TableReader, step: StepData) -> Certificate:
    known = cone(step.cone).claims
    kind = cast("Kind", table.text("kind", choices=tuple(known)))
    take = TABLES.fields(table, CERTIFICATE)
    claims = {name: take(name) for name in known[kind]}
    if "active" in claims:
        claims["active"] = _pairs(table, claims["active"])
    if kind == "residual":
        table.take("error_bound", None)  # a bound, which an older version wrote: not looked at
    table.close()
    return Certificate(kind, **claims, step=None if kind == "none" else step)


def _pairs(table: TableReader, value: list[Any]) -> tuple[tuple[int, int], ...]:
    for pair in value:
        good = isinstance(pair, list) and len(pair) == 2
        if not (good and all(type(i) is int for i in pair)):
            raise table.error_about("active", "must be a list of [contact, row]", pair)
    active = tuple((j, i) for j, i in value)
    if active != tuple(sorted(set(active))):
        raise table.error_about("active", "must be in increasing order", active)
    return active

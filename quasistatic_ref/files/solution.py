"""The answer of a step as JSON: ``quasistatic-ref/solution``, version 2.

Besides the answer itself a file holds only claims that `verify` proves: no timings, and no name of
a backend.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, cast, get_type_hints

import numpy as np

from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.verdict import Verdict
from quasistatic_ref.certify.verification import rounded_wrenches, verify_answer
from quasistatic_ref.errors import StepDataError, about_file, check_kind
from quasistatic_ref.files.content import json_read, text_written
from quasistatic_ref.files.table_reader import TableReader
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.solution import Certificate, Kind, StepSolution
from quasistatic_ref.step.text import step_sha256
from quasistatic_ref.text.json_text import json_text

UNPROVED = ("residual", "none")
"""Kinds of certificate that claim nothing which could be proved."""
SOLUTION_FORMAT = "quasistatic-ref/solution"
VERSION = 2
MAY_BE_NULL = {
    ("exact", "smallest_inactive_slack"),
    ("exact", "smallest_active_multiplier"),
}
"""Numbers that may be missing: of a step without idle rows, or without active rows."""


@dataclass(frozen=True, eq=False)
class SolutionFile:
    """What a solution file claims about a step; ``verdict`` proves or refutes it.

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
    top.check_format(SOLUTION_FORMAT, VERSION)
    status = top.text("status", choices=("optimal", "infeasible"))
    named = top.text("cone")
    if named != step.cone:
        raise top.error_about("cone", f"must be that of the step, {step.cone!r}", named)
    if top.text("step_sha256") != step_sha256(step):
        return SolutionFile(step)  # its shapes are another step's
    if status == "infeasible":
        farkas = top.sequence("farkas")
        if not all(isinstance(y, str) for y in farkas):
            raise top.error_about("farkas", 'must be a list of fractions such as "1/3"', farkas)
        top.close()
        return SolutionFile(step, farkas=tuple(farkas))
    lam = _nested(top, step)
    claims = top.table("certificate")
    solution = SolutionFile(
        step,
        delta_q=top.array("delta_q", (step.n_v,)),
        lam=np.concatenate([lam, top.array("lam_extra", (len(step.extra.names),))]),
        wrench=top.array("wrench", (step.contacts.n_c, 4)),
        certificate=_certificate(claims, step),
    )
    top.close()
    return solution


def _nested(top: TableReader, step: StepData) -> Array:
    value = top.sequence("lam")
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
    claims: dict[str, Any] = {
        name: _claim(table, name, (kind, name) in MAY_BE_NULL) for name in known[kind]
    }
    if kind == "residual":
        table.take("error_bound", None)  # a bound, which an older version wrote: not looked at
    table.close()
    active = claims.get("active", ())
    if active != tuple(sorted(set(active))):
        raise table.error_about("active", "must be in increasing order", active)
    return Certificate(kind, **claims, step=None if kind == "none" else step)


def _claim(table: TableReader, name: str, may_be_null: bool) -> Any:
    """One claim of a file, read as the type that the certificate's field has."""
    if may_be_null and table.is_null(name):
        return table.take(name)
    if name == "active":
        for pair in (pairs := table.sequence(name)):
            good = isinstance(pair, list) and len(pair) == 2
            if not (good and all(type(i) is int for i in pair)):
                raise table.error_about(name, "must be a list of [contact, row]", pair)
        return tuple((j, i) for j, i in pairs)
    kind = get_type_hints(Certificate)[name]
    return table.boolean(name) if kind == bool | None else table.number(name)

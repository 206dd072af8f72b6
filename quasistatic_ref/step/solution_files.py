"""The answer of a step as JSON: ``quasistatic-ref/solution``, version 1. Timings never enter it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import StepDataError, about_file
from quasistatic_ref.fields import Fields
from quasistatic_ref.files import json_read, json_text
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.files import VERSION, step_sha256
from quasistatic_ref.step.solution import Certificate, StepSolution

SOLUTION_FORMAT = "quasistatic-ref/solution"
KINDS = ("exact", "enclosure", "residual", "none")
YES_OR_NO = ("multipliers_unique", "differentiable")
NUMBERS = ("smallest_inactive_slack", "smallest_active_multiplier", "error_bound")


@dataclass(frozen=True, eq=False)
class SolutionFile:
    """What a solution file says about a step; nothing of it is believed yet.

    Parameters
    ----------
    step_sha256 : str
    backend : str
    delta_q : ndarray, shape (n_v,), or None
        None of an infeasible step; nothing more is read where step_sha256 is another step's.
    lam : ndarray, shape (m,), or None
        The user's own rows last.
    wrench : ndarray, shape (n_c, 4), or None
    certificate : Certificate or None
    farkas : tuple of str or None
        Of an infeasible step: the proof, as fractions ``"p/q"``.
    """

    step_sha256: str
    backend: str
    delta_q: Array | None = None
    lam: Array | None = None
    wrench: Array | None = None
    certificate: Certificate | None = None
    farkas: tuple[str, ...] | None = None


def solution_text(step: StepData, solution: StepSolution) -> str:
    """The solution of a step as one line of JSON."""
    record = _head(step, "optimal", solution.backend) | {
        "delta_q": solution.delta_q,
        "lam": [solution.lam[a:b] for a, b in pairwise(step.offsets)],
        "lam_extra": solution.lam_extra,
        "wrench": solution.wrench,
        "certificate": asdict(solution.certificate),
    }
    return json_text(record) + "\n"


def infeasible_text(step: StepData, backend: str, farkas: Sequence[str]) -> str:
    """The proof that a step has no solution, as one line of JSON."""
    return json_text(_head(step, "infeasible", backend) | {"farkas": list(farkas)}) + "\n"


def solution_read(path: str | Path, step: StepData) -> SolutionFile:
    """Read a solution file, whatever program wrote it.

    Raises
    ------
    InputError
        Naming the file, the field and the value.
    """
    with about_file(path):
        return _solution(Fields(json_read(path), error=StepDataError), step)


def _head(step: StepData, status: str, backend: str) -> dict[str, Any]:
    return {
        "format": SOLUTION_FORMAT,
        "version": VERSION,
        "status": status,
        "cone": step.cone,
        "backend": backend,
        "step_sha256": step_sha256(step),
    }


def _solution(top: Fields, step: StepData) -> SolutionFile:
    top.check_format(SOLUTION_FORMAT, VERSION)
    status = top.text("status", choices=("optimal", "infeasible"))
    named = top.text("cone", PYRAMID)
    if named != step.cone:
        raise top.fail("cone", f"must be that of the step, {step.cone!r}", named)
    backend, sha256 = top.text("backend"), top.text("step_sha256")
    if sha256 != step_sha256(step):
        return SolutionFile(sha256, backend)  # its shapes are another step's
    if status == "infeasible":
        farkas = top.sequence("farkas")
        if not all(isinstance(y, str) for y in farkas):
            raise top.fail("farkas", 'must be a list of fractions such as "1/3"', farkas)
        top.close()
        return SolutionFile(sha256, backend, farkas=tuple(farkas))
    lam = _nested(top, step)
    solution = SolutionFile(
        sha256,
        backend,
        delta_q=top.array("delta_q", (step.n_v,)),
        lam=np.concatenate([lam, top.array("lam_extra", (len(step.extra.names),))]),
        wrench=top.array("wrench", (step.contacts.n_c, 4)),
        certificate=_certificate(top.table("certificate")),
    )
    top.close()
    return solution


def _nested(top: Fields, step: StepData) -> Array:
    value = top.sequence("lam")
    if len(value) != step.contacts.n_c:
        raise top.fail("lam", f"must have one list for each of {step.contacts.n_c} contacts", value)
    each = Fields({f"lam[{j}]": part for j, part in enumerate(value)}, error=StepDataError)
    parts = [each.array(f"lam[{j}]", (int(rows),)) for j, rows in enumerate(step.counts)]
    return np.concatenate([np.zeros(0), *parts])


def _certificate(table: Fields) -> Certificate:
    kind = table.text("kind", choices=KINDS)
    residuals = table.table("residuals", {})
    found = {name: residuals.number(name) for name in residuals.names()}
    active = []
    for pair in table.sequence("active", []):
        if not (isinstance(pair, list) and len(pair) == 2 and all(type(i) is int for i in pair)):
            raise table.fail("active", "must be a list of [contact, row]", pair)
        active.append((pair[0], pair[1]))
    # The other claims may be missing or null.
    claims: dict[str, Any] = {name: table.boolean(name, None) for name in YES_OR_NO}
    claims |= {name: table.number(name, None) for name in NUMBERS}
    table.close()
    return Certificate(kind, found, tuple(active), **claims)

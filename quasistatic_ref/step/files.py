"""A step as JSON: ``quasistatic-ref/step``, version 1.

Numbers are written in shortest round-trip decimal, so a step read back is the same bits.
"""

from __future__ import annotations

import hashlib
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError, StepDataError
from quasistatic_ref.fields import Fields
from quasistatic_ref.files import json_read, json_text, text_written
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import Array, Contacts, Extra, StepData

STEP_FORMAT = "quasistatic-ref/step"
VERSION = 1


def step_record(step: StepData) -> dict[str, Any]:
    """The step as a JSON object."""
    c = step.contacts
    contacts = [
        {
            "name": c.name[j],
            "phi": c.phi[j] + 0.0,  # never -0.0
            "n": c.n[j] + 0.0,
            "d1": c.d1[j] + 0.0,
            "d2": c.d2[j] + 0.0,
            "J": c.J[j] + 0.0,
            "mu_v": c.mu_v[j],
            "mu_omega": c.mu_omega[j],
            "rows": c.rows[j],
        }
        for j in range(c.n_c)
    ]
    record = {
        "format": STEP_FORMAT,
        "version": VERSION,
        "cone": step.cone,
        "h": step.h,
        "n_a": step.n_a,
        "n_u": step.n_u,
        "K_q": step.K_q,
        "M_u": step.M_u,
        "tau_a": step.tau_a + 0.0,
        "tau_u": step.tau_u + 0.0,
        "delta_q_bar_a": step.delta_q_bar_a + 0.0,
        "contacts": contacts,
    }
    if step.extra.names:
        record["extra"] = asdict(step.extra)
    return record


def step_text(step: StepData) -> str:
    """The step as one line of JSON."""
    return json_text(step_record(step)) + "\n"


def step_sha256(step: StepData) -> str:
    """SHA-256 of :func:`step_text`, which identifies the step by its bits."""
    return hashlib.sha256(step_text(step).encode()).hexdigest()


def step_from_record(record: Any) -> StepData:
    """A validated step from a parsed JSON object.

    Raises
    ------
    StepDataError
        Naming the field and the value; unknown fields are refused.
    """
    top = Fields(record, error=StepDataError)
    check_format(top, STEP_FORMAT)
    cone = top.text("cone", PYRAMID)
    h = top.number("h", above=0.0)
    n_a, n_u = top.integer("n_a", least=0), top.integer("n_u", least=0)
    step = StepData(
        h=h,
        K_q=top.array("K_q", (n_a, n_a)),
        M_u=top.array("M_u", (n_u, n_u)),
        tau_a=top.array("tau_a", (n_a,)),
        tau_u=top.array("tau_u", (n_u,)),
        delta_q_bar_a=top.array("delta_q_bar_a", (n_a,)),
        contacts=_contacts(top, n_a + n_u),
        cone=cone,
        extra=_extra(top, n_a + n_u),
    )
    top.close()
    return step


def step_read(path: str | Path) -> StepData:
    """Read a step file."""
    record = json_read(path)
    try:
        return step_from_record(record)
    except InputError as error:
        raise error.in_file(path) from None


def step_written(path: str | Path, step: StepData) -> Path:
    """Write a step file, whole or not at all."""
    return text_written(path, step_text(step))


def check_format(top: Fields, name: str, versions: tuple[int, ...] = (VERSION,)) -> int:
    """Take ``format`` and ``version`` from a file, and refuse others than ours: the version."""
    top.text("format", choices=(name,))
    version = top.integer("version")
    if version not in versions:
        known = " and ".join(map(str, versions))
        raise top.fail("version", f"is not known here; this program reads {known}", version)
    return version


def _contacts(top: Fields, n_v: int) -> Contacts:
    names: list[str] = []
    columns: dict[str, list[Any]] = {k: [] for k in ("phi", "n", "d1", "d2", "J", "mu_v")}
    columns |= {"mu_omega": [], "rows": []}
    for j, record in enumerate(top.sequence("contacts")):
        one = Fields(record, f"contacts[{j}]", StepDataError)
        names.append(one.text("name"))
        for key in ("n", "d1", "d2"):
            columns[key].append(one.array(key, (3,)))
        columns["J"].append(one.array("J", (4, n_v)))
        columns["phi"].append(one.number("phi"))
        columns["mu_v"].append(one.number("mu_v", least=0.0))
        columns["mu_omega"].append(one.number("mu_omega", least=0.0))
        rows = one.integer("rows")
        if rows not in (4, 6):
            raise one.fail("rows", "must be 4 or 6", rows)
        columns["rows"].append(rows)
        one.close()
    n_c = len(names)
    return Contacts(
        name=tuple(names),
        phi=np.array(columns["phi"]),
        n=_stacked(columns["n"], (n_c, 3)),
        d1=_stacked(columns["d1"], (n_c, 3)),
        d2=_stacked(columns["d2"], (n_c, 3)),
        J=_stacked(columns["J"], (n_c, 4, n_v)),
        mu_v=np.array(columns["mu_v"]),
        mu_omega=np.array(columns["mu_omega"]),
        rows=np.array(columns["rows"], dtype=np.int64),
    )


def _stacked(values: list[Array], shape: tuple[int, ...]) -> Array:
    return np.array(values, dtype=np.float64).reshape(shape)


def _extra(top: Fields, n_v: int) -> Extra:
    if "extra" not in top:
        top.take("extra", None)
        return Extra((), np.zeros((0, n_v)), np.zeros(0))
    own = top.table("extra")
    names = own.sequence("names")
    for name in names:
        if not isinstance(name, str):
            raise own.fail("names", "must be strings", name)
    A, b = own.array("A", (len(names), n_v)), own.array("b", (len(names),))
    own.close()
    return Extra(tuple(names), A, b)

"""Step files: ``quasistatic-ref/step``, version 1."""

from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import StepDataError, about_file, check_kind
from quasistatic_ref.files.content import json_read, text_written
from quasistatic_ref.files.table_reader import TableReader
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import Contacts, Extra, StepData
from quasistatic_ref.step.text import CONTACT, STEP_FORMAT, VERSION, step_text


def step_from_record(record: Any) -> StepData:
    """A validated step from a parsed JSON object.

    Raises
    ------
    StepDataError
        Naming the field and the value; unknown fields are refused.
    """
    top = TableReader(record, error=StepDataError)
    top.check_format(STEP_FORMAT, VERSION)
    cone = top.text("cone", PYRAMID)
    h = top.number("h", above=0.0)
    n_a = top.integer("n_a", least=0)
    n_u = top.integer("n_u", least=0)
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


def load_step(path: str | Path) -> StepData:
    """Read a step file.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = qr.save_step(Path(tempfile.mkdtemp()) / "step.json", step)
    >>> qr.load_step(path) == step
    True
    """
    with about_file(path):
        return step_from_record(json_read(path))


def save_step(path: str | Path, step: StepData) -> Path:
    """Write a step file, whole or not at all.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> import tempfile
    >>> from pathlib import Path
    >>> qr.save_step(Path(tempfile.mkdtemp()) / "step.json", step).name
    'step.json'
    """
    check_kind(step, StepData, "step", "a StepData: save_step(path, step)")
    return text_written(path, step_text(step))


def _contacts(top: TableReader, n_v: int) -> Contacts:
    each = [
        _contact(TableReader(record, f"contacts[{j}]", StepDataError), n_v)
        for j, record in enumerate(top.sequence("contacts"))
    ]
    columns: dict[str, Any] = {key: [contact[key] for contact in each] for key in CONTACT}
    columns["J"] = np.reshape(columns["J"], (len(each), 4, n_v))  # without contacts, n_v too
    return Contacts(**columns)


def _contact(one: TableReader, n_v: int) -> dict[str, Any]:
    fields = {
        "name": one.text("name"),
        "phi": one.number("phi"),
        **{axis: one.array(axis, (3,)) for axis in ("n", "d1", "d2")},
        "J": one.array("J", (4, n_v)),
        **{mu: one.number(mu, least=0.0) for mu in ("mu_v", "mu_omega")},
        "rows": one.integer("rows", choices=(4, 6)),
    }
    one.close()
    return fields


def _extra(top: TableReader, n_v: int) -> Extra:
    extra_table = top.table("extra", {"names": [], "A": [], "b": []})
    names = extra_table.words("names")
    extra = Extra(
        tuple(names),
        extra_table.array("A", (len(names), n_v)),
        extra_table.array("b", (len(names),)),
        H=extra_table.array("H", (n_v, n_v)) if "H" in extra_table else None,
        g=extra_table.array("g", (n_v,)) if "g" in extra_table else None,
    )
    extra_table.close()
    return extra

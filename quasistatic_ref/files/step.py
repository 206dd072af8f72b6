"""Step files: ``quasistatic-ref/step``, version 1."""

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import StepDataError, about_file, check_kind
from quasistatic_ref.step.data import Contacts, Extra, StepData
from quasistatic_ref.step.text import CONTACT, TABLES, TOP, step_text
from quasistatic_ref.text.content import json_read, text_written
from quasistatic_ref.text.table_reader import TableReader


def step_from_record(record: Any) -> StepData:
    """A validated step from a parsed JSON object.

    Raises
    ------
    StepDataError
        Naming the field and the value; unknown fields are refused.
    """
    values = TABLES.read(TableReader(record, error=StepDataError), TOP)
    each = values["contacts"]
    columns: dict[str, Any] = {key: [one[key] for one in each] for key in TABLES[CONTACT]}
    n_v = values["n_a"] + values["n_u"]
    columns["J"] = np.reshape(columns["J"], (len(each), 4, n_v))  # without contacts, n_v too
    made = {"contacts": Contacts(**columns), "extra": Extra(**values["extra"])}
    return StepData(**{one.name: values[one.name] for one in fields(StepData)} | made)


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

"""The report on a store, as data; drawing and writing it is the command's."""

from __future__ import annotations

import json
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.files import bytes_read
from quasistatic_ref.lab.study.page import Report
from quasistatic_ref.lab.study.problems import FACTS
from quasistatic_ref.lab.study.solver_report import solver_report
from quasistatic_ref.lab.study.store import rows_read, study_read
from quasistatic_ref.lab.study.sweep_report import sweep_report


def study_report(folder: str | Path) -> Report:
    """The report on a store.

    Parameters
    ----------
    folder : str or Path

    Returns
    -------
    Report

    Raises
    ------
    InputError
        If there is no store, or nothing in it yet.
    """
    folder = Path(folder)
    study, rows = study_read(folder), rows_read(folder)
    if not rows:
        raise InputError("holds no rows yet; run the study first", file=folder)
    if study["kind"] == "sweep":
        return sweep_report(study, rows)
    facts = [json.loads(line) for line in bytes_read(folder / FACTS).decode().splitlines()]
    return solver_report(study, facts, rows)

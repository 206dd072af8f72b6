"""The report on a store, or on a sweep, as data; drawing and writing it is the command's."""

import os
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.page.parts import Report
from quasistatic_ref.lab.study.report.solver_report import solver_report
from quasistatic_ref.lab.study.report.sweep_report import sweep_report
from quasistatic_ref.lab.study.store.store import UNREADABLE, contents
from quasistatic_ref.lab.sweep import RUNS, TABLE


def study_report(folder: str | Path, out: str | Path | None = None) -> Report:
    """The report on a store, or on the table of a sweep.

    Parameters
    ----------
    folder : str or Path
    out : str or Path, optional
        Where the report will lie; by default in the folder of the store.

    Returns
    -------
    Report

    Raises
    ------
    InputError
        If there is neither, or nothing in it yet.
    """
    if (table := Path(folder) / TABLE).exists():
        return sweep_report(table)
    if (Path(folder) / RUNS).is_dir():
        problem = f"holds runs without {TABLE}; run the sweep again, which makes what is missing"
        raise InputError(problem, file=folder)
    found = contents(folder)
    if not found.rows:
        raise InputError("holds no rows yet; run the study first", file=folder)
    try:
        return solver_report(found, os.path.relpath(folder, out or folder))
    except UNREADABLE as error:
        words = " ".join(f"holds what no study has written: {type(error).__name__} {error}".split())
        raise InputError(words[:200], file=folder) from error

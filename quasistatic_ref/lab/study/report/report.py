"""The report on a store, as data; drawing and writing it is the command's."""

from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.page.parts import Report
from quasistatic_ref.lab.study.problems.study_problems import FACTS
from quasistatic_ref.lab.study.report.solver_report import solver_report
from quasistatic_ref.lab.study.report.sweep_report import sweep_report
from quasistatic_ref.lab.study.store.schema import FACT, check_solver_rows, check_sweep_rows
from quasistatic_ref.lab.study.store.store import (
    label_of,
    lines_read,
    rows_read,
    study_checked,
)
from quasistatic_ref.lab.study.store.unreached import unreached_read


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
    study, rows = study_checked(folder), rows_read(folder)
    if not rows:
        raise InputError("holds no rows yet; run the study first", file=folder)
    name = "sweep" if study["kind"] == "sweep" else "problem"
    if any(name not in row for row in rows):
        raise InputError("are of another kind of study", file=folder, field="its rows")
    try:
        if name == "sweep":
            check_sweep_rows(study, rows)
            return sweep_report(study, rows)
        gone = set(study.get("removed", []))
        rows = [row for row in rows if label_of(row) not in gone]
        facts = lines_read(folder / FACTS, FACT)
        check_solver_rows(study, facts, rows)
    except InputError as error:
        raise error.in_file(folder) from None
    return solver_report(study, facts, rows, unreached_read(folder))

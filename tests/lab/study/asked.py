"""What tests of studies call: only this file knows where the package keeps it."""

from quasistatic_ref.lab.folders import contact_qp_folder
from quasistatic_ref.lab.study.doors import call_of
from quasistatic_ref.lab.study.limits import Limits
from quasistatic_ref.lab.study.page import page, page_written, table_of
from quasistatic_ref.lab.study.problems.folder import FACTS, NUMBERS, manifest, set_read
from quasistatic_ref.lab.study.problems.selection import problems_taken
from quasistatic_ref.lab.study.program import Program
from quasistatic_ref.lab.study.row import Row
from quasistatic_ref.lab.study.run import measured, plan, study
from quasistatic_ref.lab.study.solvers import (
    BY_NAME,
    SETTINGS,
    Setting,
    Solver,
    function_solver,
    installed_here,
    settings_of,
    solvers_of,
    table,
)
from quasistatic_ref.lab.study.store import ROWS, rows_read, rows_written

__all__ = [
    "BY_NAME",
    "FACTS",
    "NUMBERS",
    "ROWS",
    "SETTINGS",
    "Limits",
    "Program",
    "Row",
    "Setting",
    "Solver",
    "call_of",
    "contact_qp_folder",
    "function_solver",
    "installed_here",
    "manifest",
    "measured",
    "page",
    "page_written",
    "plan",
    "problems_taken",
    "rows_read",
    "rows_written",
    "set_read",
    "settings_of",
    "solvers_of",
    "study",
    "table",
    "table_of",
]

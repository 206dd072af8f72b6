"""Tests of a part that was deleted leave with it: they are skipped, and the summary names it.

That is an optional part, or a folder of the lab. A test needs it if it cannot be imported, or ends,
with the sentence or the error that names the folder; where the folder is there, both are failures.
"""

import re

import pytest

from tests.pages import PACKAGE

NAMED = re.compile(
    r"(?:No module named '|needs )quasistatic_ref[./]((?:optional|lab)(?:[./]\w+)?)", re.ASCII
)


def missing_part(text):
    """The folder that an error names and that is not there, or None."""
    names = [match[1].replace(".", "/") for match in NAMED.finditer(text)]
    return next((name for name in names if not (PACKAGE / name).is_dir()), None)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    """Leave out a file that imports what was deleted."""
    report = yield
    if report.failed and (part := missing_part(str(report.longrepr))):
        report.outcome = "skipped"
        report.longrepr = str(collector.path), 0, f"Skipped: needs quasistatic_ref/{part}"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Leave out a test that asks for what was deleted."""
    report = yield
    if report.failed and (part := missing_part(str(call.excinfo.value))):
        report.outcome = "skipped"
        report.longrepr = str(item.path), 0, f"Skipped: needs quasistatic_ref/{part}"
    return report

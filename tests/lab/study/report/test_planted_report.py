"""Solvers that do not compute what they claim are each named on the first screen of a report."""

import pytest

from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.file.study_file import Limits
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import measured_row
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.for_study import fact_of
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.store import Store
from tests.lab.study import made_store, plain_report
from tests.lab.study.planted import FAKES

LIMITS = Limits(30.0, 30.0, 2)

PROBLEMS = ["mass_ratio/1/0", "mass_ratio/11.3113/35", "mass_ratio/150403/172"]
NAMED = {  # what is false of it on three problems, and what it looks like
    "honest": ("", "-"),
    "gradient": ("", "-"),
    "ignores_rows": ("false: rows", "-"),
    "no_multipliers": ("false: multipliers", "-"),
    "keeps": ("", "remembers the last problem, or knows the problems"),
    "reads": ("", "has the exact answers"),
    "adds": ("", "knows the problems, and no others"),
    "stops_the_clock": ("", "stops the clock"),
}


@pytest.fixture(scope="module")
def screen(harmless, tmp_path_factory):
    """The page, and its first table by solver; the last would spoil the process of all others."""
    problems = set_read(problem_set_folder(CONTACT_QP), ids=PROBLEMS)
    keys = {"interface": "callable", "setting": "default", "mode": "", "warm": False,
            "units": "natural", "repetition": 0}  # fmt: skip
    names = {"name": "", "interface": "callable", "options": {"default": {}}}
    study = {
        **made_store.STUDY,
        "time_limit": 30.0,
        "settings": [{"name": "default", "accuracy": None, "promised": None, "tuned": False}],
        "solvers": [
            {**names, "name": name, "target": f"m:{name}", "promise": {"default": {}}}
            for name in (*NAMED, "absent")
        ],
    }
    folder = tmp_path_factory.mktemp("planted_report")
    (folder / "planted_solvers.py").write_text(FAKES)
    alone = Solver("stops_the_clock", "callable", "planted_solvers:stops_the_clock")

    def measured(name, one):
        if name == alone.name:
            return measured_row(spoilt, one, Setting("default", None), "natural", False, LIMITS)
        return harmless(name, one)

    with (
        Keeper(alone, folder) as spoilt,
        Store(folder, study, [fact_of(one) for one in problems]) as store,
    ):
        for name in NAMED:
            for one in problems:
                own = {"problem": one.id, "family": one.facts["family"], "solver": name}
                store.add({**keys, **own, **measured(name, one)})
    page = markdown_page(study_report(folder))
    (_, _, columns, body), *_ = plain_report.tables_of(page)
    return page, {line[0]: dict(zip(columns, line, strict=True)) for line in body}


@pytest.mark.parametrize("name", NAMED)
def test_a_planted_solver_is_named_on_the_first_screen(name, screen):
    false, looks = NAMED[name]
    page, lines = screen
    line = lines[name]
    assert line["looks as if it"] == looks
    assert (f"callable:{name} looks as if it {looks}." in page) == (looks != "-")
    counts = {column: int(line[column]) for column in line if column.startswith("false: ")}
    assert {column for column, count in counts.items() if count} == ({false} if false else set())
    assert not false or counts[false] >= 2  # rows that are ignored need not be violated by much


def test_a_solver_that_was_never_called_has_a_row(screen):
    assert screen[1]["absent"]["interface"] == "never called"

"""Studies small enough for a test."""

from contextlib import nullcontext
from functools import partial
from types import SimpleNamespace

import pytest

from quasistatic_ref.lab.study.worker import answered
from tests.lab.study import broken
from tests.lab.study.asked import (
    Limits,
    call_of,
    contact_qp_folder,
    function_solver,
    problems_taken,
    rows_read,
    set_read,
    study,
)
from tests.pages import ROOT


@pytest.fixture
def in_this_process(monkeypatch):
    """Solvers are asked in this process, where they have no limits."""

    def asked(solver, memory):
        call = call_of(solver)
        ask = SimpleNamespace(is_there=True, ask=lambda question, _: answered(call, question))
        return nullcontext(ask)

    monkeypatch.setattr("quasistatic_ref.lab.study.run.SolverProcess", asked)


@pytest.fixture(scope="session")
def three():
    """A problem of few contacts, and two of masses."""
    return problems_taken({"contacts": 1, "mass_ratio": 2})


@pytest.fixture(scope="session")
def small(three):
    """A small study, which is called with a folder."""
    solvers = ["qpsolvers:daqp", function_solver(broken.honest, "mine")]
    return partial(study, three, solvers, ["default", "high"], units=["raw", "natural"],
                   limits=Limits(time_limit=20.0, repetitions=2))  # fmt: skip


@pytest.fixture(scope="module")
def whole(small, tmp_path_factory):
    """The rows of the small study, and the folder with them."""
    store = tmp_path_factory.mktemp("whole") / "store"
    return small(store), store


@pytest.fixture(scope="session")
def committed():
    """The rows of the committed study of solvers."""
    return rows_read(ROOT / "validation" / "studies" / "default")


@pytest.fixture(scope="session")
def members():
    """Every problem of contact-qp."""
    return set_read(contact_qp_folder())


@pytest.fixture(scope="session")
def problem(members):
    """One problem of 12 contacts with its exact answer."""
    return next(one for one in members if one.id == "mass_ratio/11.3113/35")

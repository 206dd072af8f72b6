"""Studies small enough for a test: a few scaled problems, and solvers planted on purpose."""

import os
from pathlib import Path

import pytest

from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.file.study_file import Limits, solver_study
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import measured_row
from quasistatic_ref.lab.study.measuring.run import run_study
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.store import contents
from tests.lab.study import made_store
from tests.lab.study.plain_report import tables_of
from tests.lab.study.planted import ANY, FAKES, setting


@pytest.fixture
def study(tmp_path):
    """A function that writes a study file beside the planted solvers, and reads it."""
    (tmp_path / "planted_solvers.py").write_text(FAKES)

    def written(text, **changes):
        path = tmp_path / "study.toml"
        path.write_text('format = "quasistatic-ref/study"\nversion = 1\n' + text)
        return solver_study(path, toml_read(path), **changes)

    return written


SMALL = """
time_limit = 20.0
repetitions = 2
[problems]
set = "contact-qp"
families = { contacts = { count = 2, most = 12 }, mass_ratio = 3 }
[solvers.mine]
callable = "planted_solvers:liar"
options.default = {}
[[runs]]
solvers = ["qpsolvers:daqp", "mine"]
settings = ["default", "high"]
units = ["raw", "natural"]
"""


@pytest.fixture(scope="session")
def small():
    """The text of a small study: one problem of ten is run again, a callable has one setting."""
    return SMALL


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """The folder of the small study, run once without interruption; tests leave it as it is."""
    folder = tmp_path_factory.mktemp("whole")
    path = folder / "study.toml"
    (folder / "planted_solvers.py").write_text(FAKES)
    path.write_text('format = "quasistatic-ref/study"\nversion = 1\n' + SMALL)
    run_study(solver_study(path, toml_read(path)), folder / "store", progress=False)
    return folder / "store"


@pytest.fixture(scope="session")
def committed():
    """What the committed study of solvers holds."""
    return contents(Path(__file__).parents[3] / "validation" / "studies" / "default")


@pytest.fixture
def run(study, tmp_path):
    """A function that runs a study in the folder ``store``; returns its rows."""

    def ran(text, folder="store", **options):
        return run_study(study(text), tmp_path / folder, progress=False, **options)

    return ran


@pytest.fixture(scope="session")
def problem():
    """One problem of 12 contacts with its exact answer."""
    (found,) = set_read(problem_set_folder(CONTACT_QP), ids=["mass_ratio/11.3113/35"])
    return found


@pytest.fixture(scope="session")
def harmless(tmp_path_factory):
    """A function: the row of a planted solver that is harmless, all of them in one process."""
    folder = tmp_path_factory.mktemp("harmless")
    (folder / "planted_solvers.py").write_text(FAKES)
    with Keeper(ANY, folder) as keeper:

        def row_of(name, problem, units="natural", warm=False):
            limits = Limits(30.0, 30.0, 2)
            return measured_row(keeper, problem, setting(name), units, warm, limits)

        yield row_of


@pytest.fixture(scope="session")
def members():
    """Every problem of contact-qp."""
    return set_read(problem_set_folder(CONTACT_QP))


@pytest.fixture(scope="session")
def store(tmp_path_factory):
    """The folder of a study that nobody ran: rows at random, of every outcome."""
    folder = tmp_path_factory.mktemp("report") / "store"
    made_store.write_store(folder)
    return folder


@pytest.fixture(scope="session")
def rows(store):
    """Those of it that are compared: what was repeated is for the noise."""
    return [row for row in contents(store).rows if row["repetition"] == 0]


@pytest.fixture(scope="session")
def report(store):
    """The report on it."""
    return study_report(store)


@pytest.fixture(scope="session")
def tables(report):
    """Its tables, read from the page."""
    return tables_of(markdown_page(report))


@pytest.fixture
def importable(monkeypatch):
    """A function: modules of a folder can be imported, and in processes that are started too."""

    def added(folder):
        monkeypatch.syspath_prepend(str(folder))
        there = os.environ.get("PYTHONPATH", "")
        monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, [str(folder), there])))

    return added

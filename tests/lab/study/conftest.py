"""Studies small enough for a test, and functions that are broken on purpose."""

from functools import partial
from pathlib import Path

import pytest

from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.run import run_study
from quasistatic_ref.lab.study.store import rows_read
from quasistatic_ref.lab.study.study_file import solver_study

SOLVERS = '''
import os, subprocess, sys, time
import numpy as np

def honest(P, q, G, h):
    """An active-set method; digits to the last."""
    import quadprog

    x, _, _, _, z, _ = quadprog.solve_qp(P, -q, -G.T.copy(), -h)
    return x, z, "optimal"

def warm(P, q, G, h, start=None):
    x, z, status = honest(P, q, G, h)
    return x, z, status if start is None or abs(start[0] - x).max() > 0 else "again"

def zeros(P, q, G, h):
    return np.zeros(len(q)), np.zeros(len(h)), "optimal"

def too_long(P, q, G, h):
    return np.zeros(len(q) + 1), np.zeros(len(h)), "optimal"

def no_numbers(P, q, G, h):
    return ["a"] * len(q), np.zeros(len(h)), "optimal"

def pair(P, q, G, h):
    return np.zeros(len(q)), np.zeros(len(h))

def nan(P, q, G, h):
    return np.full(len(q), np.nan), np.zeros(len(h)), "optimal"

def gives_up(P, q, G, h):
    return None, None, "too many sweeps"

def denies(P, q, G, h):
    return None, None, "infeasible"

def raises(P, q, G, h):
    raise RuntimeError("no licence\\nat all")

def exits(P, q, G, h):
    os._exit(7)

def sleeps(P, q, G, h):
    """So does a program that it starts, whose id it writes down."""
    child = subprocess.Popen(["sleep", "600"])
    with open(os.path.join(os.path.dirname(__file__), "child"), "w") as file:
        file.write(str(child.pid))
    time.sleep(600)

def eats(P, q, G, h):
    held = np.ones(5 * 10**7)
    time.sleep(600)

def spoils(P, q, G, h):
    os.write(1, b"noise")
    answer = honest(P, q, G, h)
    P[:], q[:], G[:], h[:] = 0, 0, 0, 0
    return answer
'''
SMALL = """
time_limit = 20.0
repetitions = 2
[problems]
set = "contact-qp"
families = { contacts = { count = 1, most = 12 }, mass_ratio = 2 }
[solvers.mine]
function = "solvers.py:honest"
[[runs]]
solvers = ["qpsolvers:daqp", "mine"]
settings = ["default", "high"]
units = ["raw", "natural"]
"""


def study_in(root, text, **changes):
    """A study that is written beside the functions, and read."""
    (root / "solvers.py").write_text(SOLVERS)
    path = root / "study.toml"
    path.write_text('format = "quasistatic-ref/study"\nversion = 2\n' + text)
    return solver_study(path, toml_read(path), **changes)


@pytest.fixture
def study(tmp_path):
    """A function that writes a study file beside the functions, and reads it."""
    return partial(study_in, tmp_path)


@pytest.fixture
def run(study, tmp_path):
    """A function that runs a study in a folder; returns its rows."""

    def ran(text, folder="store", **options):
        return run_study(study(text), tmp_path / folder, progress=False, **options)

    return ran


@pytest.fixture(scope="module")
def whole(small, tmp_path_factory):
    """The rows of the small study, and the folder with them."""
    root = tmp_path_factory.mktemp("whole")
    return run_study(study_in(root, small), root / "store", progress=False), root / "store"


@pytest.fixture(scope="session")
def small():
    """The text of a small study."""
    return SMALL


@pytest.fixture(scope="session")
def committed():
    """The rows of the committed study of solvers."""
    return rows_read(Path(__file__).parents[3] / "validation" / "studies" / "default")


@pytest.fixture(scope="session")
def members():
    """Every problem of contact-qp."""
    return set_read(problem_set_folder(CONTACT_QP))


@pytest.fixture(scope="session")
def problem():
    """One problem of 12 contacts with its exact answer."""
    (problem,) = set_read(problem_set_folder(CONTACT_QP), ids=["mass_ratio/11.3113/35"])
    return problem

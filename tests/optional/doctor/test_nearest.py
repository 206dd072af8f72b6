import sys

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.optional.doctor import nearest as nearest_module
from quasistatic_ref.optional.doctor.nearest import nearest


@pytest.fixture
def without_daqp(monkeypatch):
    monkeypatch.setitem(sys.modules, "daqp", None)
    nearest_module._solver.cache_clear()
    yield
    nearest_module._solver.cache_clear()


def random_polyhedra(count=50):
    """Points, and rows of length one of which some are zero, about a point that obeys them all."""
    rng = np.random.default_rng(1)
    for _ in range(count):
        n, m = rng.integers(2, 8), rng.integers(1, 12)
        A = rng.normal(size=(m, n))
        A /= np.linalg.norm(A, axis=1)[:, None]
        b = A @ rng.normal(size=n) - rng.exponential(size=m) * rng.integers(2, size=m)
        A[rng.random(m) < 0.1] = 0.0
        b = np.where(A.any(axis=1), b, -1.0)
        yield rng.normal(size=n), A, b


def test_the_nearest_point_obeys_its_optimality_conditions():
    for f, A, b in random_polyhedra():
        x, lam = nearest(f, A, b)
        assert (A @ x - b).min() > -1e-10
        assert lam.min() > -1e-10
        assert x - f == pytest.approx(A.T @ lam, abs=1e-10)
        assert lam * (A @ x - b) == pytest.approx(0.0, abs=1e-10)


def test_clarabel_takes_the_place_of_daqp(without_daqp):
    for f, A, b in random_polyhedra():
        x, lam = nearest(f, A, b)
        assert x - f == pytest.approx(A.T @ lam, abs=1e-8)
        assert (A @ x - b).min() > -1e-8


def test_rows_that_contradict_each_other_have_no_nearest_point():
    A = np.array([[1.0, 0.0], [-1.0, 0.0]])
    assert nearest(np.zeros(2), A, np.ones(2)) is None


def test_a_run_without_daqp_has_the_same_findings(without_daqp):
    run = load_scenario("sphere_spin").run(progress=False)
    (one,) = run.findings
    assert one.numbers["missing_Nm"] == pytest.approx(0.1177, rel=1e-3)
    assert run.header.not_looked_at == ""

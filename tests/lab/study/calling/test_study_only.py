"""Solvers of the lab's own table: which are called, at which options, by which interface."""

import sys
from dataclasses import dataclass
from enum import IntEnum
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.calling import study_only
from quasistatic_ref.lab.study.calling.calls import call_of
from quasistatic_ref.lab.study.calling.claims import INFEASIBLE, claim
from quasistatic_ref.lab.study.calling.options import option_file, options_at
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.lab.study.calling.study_only import GUESTS, installed_here, natively
from quasistatic_ref.lab.study.file.solver_lists import solvers_named
from quasistatic_ref.solve.backends import installed
from quasistatic_ref.step.standard_form import StandardForm
from tests.extras import is_missing, marked_parameters

# min x^2 - g x, x >= b: x* = max(g / 2, b), and its multiplier is 2 x* - g.
G = 3.0
B = 2.0
X = max(G / 2, B)
LAM = 2 * X - G
FORM = StandardForm(np.array([[2.0]]), np.array([G]), np.array([[1.0]]), np.array([B]))

CALLED = marked_parameters(["qoco", "qpax", "mpax"], {"qpax": "jax", "mpax": "jax"})
"""Guests that have a native interface; two are called with JAX."""


@pytest.fixture
def only(monkeypatch):
    """A function that says which guests are installed, whatever is."""
    return lambda *names: monkeypatch.setattr(study_only, "find_spec", lambda name: name in names)


@pytest.fixture
def float64():
    """JAX, where it is installed, is left in the precision that it was in."""
    if is_missing("jax"):
        yield
        return
    import jax

    before = jax.config.jax_enable_x64
    yield
    jax.config.update("jax_enable_x64", before)


def test_the_exact_method_answers_or_says_that_there_is_no_solution():
    """The slacks of x >= b and -x >= 1 - b add up to -1, so that one of them is negative."""
    call = call_of(Solver("exact", "native", "exact"))
    found = call(FORM, {}, None)
    assert (found.solved, list(found.x), list(found.lam)) == (True, [X], [LAM])
    rows = np.array([[1.0], [-1.0]])
    none = call(FORM._replace(A=rows, b=np.array([B, 1.0 - B])), {}, None)
    assert not none.solved
    assert claim("native", "exact", none.status) == INFEASIBLE


@pytest.mark.parametrize("interface", ["qpsolvers", "cvxpy"])
def test_a_star_is_the_backends_and_the_guests_that_are_installed(only, interface):
    only()
    assert installed_here(interface) == installed(interface)
    for name, guest in GUESTS.items():
        only(guest.to_install)
        targets = [solver.target for solver in solvers_named(f"{interface}:*")]
        own = [name] if interface in guest.interfaces else []
        assert targets == [*installed(interface), *own]


@pytest.mark.parametrize(("name", "words"), [
    ("native:qoco", r"is not installed; pip install qoco \(got"),
    ("qpsolvers:qpax", "holds no solver of"),  # what would compile in every call is not called
])  # fmt: skip
def test_a_guest_that_cannot_be_called_is_refused(only, name, words):
    only()
    with pytest.raises(InputError, match=words):
        solvers_named(name)


def optimum(P, c, G, h):
    """x* = max(-c / P, h / G) for G < 0, or for G x >= h and G > 0, and its multiplier.

    By arithmetic alone, which JAX can follow.
    """
    free = -c / P[0]
    bound = h / G[0]
    x = free * (free > bound) + bound * (free <= bound)
    return x, abs((P[0] * x + c) / G[0])


class Qoco:
    """A stand-in of its class: the problem above, solved by its formula."""

    def setup(self, n, m, p, P, c, A, b, G, h, rows, nsoc, q, **settings):
        """Solve the program; at an accuracy of its own it does not claim the answer."""
        assert (n, m, p, A, b, rows, nsoc, q) == (1, 1, 0, None, None, 1, 0, None)
        self.found = optimum(P.toarray(), c, G.toarray(), h)
        self.status = "QOCO_SOLVED" if settings else "QOCO_SOLVED_INACCURATE"

    def solve(self):
        """What it found."""
        x, z = self.found
        return SimpleNamespace(x=x, z=z, status=self.status, iters=7, solve_time_sec=1e-5)


def solve_qp(Q, q, A, b, G, h, solver_tol=1e-5, backend="e"):
    """A stand-in of qpax': the same by its formula, converged where the tolerance is tight."""
    assert backend in ("e", "i")
    x, z = optimum(Q, q, G, h)
    return x, h - G[0] * x, z, b, solver_tol < 1e-5, 9


class Status(IntEnum):
    """Two of MPAX' words."""

    OPTIMAL = 2
    ITERATION_LIMIT = 6


class Said(NamedTuple):
    """A stand-in of what MPAX returns."""

    primal_solution: Any
    dual_solution: Any
    termination_status: Any
    iteration_count: Any


@dataclass
class RaPdhg:
    """A stand-in of MPAX's method."""

    eps_abs: float = 1e-4
    eps_rel: float = 1e-4
    iteration_limit: int = 2**31 - 1

    def optimize(self, p):
        """The same formula for G x >= h."""
        status = 2 + 4 * (self.iteration_limit > option_file("mpax")["others"]["iteration_limit"])
        return Said(*optimum(p["Q"], p["q"], p["G"], p["h"]), status, 11)


def create_qp(Q, q, A, b, G, h, lower, upper, use_sparse_matrix):
    """A stand-in of MPAX': one variable without bounds, one row, no equation."""
    assert A.shape == (0, 1)
    assert b.shape == (0,)
    assert (*lower, *upper) == (-np.inf, np.inf)
    assert not use_sparse_matrix
    return {"Q": Q, "q": q, "G": G, "h": h}


@pytest.fixture
def planted(monkeypatch, float64):
    """Stand-ins of three packages."""
    modules = {
        "qoco": SimpleNamespace(QOCO=Qoco),
        "qpax": SimpleNamespace(solve_qp=solve_qp, SolverParams=lambda: SimpleNamespace(tol=1e-5)),
        "mpax": SimpleNamespace(raPDHG=RaPdhg, create_qp=create_qp),
        "mpax.utils": SimpleNamespace(TerminationStatus=Status),
    }
    for name, module in modules.items():
        monkeypatch.setitem(sys.modules, name, module)


@pytest.mark.parametrize("name", CALLED)
def test_a_native_guest_gets_the_program_with_its_signs_and_its_options(planted, name):
    """Each stand-in claims to have solved it at a tight accuracy, and at its default does not."""
    call = call_of(Solver(name, "native", name))
    for options, claimed in (({}, False), (options_at(name, "native", 1e-9), True)):
        reply = call(FORM, options, None)
        assert reply.solved == claimed, reply.status
        assert list(reply.x) == [X]
        assert list(reply.lam) == [LAM]
        assert reply.iterations > 0
        assert reply.call_seconds > 0


@pytest.mark.parametrize("name", CALLED)
def test_a_guest_that_cannot_be_imported_is_said_with_its_reason(monkeypatch, float64, name):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(InputError, match=rf"cannot be imported: ModuleNotFoundError.*{name}"):
        natively(name)

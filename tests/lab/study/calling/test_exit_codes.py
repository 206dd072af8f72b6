"""Claims of solvers: read from a table of exit codes, which the solvers' own codes bear out."""

import importlib
from operator import attrgetter

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.calling.calls import call_of, reply_or_failure
from quasistatic_ref.lab.study.calling.claims import (
    HIDDEN,
    INFEASIBLE,
    NEITHER,
    OPTIMAL,
    claim,
    hides,
)
from quasistatic_ref.lab.study.calling.options import option_file
from quasistatic_ref.lab.study.calling.promises import RESIDUALS, UNSTATED
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Setting, Solver
from quasistatic_ref.lab.study.calling.study_only import installed_here
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.step.standard_form import StandardForm

HIGH = next(one for one in SETTINGS if one.name == "high")
SAY_BOTH = (
    "clarabel", "osqp", "piqp", "daqp", "quadprog", "highs", "proxqp", "exact", "scs", "qpalm",
)  # fmt: skip
"""Solvers that tell problems with a solution from those without."""
WAYS = [(interface, solver) for interface in ("native", "qpsolvers", "cvxpy")
        for solver in installed_here(interface) if solver in SAY_BOTH]  # fmt: skip
ENUMERATIONS = {
    ("native", "clarabel"): ("clarabel", "SolverStatus"),
    ("native", "piqp"): ("piqp", "Status"),
    ("qpsolvers", "proxqp"): ("proxsuite", "proxqp.QPSolverOutput"),
    ("native", "highs"): ("highspy", "HighsModelStatus"),
}


@pytest.mark.parametrize("way", ENUMERATIONS, ids=":".join)
def test_every_code_that_says_infeasible_without_reserve_is_in_the_table(way):
    """By the names of a solver's own enumeration; "almost" and "or infeasible" are no claims."""
    module, name = ENUMERATIONS[way]
    codes = [code for code in dir(attrgetter(name)(importlib.import_module(module)))
             if code[0].isupper() or code[0] == "k"]  # fmt: skip
    for code in codes:
        word = code.lower()
        sure = "almost" not in word and "closest" not in word and "orinf" not in word
        says = sure and ("infeasible" in word or word == "kunbounded")
        assert (claim(*way, code) == INFEASIBLE) == says, code


@pytest.mark.parametrize("way", WAYS, ids=":".join)
def test_each_solver_says_of_a_program_whether_it_has_a_solution(way):
    """Of x >= 1 alone, and of x >= 1 with x <= 0."""
    one = Solver(way[1], *way)
    call = call_of(one)
    options = one.settings_of(HIGH, 5.0) if one.takes(HIGH) else {}

    def claim_on(A, b):
        form = StandardForm(np.eye(1), np.zeros(1), np.array(A), np.array(b))
        return one.claim(reply_or_failure(call, form, options, None).status)

    assert claim_on([[1.0]], [1.0]) == OPTIMAL
    assert claim_on([[1.0], [-1.0]], [1.0, 0.0]) == (HIDDEN if hides(*way) else INFEASIBLE)


def test_what_an_interface_hides_is_not_said():
    assert hides("qpsolvers", "daqp")
    assert not hides("native", "daqp")
    assert claim("qpsolvers", "daqp", "not found") == HIDDEN
    assert claim("cvxpy", "osqp", "infeasible_inaccurate") == NEITHER
    assert claim("callable", "mine", "infeasible") == INFEASIBLE


@pytest.mark.parametrize("interface", ["native", "qpsolvers", "cvxpy"])
def test_every_solver_that_takes_an_accuracy_promises_residuals_of_it(interface):
    """1e-9 is asked for: no residual that the documentation states has a larger absolute part."""
    for name in installed_here(interface):
        solver = Solver(name, interface, name)
        own = option_file(name)
        if "accuracy" not in own:
            continue
        assert own["source"].startswith("https://")
        assert own["promise"]["source"].startswith("https://")
        promise = solver.promises(HIGH)
        stated = own.get(interface, {}).get("promise", own["promise"])
        assert {"primal"} <= stated.keys() <= {"source", *RESIDUALS}
        for residual in stated.keys() & set(RESIDUALS):
            if promise[residual] is not None and name != "highs":
                assert promise[residual]["abs"] in (0.0, 1e-9)
                assert promise[residual]["rel"] in (0.0, 1e-9)


def test_a_promise_is_of_the_defaults_of_an_interface_and_of_what_a_study_says_instead():
    osqp = {way: Solver("osqp", way, "osqp") for way in ("native", "cvxpy")}
    absolute = {way: one.promises(SETTINGS[0])["dual"]["abs"] for way, one in osqp.items()}
    assert absolute == {"native": 1e-3, "cvxpy": 1e-5}
    assert osqp["native"].promises(Setting("mine", None, 7.0)) == {"digits": 7.0}
    own = Solver("mine", "callable", "m:f", promised={"high": {"primal": 1e-8, "gap": False}})
    said = own.promises(HIGH)
    assert (said["primal"]["abs"], said["gap"]) == (1e-8, None)
    assert said["dual"]["rel"] == UNSTATED["rel"]  # of which nothing is said
    assert own.promises(SETTINGS[2])["gap"]["abs"] == SETTINGS[2].accuracy


def test_an_option_that_an_interface_refuses_stops_the_solver_before_the_run():
    refused = Solver("mine", "qpsolvers", "proxqp", {"high": {"eps_primal_inf": 1e-14}})
    with Keeper(refused, settings=(HIGH,)) as keeper, pytest.raises(InputError) as said:
        keeper.start()
    assert "refuses options of the setting 'high'" in str(said.value)
    assert str(said.value).count("\n") == 0

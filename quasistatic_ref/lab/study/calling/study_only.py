"""Solvers that studies call where they are installed, and with which no step is solved.

One is the exact method itself, from cold. Each is called through the interfaces that its line of
the table names. Two pairs are left out, because they compile in every call: ``qpsolvers:qpax`` and
``cvxpy:mpax``. Through their own interfaces both are compiled once for a shape, at the first call
of it, which warms up.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from time import perf_counter
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.solve.backends import BACKENDS, Backend, Options, installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm

Native = Callable[[StandardForm, Options], Reply]
"""(problem, options) -> reply, by the solver's own interface."""


@dataclass(frozen=True)
class Guest(Backend):
    """One line of the table.

    Parameters
    ----------
    interfaces : tuple of str
        Through which it is called: ``"qpsolvers"``, ``"cvxpy"`` or ``"native"``.
    native : callable or None
        Imports the solver and returns its own interface.
    """

    interfaces: tuple[str, ...] = ()
    native: Callable[[], Native] | None = None

    @property
    def to_install_it(self) -> str:
        """What to type for it: no extra brings it."""
        return f"pip install {self.to_install}"


def _exact() -> Native:
    from quasistatic_ref.lab.study.problems.answers import exact_answer

    def native(form: StandardForm, _: Options) -> Reply:
        begin = perf_counter()
        found = exact_answer(form)
        seconds = perf_counter() - begin
        if found.farkas:
            return Reply(None, None, False, "infeasible", call_seconds=seconds)
        return Reply(found.x, found.lam, True, "optimal", found.walks, call_seconds=seconds)

    return native


def _qoco() -> Native:
    from scipy.sparse import csc_matrix

    qoco = import_module("qoco")

    def native(form: StandardForm, options: Options) -> Reply:
        m, n = form.A.shape
        begin = perf_counter()
        solver = qoco.QOCO()
        P = csc_matrix(form.H)
        G = csc_matrix(-form.A)
        # P, c; no equations; G x <= h, all rows of it linear; no second-order cones.
        solver.setup(n, m, 0, P, -form.g, None, None, G, -form.b, m, 0, None, **options)
        ready = perf_counter()
        said = solver.solve()
        end = perf_counter()
        return Reply(np.array(said.x), np.array(said.z), said.status == "QOCO_SOLVED", said.status,
                     int(said.iters), said.solve_time_sec, end - begin, said.solve_time_sec,
                     ready - begin)  # fmt: skip

    return native


def _jax() -> Any:
    """JAX in float64, in the process of one solver."""
    from quasistatic_ref.optional.derivatives.step_jax import (
        jax_package,  # heavy, not every worker's
    )

    jax = jax_package()
    jax.config.update("jax_enable_x64", True)
    return jax


def _qpax() -> Native:
    jax = _jax()
    qpax = import_module("qpax")
    default = {"solver_tol": qpax.SolverParams().tol}  # given, it is the same compiled code
    solve = jax.jit(qpax.solve_qp, static_argnames="backend")

    def native(form: StandardForm, options: Options) -> Reply:
        n = len(form.g)
        begin = perf_counter()
        returned = solve(form.H, -form.g, np.zeros((0, n)), np.zeros(0), -form.A, -form.b,
                         **default | options)  # fmt: skip
        x, _, z, _, converged, iterations = map(np.array, returned)  # waits for them
        seconds = perf_counter() - begin
        status = "converged" if converged else "not converged"
        return Reply(x, z, bool(converged), status, int(iterations), call_seconds=seconds)

    return native


def _mpax() -> Native:
    jax = _jax()
    mpax = import_module("mpax")
    names = ("eps_abs", "eps_rel", "iteration_limit")
    default = {name: getattr(mpax.raPDHG, name) for name in names}
    # Options are arguments of what is compiled, which serves every accuracy.
    solve = jax.jit(lambda program, options: mpax.raPDHG(**options).optimize(program))
    words = import_module("mpax.utils").TerminationStatus

    def native(form: StandardForm, options: Options) -> Reply:
        n = len(form.g)
        free = np.full(n, np.inf)
        begin = perf_counter()
        program = mpax.create_qp(form.H, -form.g, np.zeros((0, n)), np.zeros(0), form.A, form.b,
                                 -free, free, use_sparse_matrix=False)  # fmt: skip
        ready = perf_counter()
        said = solve(program, default | options)
        x, lam = np.array(said.primal_solution), np.array(said.dual_solution)  # waits for them
        end = perf_counter()
        status = words(int(said.termination_status)).name
        return Reply(x, lam, status == "OPTIMAL", status, int(said.iteration_count),
                     call_seconds=end - begin, setup=ready - begin)  # fmt: skip

    return native


def _proxqp() -> Native:
    from scipy.sparse import issparse

    proxqp = import_module("proxsuite").proxqp

    def native(form: StandardForm, options: Options) -> Reply:
        m, n = form.A.shape
        kind = proxqp.sparse if issparse(form.H) else proxqp.dense
        begin = perf_counter()
        solver = kind.QP(n, 0, m)
        for name, value in options.items():
            setattr(solver.settings, name, value)
        solver.init(form.H, -form.g, None, None, -form.A, np.full(m, -np.inf), -form.b)
        ready = perf_counter()
        solver.solve()
        end = perf_counter()
        said = solver.results.info
        found = solver.results
        status = said.status.name
        return Reply(np.array(found.x), np.array(found.z), status == "PROXQP_SOLVED", status,
                     said.iter, call_seconds=end - begin, setup=ready - begin)  # fmt: skip

    return native


def _highs() -> Native:
    highspy = import_module("highspy")

    def native(form: StandardForm, options: Options) -> Reply:
        m, n = form.A.shape
        begin = perf_counter()
        solver = highspy.Highs()
        solver.setOptionValue("output_flag", False)
        for name, value in options.items():
            if solver.setOptionValue(name, value) != highspy.HighsStatus.kOk:
                raise ValueError(f"HiGHS refuses {name} = {value}")
        solver.passModel(_highs_model(highspy, form, m, n))
        ready = perf_counter()
        solver.run()
        end = perf_counter()
        status = solver.getModelStatus().name
        said = solver.getInfo()
        found = solver.getSolution()
        return Reply(np.array(found.col_value), np.array(found.row_dual), status == "kOptimal",
                     status, said.qp_iteration_count, call_seconds=end - begin,
                     setup=ready - begin)  # fmt: skip

    return native


def _highs_model(highspy: Any, form: StandardForm, m: int, n: int) -> Any:
    """The program as HiGHS takes it: the lower triangle of H, and A, by columns."""
    from scipy.sparse import csc_matrix, tril

    model = highspy.HighsModel()
    A = csc_matrix(form.A)
    H = tril(csc_matrix(form.H), format="csc")
    lp = model.lp_
    lp.num_col_ = n
    lp.num_row_ = m
    lp.col_cost_ = -form.g
    lp.col_lower_, lp.col_upper_ = np.full(n, -np.inf), np.full(n, np.inf)
    lp.row_lower_, lp.row_upper_ = form.b, np.full(m, np.inf)
    lp.a_matrix_.format_ = highspy.MatrixFormat.kColwise
    lp.a_matrix_.start_ = A.indptr
    lp.a_matrix_.index_ = A.indices
    lp.a_matrix_.value_ = A.data
    model.hessian_.dim_ = n
    model.hessian_.format_ = highspy.HessianFormat.kTriangular
    model.hessian_.start_ = H.indptr
    model.hessian_.index_ = H.indices
    model.hessian_.value_ = H.data
    return model


def _no_options(_: float) -> tuple[Options, ...]:
    """No step was ever solved with a guest."""
    return ({},)


Line = partial(Guest, option_sets=_no_options, steps=False, cvxpy=False)
GUESTS: dict[str, Guest] = {
    one.name: one
    for one in (
        Line("exact", "active set, exact", interfaces=("native",), native=_exact,
             package="quasistatic_ref"),
        Line("qoco", "interior point", interfaces=("cvxpy", "native"), native=_qoco),
        Line("cvxopt", "interior point", interfaces=("qpsolvers", "cvxpy"), warm=("qpsolvers",)),
        Line("ecos", "interior point", interfaces=("qpsolvers", "cvxpy")),
        Line("qpax", "interior point", interfaces=("native",), native=_qpax),
        Line("mpax", "primal-dual gradients", interfaces=("native",), native=_mpax),
    )
}  # fmt: skip
NATIVELY: dict[str, Callable[[], Native]] = {
    "proxqp": _proxqp,
    "highs": _highs,
    **{guest.name: guest.native for guest in GUESTS.values() if guest.native},
}
"""Own interfaces that no step is solved through."""
EVERY: dict[str, Backend] = BACKENDS | GUESTS
"""Every solver whose options are in a table of ours, by name."""


def known_to(interface: str) -> list[str]:
    """Names that are understood behind ``cvxpy:``, ``qpsolvers:`` or ``native:``."""
    backends = {
        "cvxpy": [b.name for b in BACKENDS.values() if b.cvxpy],
        "qpsolvers": list(BACKENDS),
        "native": [name for name in NATIVELY if name in BACKENDS],
    }
    guests = [guest.name for guest in GUESTS.values() if interface in guest.interfaces]
    return backends[interface] + guests


def installed_here(interface: str) -> tuple[str, ...]:
    """Those of them that are installed: backends first.

    Parameters
    ----------
    interface : str
    """
    joining = [name for name in known_to(interface) if name in GUESTS]
    joining += [name for name in NATIVELY if name in BACKENDS and interface == "native"]
    here = (name for name in joining if find_spec(EVERY[name].to_install))
    own = () if interface == "native" else installed(interface)
    return own + tuple(here)


def natively(name: str) -> Native:
    """The own interface of a solver of ``NATIVELY``.

    Parameters
    ----------
    name : str

    Raises
    ------
    InputError
        If it cannot be imported.
    """
    try:
        return NATIVELY[name]()
    except Exception as error:  # a module may raise anything when it is imported
        words = f"cannot be imported: {type(error).__name__}: {error}"
        raise InputError(words, value=name) from None

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
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.solve.backends import BACKENDS, Backend, Options, at_accuracy, installed
from quasistatic_ref.step.standard_form import StandardForm

Native = Callable[[StandardForm, Options], Reply]
"""(problem, options) -> reply, by the solver's own interface."""
ITERATIONS = 20_000
"""Of MPAX, as of the other first-order methods in a study: its default is 2^31."""


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
        P, G = csc_matrix(form.H), csc_matrix(-form.A)
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
    jax, qpax = _jax(), import_module("qpax")
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
    jax, mpax = _jax(), import_module("mpax")
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


def _as_plain(plain: Callable[[float], Options], **others: Any) -> dict[str, Any]:
    """The options of a setting, also for ``tuned``: no step was ever tuned for a guest."""
    return {"plain": plain, "attempts": lambda accuracy: (plain(accuracy) | others,)}


Line = partial(Guest, steps=False, cvxpy=False)
GUESTS: dict[str, Guest] = {
    one.name: one
    for one in (
        # Without rounding, and so without options.
        Line("exact", "active set, exact", lambda _: ({},), None, interfaces=("native",),
             native=_exact, package="quasistatic_ref"),
        # abstol, reltol: of residuals and gap. https://qoco-org.github.io/qoco/api/settings.html
        Line("qoco", "interior point", **_as_plain(at_accuracy("abstol", "reltol")),
             interfaces=("cvxpy", "native"), native=_qoco),
        # feastol: of residuals; abstol, reltol: of the gap.
        # https://cvxopt.org/userguide/coneprog.html#algorithm-parameters
        Line("cvxopt", "interior point", **_as_plain(at_accuracy("feastol", "abstol", "reltol")),
             interfaces=("qpsolvers", "cvxpy")),
        # As CVXOPT's. https://github.com/embotech/ecos-python#calling-ecos-from-python
        Line("ecos", "interior point", **_as_plain(at_accuracy("feastol", "abstol", "reltol")),
             interfaces=("qpsolvers", "cvxpy")),
        # solver_tol: of residuals and of each product s_i z_i. https://github.com/kevin-tracy/qpax
        # Its "explicit" method keeps s and z above 1.5e-8, and so reports no convergence at 1e-9;
        # its "implicit" one does.
        Line("qpax", "interior point", **_as_plain(at_accuracy("solver_tol"), backend="i"),
             interfaces=("native",), native=_qpax),
        # Both of residuals and gap; eps_rel = 0 divides by zero. https://github.com/MIT-Lu-Lab/MPAX
        Line("mpax", "primal-dual gradients",
             **_as_plain(at_accuracy("eps_abs", "eps_rel", iteration_limit=ITERATIONS)),
             interfaces=("native",), native=_mpax),
    )
}  # fmt: skip
EVERY: dict[str, Backend] = BACKENDS | GUESTS
"""Every solver whose options are in a table of ours, by name."""


def known_to(interface: str) -> list[str]:
    """Names that are understood behind ``cvxpy:``, ``qpsolvers:`` or ``native:``."""
    backends = {
        "cvxpy": [b.name for b in BACKENDS.values() if b.cvxpy],
        "qpsolvers": list(BACKENDS),
        "native": [b.name for b in BACKENDS.values() if b.adapter],
    }
    guests = [guest.name for guest in GUESTS.values() if interface in guest.interfaces]
    return backends[interface] + guests


def installed_here(interface: str) -> tuple[str, ...]:
    """Those of them that are installed: backends first.

    Parameters
    ----------
    interface : str
    """
    guests = (guest for guest in GUESTS.values() if interface in guest.interfaces)
    return installed(interface) + tuple(
        guest.name for guest in guests if find_spec(guest.to_install)
    )


def natively(name: str) -> Native:
    """A guest's own interface.

    Parameters
    ----------
    name : str

    Raises
    ------
    InputError
        If it cannot be imported.
    """
    opened = GUESTS[name].native
    assert opened is not None  # known_to has refused the others
    try:
        return opened()
    except Exception as error:  # a module may raise anything when it is imported
        words = f"cannot be imported: {type(error).__name__}: {error}"
        raise InputError(words, value=name) from None

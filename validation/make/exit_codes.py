"""Raw exit codes of solvers next to what a study reads from them.

``python -m validation.make.exit_codes`` (about four minutes) gives every installed solver 40
problems without a solution and 40 with one (``--count``), through its own interface in the plainest
way. It prints its codes, what the solver's manual says that they mean, and what the study takes
them for through each of the interfaces. The options are those of the setting ``high``. Only the
matrices are shared with the study: neither its adapters nor its table of exit codes.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, triu

from quasistatic_ref.lab.folders import CONTACT_QP_1, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.study.calling.calls import call_of, reply_or_failure
from quasistatic_ref.lab.study.calling.claims import HIDDEN, INFEASIBLE, NEITHER, OPTIMAL, hides
from quasistatic_ref.lab.study.calling.guests import installed_here
from quasistatic_ref.lab.study.calling.options import options_at
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Solver
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.step.standard_form import StandardForm
from validation.tools.scripts import asked, shown

HIGH = next(setting for setting in SETTINGS if setting.name == "high")
INTERFACES = ("native", "qpsolvers", "cvxpy")
FAMILIES = ("infeasible", "wedge", "contacts")
"""Without a solution; with one, hard to tell from none; with one, and easy."""
SECONDS = 5.0
"""Of a call through an interface [s]."""
INNER = {"max_iter_in": 50}
"""Of ProxQP in its own interface, which may otherwise take minutes to say that there is none."""


def given(settings: Any, options: dict) -> Any:
    """Settings with these options."""
    for name, value in options.items():
        setattr(settings, name, value)
    return settings


def clarabel(form: StandardForm, options: dict) -> object:
    """Its SolverStatus."""
    import clarabel as package

    settings = given(package.DefaultSettings(), options)
    settings.verbose = False
    settings.presolve_enable = False
    P = csc_matrix(np.triu(form.H))
    A = csc_matrix(-form.A)
    cones = [package.NonnegativeConeT(len(form.b))]
    return package.DefaultSolver(P, -form.g, A, -form.b, cones, settings).solve().status


def osqp(form: StandardForm, options: dict) -> object:
    """Its status_val."""
    import osqp as package

    P = triu(csc_matrix(form.H))
    A = csc_matrix(form.A)
    above = np.full(len(form.b), np.inf)
    solver = package.OSQP()
    solver.setup(P=csc_matrix(P), q=-form.g, A=A, l=form.b, u=above, verbose=False, **options)
    return package.SolverStatus(solver.solve(raise_error=False).info.status_val)


def piqp(form: StandardForm, options: dict) -> object:
    """Its Status."""
    import piqp as package

    solver = package.DenseSolver()
    given(solver.settings, options)
    solver.setup(form.H, -form.g, None, None, form.A, form.b, None)
    return solver.solve()


def daqp(form: StandardForm, options: dict) -> object:
    """Its exit flag."""
    import daqp as package

    upper = np.full(len(form.b), np.inf)
    sense = np.zeros(len(form.b), dtype=np.int32)
    H, f, A = (np.ascontiguousarray(part) for part in (form.H, -form.g, form.A))
    return package.solve(H, f, A, upper, form.b, sense, **options)[2]


def proxqp(form: StandardForm, options: dict) -> object:
    """Its QPSolverOutput."""
    from proxsuite import proxqp as package

    m, n = form.A.shape
    solver = package.dense.QP(n, 0, m)
    given(solver.settings, options | INNER)
    solver.init(form.H, -form.g, None, None, -form.A, np.full(m, -np.inf), -form.b)
    solver.solve()
    return solver.results.info.status


def scs(form: StandardForm, options: dict) -> object:
    """Its status_val."""
    import scs as package

    P = csc_matrix(np.triu(form.H))
    A = csc_matrix(-form.A)
    data = {"P": P, "c": -form.g, "A": A, "b": -form.b}
    solver = package.SCS(data, {"l": len(form.b)}, verbose=False, **options)
    return solver.solve()["info"]["status_val"]


def highs(form: StandardForm, options: dict) -> object:
    """Its HighsModelStatus."""
    import highspy

    solver = highspy.Highs()
    solver.silent()
    for name, value in {**options, "time_limit": SECONDS}.items():
        solver.setOptionValue(name, value)
    n = len(form.g)
    inf = highspy.kHighsInf
    for i in range(n):
        solver.addVar(-inf, inf)
        solver.changeColCost(i, float(-form.g[i]))
    for row, least in zip(form.A, form.b, strict=True):
        solver.addRow(float(least), inf, n, np.arange(n, dtype=np.int32), row)
    H = csc_matrix(np.tril(form.H))
    kind = highspy.HessianFormat.kTriangular.value
    solver.passHessian(n, H.nnz, kind, H.indptr, H.indices, H.data)
    solver.run()
    return solver.getModelStatus()


def quadprog(form: StandardForm, options: dict) -> object:
    """What it raises, or that it returned."""
    import quadprog as package

    try:
        package.solve_qp(form.H.copy(), form.g.copy(), form.A.T.copy(), form.b.copy())
    except ValueError as error:
        return str(error)
    return "returned"


def qpalm(form: StandardForm, options: dict) -> object:
    """Its status_val."""
    import qpalm as package

    m, n = form.A.shape
    data = package.Data(n, m)
    data.Q, data.A = csc_matrix(np.triu(form.H)), csc_matrix(form.A)
    data.q, data.bmin, data.bmax = -form.g, form.b, np.full(m, np.inf)
    settings = given(package.Settings(), options)
    settings.verbose = False
    solver = package.Solver(data, settings)
    solver.solve()
    return solver.info.status_val


RAW = {
    one.__name__: one for one in (clarabel, osqp, piqp, daqp, proxqp, scs, highs, quadprog, qpalm)
}
MEANING = {
    "clarabel": {OPTIMAL: ("Solved",), INFEASIBLE: ("PrimalInfeasible", "DualInfeasible")},
    "osqp": {OPTIMAL: ("OSQP_SOLVED",),
             INFEASIBLE: ("OSQP_PRIMAL_INFEASIBLE", "OSQP_DUAL_INFEASIBLE")},
    "piqp": {OPTIMAL: ("PIQP_SOLVED",),
             INFEASIBLE: ("PIQP_PRIMAL_INFEASIBLE", "PIQP_DUAL_INFEASIBLE")},
    "daqp": {OPTIMAL: ("1",), INFEASIBLE: ("-1", "-3", "-6")},
    "proxqp": {OPTIMAL: ("PROXQP_SOLVED",),
               INFEASIBLE: ("PROXQP_PRIMAL_INFEASIBLE", "PROXQP_DUAL_INFEASIBLE")},
    "scs": {OPTIMAL: ("1",), INFEASIBLE: ("-1", "-2")},
    "highs": {OPTIMAL: ("kOptimal",), INFEASIBLE: ("kInfeasible", "kUnbounded")},
    "quadprog": {OPTIMAL: ("returned",),
                 INFEASIBLE: ("constraints are inconsistent, no solution",)},
    "qpalm": {OPTIMAL: ("1",), INFEASIBLE: ("-3", "-4")},
}  # fmt: skip
"""What the manuals say that codes mean; every other code claims neither."""


def meaning(solver: str, code: str) -> str:
    """What a raw code of a solver claims by its manual."""
    own = MEANING[solver].items()
    return next((claim for claim, codes in own if code in codes), NEITHER)


def problems(count: int) -> list[Problem]:
    """So many problems without a solution, and so many with one, along their dials."""
    found = []
    for family, share in zip(FAMILIES, (count, count // 2, count - count // 2), strict=True):
        own = set_read(problem_set_folder(CONTACT_QP_1), [family])
        found += [own[i * len(own) // share] for i in range(share)]
    return found


def name_of(code: object) -> str:
    """A code without its enumeration; as a number where it has no name."""
    name = getattr(code, "name", None)
    return str(code) if name is None else str(name)


def claims_of(solver: str, interface: str, some: Sequence[Problem]) -> list[str]:
    """What the study takes a solver's replies for."""
    one = Solver(solver, interface, solver)
    call = call_of(one)
    options = one.settings_of(HIGH, SECONDS) if one.takes(HIGH) else {}
    options |= INNER if one.label == "native:proxqp" else {}
    replies = [reply_or_failure(call, p.natural.form, options, None) for p in some]
    return [one.claim(reply.status) for reply in replies]


def compared(solver: str, some: Sequence[Problem]) -> tuple[list[tuple[str, ...]], str, int]:
    """What a solver says: of each code its meaning, how often, and the study's claims there.

    Then the interface that says most, and in how many calls code and claim agree through it.
    """
    options = {} if solver == "quadprog" else options_at(solver, "native", HIGH.accuracy or 0.0)
    codes = [name_of(RAW[solver](p.natural.form, options)) for p in some]
    here = [one for one in INTERFACES if solver in installed_here(one)]
    read = {one: claims_of(solver, one, some) for one in here}
    rows = []
    for code, count in Counter(codes).most_common():
        own = [i for i, c in enumerate(codes) if c == code]
        feasible = sum(some[i].feasible for i in own)
        cells = (counted(read[one][i] for i in own) if one in read else "-" for one in INTERFACES)
        means = meaning(solver, code)
        rows.append((solver, code, means, str(count - feasible), str(feasible), *cells))
    most = next((one for one in here if not hides(one, solver)), here[0])
    agree = sum(meaning(solver, c) == said for c, said in zip(codes, read[most], strict=True))
    return rows, most, agree


def counted(claims: Iterator[str]) -> str:
    """How often each claim was read; what an interface hides is not said."""
    words = {HIDDEN: "not said"}
    return ", ".join(f"{n} {words.get(one, one)}" for one, n in Counter(claims).most_common())


def written(count: int) -> tuple[str, int]:
    """The page, and in how many calls code and claim differ."""
    some = problems(count)
    rows = []
    sums = []
    differ = 0
    for solver in RAW:
        if any(solver in installed_here(one) for one in INTERFACES):
            own, most, agree = compared(solver, some)
            rows += own
            sums.append((solver, most, f"{agree} of {len(some)}"))
            differ += len(some) - agree
    names = ("solver", "raw exit code", "by its manual", "without a solution", "with one",
             *(f"read, {one}" for one in INTERFACES))  # fmt: skip
    table = "\n".join(markdown_table(names, rows, 3))
    agreement = "\n".join(markdown_table(("solver", "interface", "code and claim agree"), sums, 2))
    return PAGE.format(count=count, table=table, differ=differ, agreement=agreement), differ


PAGE = """# Exit codes, and what a study reads

{count} problems of contact-qp-1 without a solution and {count} with one, in natural units at the \
options of `high`. The first columns are the solver's own, called without any code of the study; \
the last are what the study reads through each interface. Where an interface has one word for \
several codes, nothing was said.

{table}

## Agreement

Through the interface that says most; {differ} calls differ.

{agreement}"""


def main() -> None:
    """Write the page; exit status 1 if a code and a claim differ."""
    options = asked(__doc__, count=40, out=Path)
    text, differ = written(options.count)
    shown(text, options.out)
    raise SystemExit(int(differ > 0))


if __name__ == "__main__":
    main()

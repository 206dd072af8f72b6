"""The claims of a store judged again, by its residuals and today's files of options."""

import tempfile
from collections.abc import Iterable
from functools import partial
from pathlib import Path

from quasistatic_ref.lab.study.calling.claims import claim
from quasistatic_ref.lab.study.calling.promises import promise_of
from quasistatic_ref.lab.study.calling.study_only import EVERY
from quasistatic_ref.lab.study.measuring.false_claims import exact_terms, judged
from quasistatic_ref.lab.study.problems.names import NATURAL
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.store.continued import solver_label
from quasistatic_ref.lab.study.store.pack import packed_store
from quasistatic_ref.lab.study.store.rows import Row, label_of
from quasistatic_ref.lab.study.store.store import Contents, Store


def judged_again(found: Contents, problems: Iterable[Problem]) -> Contents:
    """A store whose claims are judged again; what was measured stays.

    Parameters
    ----------
    found : Contents
    problems : iterable of Problem
        Those of the store.

    Returns
    -------
    Contents
        A row keeps its verdict if that needs the answer, which is not in the store: one on a
        problem without a solution, and a claim that there is none, which may have a certificate.
    """
    terms = {}
    for one in problems:
        for units, own in (("raw", one), (NATURAL, one.natural)):
            terms[one.id, units] = exact_terms(own.form, own.answer)
    digits = {one["name"]: one["promised"] for one in found.study["settings"]}
    solvers = {}
    for solver in found.study["solvers"]:
        say = partial(promise_of, str(solver["target"]), solver["interface"])
        known = (
            solver["interface"] in ("cvxpy", "qpsolvers", "native") and solver["target"] in EVERY
        )
        today = {
            name: {"digits": digits[name]} if digits[name] is not None else say(options)
            for name, options in solver["options"].items()
        }
        solvers[solver_label(solver)] = solver | ({"promise": today} if known else {})

    def again(row: Row) -> Row:
        solver = solvers[label_of(row)]
        said = claim(row["interface"], str(solver["target"]), row["claimed"])
        promise = solver["promise"][row["setting"]]
        exact = terms[row["problem"], row["units"]]
        if exact is None:
            return row
        new = judged(row, said, promise, exact)
        return new | ({"wrong": row["wrong"]} if new["said_infeasible"] else {})

    study = found.study | {"solvers": list(solvers.values())}
    return Contents(study, list(map(again, found.rows)), found.problems, found.unreached)


def write_packed(found: Contents, out: Path) -> None:
    """Write a packed store of what a store holds."""
    with tempfile.TemporaryDirectory() as folder:
        with Store(folder, found.study, found.problems) as store:
            store.add(*found.rows)
            store.keep_unreached(found.unreached)
        packed_store(folder, out)

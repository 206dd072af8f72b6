"""The terms of a user's extension, checked: constraints and scalar costs that hold numbers."""

from __future__ import annotations

from collections.abc import Iterable

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.extensions.extension import Extension, Symbols

CHAINED = "truth value of a constraint"
"""Words of CVXPY's error about ``-1 <= x <= 1``, which Python reads as two truths."""
ORDERS = (cp.constraints.Inequality, cp.constraints.NonPos, cp.constraints.NonNeg)


def checked_terms(extension: Extension, symbols: Symbols) -> list[cp.Constraint | cp.Expression]:
    """What the extension's function returns, without rows that bind nothing.

    Parameters
    ----------
    extension : Extension
    symbols : Symbols

    Raises
    ------
    InputError
        Naming the term that is no constraint or scalar cost, or holds what is no number.
    """
    try:
        terms = extension.terms(symbols)
    except Exception as error:
        if CHAINED not in str(error):  # an error of the user's own function
            raise
        problem = "compares twice in one line; write -1 <= x <= 1 as the two constraints"
        raise InputError(f"{problem} -1 <= x, x <= 1", field="extension") from error
    if isinstance(terms, cp.Constraint | cp.Expression) or not isinstance(terms, Iterable):
        problem = "must return a list of constraints and costs: [...]"
        raise InputError(problem, field="extension", value=type(terms).__name__)
    known = {p.id for slack in symbols.slack for p in slack.parameters()}  # of the step itself
    kept = []
    for k, term in enumerate(terms):
        field = f"extension, term {k}"
        if isinstance(term, cp.Minimize | cp.Maximize):
            sign = "" if isinstance(term, cp.Minimize) else "-"
            problem = f"is an objective; a cost is an expression, which is minimised: {sign}(...)"
            raise InputError(problem, field=field, value=type(term).__name__)
        if not isinstance(term, cp.Constraint | cp.Expression):
            problem = "must be a constraint or a cost of CVXPY"
            raise InputError(problem, field=field, value=type(term).__name__)
        _check_numbers(term, field, known)
        if isinstance(term, cp.Expression) and term.size != 1:
            problem = "is a cost of several numbers; add them up, as by cp.sum"
            raise InputError(problem, field=field, value=list(term.shape))
        bound = _bounding(term, field) if isinstance(term, ORDERS) else term
        if bound is not None:
            kept.append(bound)
    return kept


def _check_numbers(term: cp.Constraint | cp.Expression, field: str, known: set[int]) -> None:
    """Refuse a term with a Parameter without value, or with numbers that are not finite."""
    parameters = [p for p in term.parameters() if p.id not in known]
    for parameter in parameters:
        if parameter.value is None:
            problem = "holds a Parameter without a value; set its value"
            raise InputError(problem, field=field, value=parameter.name())
    endless = not isinstance(term, ORDERS)
    for constant in [*term.constants(), *parameters]:
        value = constant.value
        numbers = np.asarray(value.data if hasattr(value, "tocsc") else value, dtype=np.float64)
        if np.isnan(numbers).any() or (endless and np.isinf(numbers).any()):
            problem = "holds a number that is not finite; replace it"
            raise InputError(problem, field=field, value=constant.name())


def _bounding(order: cp.Constraint, field: str) -> cp.Constraint | None:
    """An inequality without rows of infinite limit; None if no row is left."""
    expression = order.expr if isinstance(order, cp.constraints.Inequality) else order.args[0]
    constants = [np.asarray(c.value) for c in [*expression.constants(), *expression.parameters()]
                 if c.value is not None and not hasattr(c.value, "tocsc")]  # fmt: skip
    if not any(np.isinf(c).any() for c in constants):
        return order
    upper = -1.0 if isinstance(order, cp.constraints.NonNeg) else 1.0
    # Which numbers they are does not matter: where a limit is infinite, so is the value.
    for symbol in [*expression.variables(), *expression.parameters()]:
        if symbol.value is None:
            symbol.value = np.zeros(symbol.shape)
    with np.errstate(invalid="ignore"):
        value = upper * np.asarray(expression.value, dtype=np.float64)
    if np.isnan(value).any() or (value == np.inf).any():
        problem = "has an infinite limit that nothing can keep; turn its sign"
        raise InputError(problem, field=field, value=str(order))
    finite = np.isfinite(value)
    if not finite.any():
        return None
    return order if finite.all() else upper * expression[np.nonzero(finite)] <= 0

"""What a solver promises of the residuals of an answer that it calls optimal.

The table `promise` of a solver in ``solvers.toml`` has the criteria that the solver's documentation
states, with the page: residual <= abs + rel times the largest of some terms, where abs and rel are
options. The author of a function can state the same, with numbers.
"""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.solve.backends import Options

Promise = dict[str, Any]
"""Residual -> {abs, rel, of, complementarity}, or None."""
RESIDUALS = ("primal", "dual", "gap")
TERMS = {
    "primal": ["|Ax|", "|s|", "|b|"],
    "dual": ["|Hx|", "|A'lam|", "|g|"],
    "gap": ["|x'Hx|", "|g'x|", "|b'lam|"],
}
"""What each residual is the difference of: its terms where a promise names none."""
KNOWN = {
    "1",
    "m",
    "cost",
    "|x|2",
    "|s|2",
    "|b|2",
    "|g|2",
    "|lam|2",
    *TERMS["primal"],
    *TERMS["dual"],
    *TERMS["gap"],
}
"""Terms that a promise can name."""
UNSTATED = {"abs": 1e-3, "rel": 1e-3}
"""What is promised of a residual of which the documentation, or the author, says nothing: the
loosest default of a solver in the table, OSQP's [-]."""


def promise_stated(value: Mapping[str, Any]) -> Mapping[str, Any]:
    """What an author states of a setting, a table of residuals, checked.

    Raises
    ------
    ValueError, TypeError
        With what is wrong.
    """
    for name, criterion in value.items():
        if name not in RESIDUALS:
            raise ValueError(f"{name} is no residual")
        for field, one in (
            criterion.items() if isinstance(criterion, dict) else {"abs": criterion}.items()
        ):
            if field == "of":
                unknown = {term for words in one for term in words.split(" + ")} - KNOWN
                if unknown or not one:
                    raise ValueError(f"{', '.join(sorted(unknown)) or 'nothing'} is no term")
            elif field not in ("abs", "rel") or not float(one) >= 0:
                raise ValueError(f"{field} = {one!r}")
    return value


def resolved(stated: Mapping[str, Any], values: Options) -> Promise:
    """The criteria of a table, with the values of the options that they name.

    Parameters
    ----------
    stated : mapping
        Residual -> number; or a table of abs, rel, of, complementarity and, of an option without
        which the residual is not tested, if; or false, where the documentation says that it is not
        tested. What is not stated is held to ``UNSTATED``, a gap then in its complementarity alone.
    values : dict
    """
    return {name: _criterion(name, stated.get(name), values) for name in RESIDUALS}


def _criterion(name: str, stated: Any, values: Options) -> Promise | None:
    if stated is None:
        stated = UNSTATED | {"complementarity": name == "gap"}
    elif stated is not False and not isinstance(stated, Mapping):
        stated = {"abs": float(stated)}
    if not stated or not values.get(stated.get("if"), "if" not in stated):
        return None
    numbers = {of: stated.get(of, 0.0) for of in ("abs", "rel")}
    return {
        **{of: float(values[v] if isinstance(v, str) else v) for of, v in numbers.items()},
        "of": list(stated.get("of", TERMS[name])),
        "complementarity": bool(stated.get("complementarity", False)),
    }

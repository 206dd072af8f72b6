"""What a solver promises of the residuals of an answer that it calls optimal.

The table `promise` of ``options/NAME.toml`` has the criteria that the solver's documentation
states, with the page: residual <= abs + rel times the largest of some terms, where abs and rel are
options. A study file can state the same, with numbers, of a solver of its own.
"""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.lab.study.calling.options import Options, option_file, tolerances

Promise = dict[str, Any]
"""Residual -> {abs, rel, of, complementarity}, or None; else ``{"digits": number}``."""
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


def promise_of(name: str, interface: str, options: Options) -> Promise:
    """What a solver of the table promises at some options.

    Parameters
    ----------
    name, interface : str
    options : dict
        That it was given.

    Examples
    --------
    >>> from quasistatic_ref.lab.study.calling.promises import promise_of
    >>> promise_of("osqp", "native", {"eps_abs": 1e-9, "eps_rel": 0.0})["primal"]["abs"]
    1e-09
    """
    own = option_file(name)
    stated = own.get(interface, {}).get("promise", own.get("promise", {}))
    return resolved(stated, tolerances(name, interface, options))


def promise_stated(value: Any) -> float | dict[str, Any]:
    """What an author states of a setting, checked: digits, or a table of residuals.

    Raises
    ------
    ValueError, TypeError
        With what is wrong.
    """
    if not isinstance(value, dict):
        return float(value)
    for name, own in value.items():
        if name not in RESIDUALS:
            raise ValueError(f"{name} is no residual")
        for field, one in own.items() if isinstance(own, dict) else {"abs": own}.items():
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


def promise_words(promise: Promise) -> str:
    """A promise as a report prints it."""
    if "digits" in promise:
        return f"{promise['digits']:g} digits"
    return "; ".join(f"{name} {_words(own)}" for name, own in promise.items())


def _words(own: Promise | None) -> str:
    if own is None:
        return "not tested"
    largest = own["of"][0] if len(own["of"]) == 1 else f"max({', '.join(own['of'])})"
    parts = [f"{own['abs']:g}"] if own["abs"] or not own["rel"] else []
    parts += [f"{own['rel']:g} {largest}"] if own["rel"] else []
    return " + ".join(parts)

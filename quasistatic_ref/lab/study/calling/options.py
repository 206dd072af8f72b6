"""The options of solvers: one file a solver, ``lab/study/options/NAME.toml``.

Each names the page of the solver's documentation. An author of a solver can add a note, `author`,
which reports print. `accuracy` are the options that a setting sets to its accuracy: those of the
residuals, of the duality gap, and of what proves that there is no solution; `others` go with them.
`defaults` are the solver's own tolerances of residuals and gap. A table of an interface has what
differs there, and what the interface refuses.
"""

import math
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

Options = dict[str, Any]
FOLDER = Path(__file__).parents[1] / "options"
NO_TOLERANCE = 3.0
"""Digits that "optimal" promises [-] where nothing is known of a tolerance."""


@cache
def option_file(name: str) -> dict[str, Any]:
    """What the file of a solver holds; empty for a solver that has none."""
    path = FOLDER / f"{name}.toml"
    return tomllib.loads(path.read_text("utf-8")) if path.exists() else {}


def has_accuracy(name: str) -> bool:
    """Whether a solver can be set to an accuracy."""
    return "accuracy" in option_file(name)


def options_at(name: str, interface: str, accuracy: float) -> Options:
    """The plain options of an accuracy.

    Parameters
    ----------
    name : str
        Of a solver that can be set to an accuracy.
    interface : str
    accuracy : float
        Of residuals and gap, in the units of the problem as given [-].
    """
    own = option_file(name)
    refused = own.get(interface, {}).get("refused", ())
    names = [option for option in own["accuracy"] if option not in refused]
    others: Options = own.get("others", {})
    return dict.fromkeys(names, max(accuracy, own.get("floor", 0.0))) | others


def promised_digits(name: str, interface: str, options: Options) -> float:
    """Correct digits of delta_q that an "optimal" promises at some options [-].

    The largest of the tolerances of residuals and gap counts, as the solver was given it or has it
    by default.

    Parameters
    ----------
    name, interface : str
    options : dict
    """
    own = option_file(name)
    defaults = own.get("defaults", {}) | own.get(interface, {}).get("defaults", {})
    tolerances = [options.get(option, default) for option, default in defaults.items()]
    return digits_of_accuracy(max(tolerances, default=0.0))


def digits_of_accuracy(accuracy: float | None) -> float:
    """Half of the digits of an accuracy, rounded down to a half [-].

    By strong convexity ||x - x*||_H^2 <= 2 gap: an accuracy of eps promises an error of sqrt(2 eps)
    in natural units.

    Examples
    --------
    >>> from quasistatic_ref.lab.study.calling.options import digits_of_accuracy
    >>> digits_of_accuracy(1e-3), digits_of_accuracy(1e-9)
    (1.0, 4.0)
    """
    if not accuracy:
        return NO_TOLERANCE
    return max(math.floor(-math.log10(2 * accuracy)) / 2, 0.0)

"""The options of solvers: one file a solver, ``lab/study/options/NAME.toml``.

Each names the page of the solver's documentation. `accuracy` are the options that a setting sets to
its accuracy: those of the residuals, of the duality gap, and of what proves that there is no
solution; `others` go with them, and `always` are set at every setting. `defaults` are the solver's
own tolerances of residuals and gap, and `promise` says what it promises by them (``promises.py``).
`sparse` are the interfaces that take sparse matrices. A table of an interface has what differs
there, and what the interface refuses.
"""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

Options = dict[str, Any]
FOLDER = Path(__file__).parents[1] / "options"


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
    options: Options = dict.fromkeys(own["accuracy"], max(accuracy, own.get("floor", 0.0)))
    options |= own.get("others", {})
    return {option: value for option, value in options.items() if option not in refused}


def takes_sparse(name: str, interface: str) -> bool:
    """Whether a solver is given sparse matrices as they are; otherwise it is given arrays."""
    if interface in ("qpsolvers", "native"):
        return interface in option_file(name).get("sparse", ())
    return interface != "executable"


def tolerances(name: str, interface: str, options: Options) -> Options:
    """The tolerances of a solver as it was given them, or has them by default."""
    own = option_file(name)
    defaults: Options = own.get("defaults", {}) | own.get(interface, {}).get("defaults", {})
    return defaults | options

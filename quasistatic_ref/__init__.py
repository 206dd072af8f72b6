"""Reference implementation of convex quasi-dynamic simulation with torsional friction.

The model is that of Tracy & Manchester, "Convex Quasi-Dynamic Simulation of Rigid Point
Clouds with Torsional Friction"; equation numbers everywhere in this package are the paper's.
docs/contributing.md, "Read the code", names the files of a step in the order of its calls.

The names that ``__init__.pyi`` re-exports are loaded on first use, so that ``import quasistatic_ref
as qr`` is cheap and ``step``, ``certify`` and ``solve`` work where pinocchio and coal are not
installed. None of them is the name of a sub-package, which Python would put in its place once that
is imported, but ``figures``, which is that module.
"""

import ast
from importlib import import_module
from pathlib import Path

__version__ = "0.1.0"


def homes(module: str) -> dict[str, str]:
    """The names that the stub of a module re-exports, and the modules that they come from.

    Parameters
    ----------
    module : str
        Its file, beside which the stub stands.
    """
    stub = ast.parse(Path(module).with_suffix(".pyi").read_text("utf-8"))
    return {
        name.name: str(statement.module)
        for statement in stub.body
        if isinstance(statement, ast.ImportFrom)
        for name in statement.names
    }


_HOME = homes(__file__)

__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> object:
    if name == "figures":
        return import_module(f"{__name__}.figures")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    with import_module(f"{__name__}.parts").needing(name):
        return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return __all__

"""A solver that is a function of the user's: (P, q, G, h) -> (x, z, status)."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import BackendError, InputError
from quasistatic_ref.numbers.arrays import Array, Mask, as_caller
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData

Function = Callable[..., Any]
OPTIMAL = "optimal"
"""The status of a function that claims a full solution."""
WORDS = 200
"""Characters of what a function raised or returned that are kept."""


class FunctionSolver(BackendSolver):
    """A function (P, q, G, h) -> (x, z, status) that solves steps in natural units.

    It gets min 1/2 x'Px + q'x, G x <= h, and returns x (n_v,), the multipliers z >= 0 (m,), and
    ``"optimal"`` or another word.

    Parameters
    ----------
    template : StepData
        A step in the cone of those that are to be solved.
    function : callable or str
        The function, or ``MODULE:FUNCTION``, or ``FILE.py:FUNCTION``.
    """

    interface = "function"
    fixed = ("cone",)

    def __init__(self, template: StepData, function: Function | str) -> None:
        name = function if isinstance(function, str) else called(function)
        if not cone(template.cone).polyhedral:
            problem = f"is a function, which takes linear rows only; not the {template.cone}"
            raise BackendError(problem, field="backend", value=str(function))
        super().__init__(template, name)
        self.wanted = function
        self.function = function_at(function) if isinstance(function, str) else function

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.template, self.wanted)

    def option_sets(self, accuracy: float) -> list[tuple[float, Options]]:
        """The accuracy of the call [-], with no options."""
        return [(accuracy, {})]

    def write(self, natural: NaturalStep) -> Mask:
        """Form H, g, A, b; tell which rows are out of reach, shape (m,)."""
        self.form = natural.within_reach
        return natural.out_of_reach

    def reply_with(self, options: Options, natural: NaturalStep) -> Reply:
        """The reply of the user's function to the program in natural units."""
        H, g, A, b = self.form
        with apart():
            returned = as_caller(self.function, H.copy(), -g, -A, -b)
        return reply_of(returned, len(g), len(b))


def reply_of(returned: object, n: int, m: int) -> Reply:
    """What a function has returned, if it is (x, z, status) of the right shapes.

    Parameters
    ----------
    returned : object
    n, m : int
        Of coordinates and of rows.
    """
    if not isinstance(returned, tuple) or len(returned) != 3:
        words = f"returned a {type(returned).__name__} in place of (x, z, status)"
        return Reply(None, None, False, words)
    x, z, status = returned
    if not isinstance(status, str):
        words = f"returned a {type(status).__name__} in place of a status"
        return Reply(None, None, False, words)
    if x is None or z is None:
        return Reply(None, None, False, status[:WORDS])
    x, z = (real_numbers(v).reshape(-1) for v in (x, z))
    if (len(x), len(z)) != (n, m):
        words = f"returned {len(x)} and {len(z)} real numbers in place of {n} and {m}"
        return Reply(None, None, False, words)
    return Reply(x, z, status == OPTIMAL, status[:WORDS])


def real_numbers(values: object) -> Array:
    """A function's result as float64 numbers; an array of shape (0, 0) if it is not numeric.

    Parameters
    ----------
    values : object
        Complex numbers, words and truth values are none.
    """
    try:
        array = np.array(values)
    except ValueError:  # lists of different lengths
        array = np.array(None)
    return array.astype(np.float64) if array.dtype.kind in "fiu" else np.zeros((0, 0))


@contextmanager
def apart() -> Iterator[None]:
    """A context for a user's code: prints go to standard error, and exits become errors.

    Raises
    ------
    RuntimeError
        In place of what is no :class:`Exception`, such as `SystemExit`; Ctrl-C stays itself.
    """
    sys.stdout.flush()
    kept = None
    with suppress(OSError):  # closed: nothing is answered there
        kept = os.dup(1)
        os.dup2(2, 1)
    try:
        with redirect_stdout(sys.stderr):
            yield
    except (Exception, KeyboardInterrupt):
        raise
    except BaseException as error:
        raise RuntimeError(f"{type(error).__name__}: {error}") from None
    finally:
        if kept is not None:
            os.dup2(kept, 1)
            os.close(kept)


def called(function: Function) -> str:
    """A name of a function for messages."""
    name = getattr(function, "__qualname__", type(function).__name__)
    return f"{getattr(function, '__module__', 'function')}:{name}"


def function_at(target: str) -> Function:
    """The function of ``FILE.py:FUNCTION`` or ``MODULE:FUNCTION``.

    Parameters
    ----------
    target : str
        Files and modules are looked for in the working folder, too.

    Raises
    ------
    InputError
        If there is none, or its module cannot be imported.
    """
    place, _, name = target.rpartition(":")
    try:
        if place.endswith(".py"):
            path = Path(place).resolve()
            spec = importlib.util.spec_from_file_location(path.stem, path)
            assert spec is not None
            assert spec.loader is not None
            module = importlib.util.module_from_spec(spec)
            _look_in(path.parent)  # for what it imports itself
            with apart():
                spec.loader.exec_module(module)
        else:
            _look_in(Path.cwd())
            with apart():
                module = importlib.import_module(place)
        function: Function = getattr(module, name)
    except Exception as error:  # a module may raise anything when it is imported
        words = f"cannot be imported: {type(error).__name__}: {error}"
        raise InputError(words[:WORDS], field="backend", value=target) from None
    if not callable(function):
        raise InputError("must be a function", field="backend", value=target)
    return function


def _look_in(folder: Path) -> None:
    """Let Python import modules from a folder, after all other places."""
    if str(folder) not in sys.path:
        sys.path.append(str(folder))

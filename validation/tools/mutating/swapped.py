"""A mutant put into the running package: the code of its functions changes, nothing is imported."""

from __future__ import annotations

import gc
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from types import CodeType, FunctionType

from validation.tools.mutating.mutants import Mutant

IN_FUNCTION = 1
"""``CO_OPTIMIZED`` of a code object: it is a function's, not a module's or the body of a class."""


def changed_functions(path: str, source: str, mutant: Mutant) -> frozenset[str] | None:
    """Names of the functions, none inside another, that a mutant changes.

    `source` is the file's text as :func:`ast.unparse` writes it, as the mutant's is. None if the
    mutant changes more: a constant of the module, say, or the default of an argument, of which
    other modules have copies. What a generator outside of functions makes is a constant, too.
    """
    names = set()
    for old, new in _pairs(path, source, mutant.source):
        if not old.co_flags & IN_FUNCTION:
            if _own(old) != _own(new):
                return None
        elif old.co_freevars != new.co_freevars:
            return None
        elif old != new:
            name = function_name(old)
            if name.endswith(("<genexpr>", "comp>")):
                return None
            names.add(name)
    return frozenset(names)


def function_name(code: CodeType) -> str:
    """The function that some code belongs to: the outermost one."""
    return code.co_qualname.partition(".<locals>")[0]


def living_functions(root: str) -> dict[str, list[FunctionType]]:
    """Every function in this process that a file below `root` has made, by the file's path."""
    found: defaultdict[str, list[FunctionType]] = defaultdict(list)
    for function in gc.get_objects():
        if isinstance(function, FunctionType) and function.__code__.co_filename.startswith(root):
            found[function.__code__.co_filename].append(function)
    return found


def swap(functions: Iterable[FunctionType], path: str, old: str, new: str) -> None:
    """Give functions of the file `path`, whose text is `old`, the code that they have in `new`."""
    new_code = {_place(before): after for before, after in _pairs(path, old, new)}
    for function in functions:
        function.__code__ = new_code[_place(function.__code__)]


def forget_results() -> None:
    """Empty every cache of the package: what the code computed before it changed."""
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] == "quasistatic_ref":
            for value in list(vars(module).values()):
                if hasattr(value, "cache_clear"):
                    value.cache_clear()


def _place(code: CodeType) -> tuple[str, int, bytes]:
    """The name and the place in the text: two lambdas may stand in one line, in other columns."""
    return code.co_qualname, code.co_firstlineno, code.co_linetable


def _pairs(path: str, old: str, new: str) -> Iterator[tuple[CodeType, CodeType]]:
    """Every code object of a file with that of another version of it, in the order of the text."""
    left = [compile(old, path, "exec", dont_inherit=True)]
    right = [compile(new, path, "exec", dont_inherit=True)]
    while left:
        first, second = left.pop(), right.pop()
        yield first, second
        left.extend(_inner(first))
        right.extend(_inner(second))


def _inner(code: CodeType) -> list[CodeType]:
    return [part for part in code.co_consts if isinstance(part, CodeType)]


def _own(code: CodeType) -> tuple[bytes, tuple[object, ...], tuple[str, ...]]:
    """A module's own instructions, without the functions in it."""
    constants = (part for part in code.co_consts if not isinstance(part, CodeType))
    return code.co_code, tuple(constants), code.co_names

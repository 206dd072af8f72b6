"""Every function of the core that a comment of the C files names exists under that name."""

import ast
import re
from pathlib import Path

import quasistatic_ref

PACKAGE = Path(quasistatic_ref.__file__).parent
NAMED = re.compile(r"(\w+(?:/\w+)+), `([\w.]+)`(?: and `([\w.]+)`)?")


def functions(module):
    """Names that a module defines, those of methods behind their class."""
    names = set()
    for node in ast.parse((PACKAGE / f"{module}.py").read_text("utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        if isinstance(node, ast.ClassDef):
            own = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
            names |= own | {f"{node.name}.{name}" for name in own}
    return names


def test_functions_of_the_core_that_c_repeats_are_there():
    text = "".join(
        path.read_text("utf-8") for path in (PACKAGE / "optional/fast/source").glob("*.c")
    )
    named = [(module, name) for module, *names in NAMED.findall(text) for name in names if name]
    assert len(named) > 25
    assert [one for one in named if one[1] not in functions(one[0])] == []


def test_every_function_that_python_calls_names_what_it_repeats():
    source = PACKAGE / "optional/fast/source"
    declared = set(re.findall(r"(\w+)\((?!void)", (source / "fast.h").read_text("utf-8")))
    for path in source.glob("*.c"):
        for before, name in re.findall(r"/\* ([^*]*?) \*/\n\w+ (\w+)\(", path.read_text("utf-8")):
            if name in declared:
                assert NAMED.search(before), name
                declared.remove(name)
    assert declared == set()

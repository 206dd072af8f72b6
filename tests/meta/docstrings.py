"""What the docstring of a public name must say, as a function of the source.

Types, and whether an argument is optional, are in the signature and are not required again, and
ruff asks for an entry of each argument. What neither does is required: of an array its shape, of a
number its unit, and which errors are raised.
"""

import ast
import re

ARRAYS = re.compile(r"\b(Array|NDArray|ndarray)\b")
COUNTS = re.compile(r"np\.(int64|bool)|\bof (int|bool)\b")
"""Numbers that count or choose have no unit to state."""
NUMBERS = re.compile(r"\bfloat\b")
SHAPE = re.compile(r"\bshapes?\b|\bscalar\b|\(((\d|\.{3}|[A-Za-z]\w{0,6}), ?)+(\d|\w{1,7})?\)")
UNIT = re.compile(r"\[[^\]\n]*\]")
PARAMETERS = re.compile(r"^Parameters\n-+\n.*?(?=^\w+\n-+$|\Z)", re.MULTILINE | re.DOTALL)
"""That section, up to the next one."""


def units_of_symbols(notation):
    """The symbols whose units are defined in the notation page: rows of its tables."""
    rows = [line.split("|")[1] for line in notation.splitlines() if line.startswith("| `")]
    return {name for row in rows for name in re.findall(r"`(\w+)`", row)}


def complaints(path, source, symbols):
    """One sentence for each thing that the docstrings of a file do not say."""
    for node in public(ast.parse(source).body):
        said = ast.get_docstring(node)
        where = f"{path}:{node.lineno} {node.name}"
        if said is None:
            yield f"{where} has no docstring"
            continue
        for name, annotation in values(node):
            yield from of_value(where, name, annotation, said, symbols)
        if isinstance(node, ast.FunctionDef):
            yield from of_result(where, node, said, symbols)


def public(body):
    """Every public class and function in a module, methods included."""
    for node in body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_"):
            yield node
            yield from public(node.body if isinstance(node, ast.ClassDef) else [])


def values(node):
    """(name, annotation) of the arguments of a function, or of the fields of a class."""
    if isinstance(node, ast.ClassDef):
        fields = [n for n in node.body if isinstance(n, ast.AnnAssign) and n.simple]
        found = [(field.target.id, field.annotation) for field in fields]
        inits = [n for n in node.body if isinstance(n, ast.FunctionDef) and n.name == "__init__"]
        found += [pair for init in inits for pair in values(init)]
    else:
        every = [a for a in ast.walk(node.args) if isinstance(a, ast.arg)]
        found = [(a.arg, a.annotation) for a in every if a.annotation]
    return [(name, annotation) for name, annotation in found if not name.startswith("_")]


def of_value(where, name, annotation, said, symbols):
    """An array states its shape and a number its unit, unless the notation does for its name.

    It says so in its entry under Parameters or, where there is none, in the prose that names it.
    """
    kind = ast.unparse(annotation)
    array = ARRAYS.search(kind)
    number = NUMBERS.search(kind)
    if not (array or number) or "Callable" in kind or name in symbols:
        return
    entry = re.search(rf"^\*?(?:\w+, )*{name}\b.* : .*(?:\n(?: .*)?)*", said, re.MULTILINE)
    text = entry[0] if entry else said
    if not re.search(rf"\b{name}\b", text):
        yield f"{where}: {name} is not documented"
    elif array and not SHAPE.search(text):
        yield f"{where}: {name} without its shape"
    elif not (UNIT.search(text) or COUNTS.search(kind) or COUNTS.search(text)):
        yield f"{where}: {name} without its unit, and not in the notation"


def of_result(where, node, said, symbols):
    """What is returned, and which classes of errors are raised by name in the function itself."""
    returned = ast.unparse(node.returns) if node.returns else ""
    result = PARAMETERS.sub("", said)
    if ARRAYS.search(returned) and not SHAPE.search(result):
        yield f"{where}: no shape of what is returned, {returned}"
    if returned == "float" and node.name not in symbols and not UNIT.search(result):
        yield f"{where}: no unit of the number returned"
    raised = [n.exc for n in ast.walk(node) if isinstance(n, ast.Raise) and n.exc is not None]
    named = {ast.unparse(e.func if isinstance(e, ast.Call) else e) for e in raised}
    for error in sorted(named - set(re.findall(r"\w+", said))):
        if re.fullmatch(r"[A-Z]\w+", error):
            yield f"{where}: does not say when it raises {error}"

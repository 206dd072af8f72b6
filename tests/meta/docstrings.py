"""What the docstring of a public name must say, as a function of the source.

Types, and whether an argument is optional, are in the signature and are not required again. What
a signature cannot say is required: of an array its shape, of a number its unit, and which errors
are raised.
"""

import ast
import re

ARRAYS = re.compile(r"\b(Array|NDArray|ndarray)\b")
"""In annotations; numbers that count or choose (of int, of bool) have no unit to state."""
NUMBERS = re.compile(r"\bfloat\b")
SHAPE = re.compile(r"\bshapes?\b|\bscalar\b|\(((\d|\.{3}|[A-Za-z]\w{0,6}), ?)+(\d|\w{1,7})?\)")
UNIT = re.compile(r"\[[^\]\n]*\]")


def sections(docstring):
    """The text of a NumPy docstring by section; the text before the first one is ''."""
    found, name = {"": []}, ""
    lines = docstring.splitlines()
    for i, line in enumerate(lines):
        below = lines[i + 1] if i + 1 < len(lines) else ""
        if line and re.fullmatch(r"-{3,}", below) and len(below) == len(line):
            name = line
            found[name] = []
        elif not re.fullmatch(r"-{3,}", line):
            found[name].append(line)
    return {key: "\n".join(text) for key, text in found.items()}


def entries(section):
    """The entries of a Parameters section: {name: its heading and its text}."""
    found, names = {}, []
    for line in section.splitlines():
        if line and not line.startswith(" "):
            names = [part.strip(" *") for part in line.partition(" : ")[0].split(",")]
            found |= dict.fromkeys(names, line)
        else:
            for name in names:
                found[name] += "\n" + line
    return found


def units_of_symbols(notation):
    """The symbols whose units are defined in the notation page: rows of its tables."""
    symbols = set()
    for line in notation.splitlines():
        if line.startswith("| `"):
            symbols |= set(re.findall(r"`(\w+)`", line.split("|")[1]))
    return symbols


def complaints(path, source, symbols):
    """One sentence for each thing that the docstrings of a file do not say."""
    tree = ast.parse(source)
    for owner, node in public(tree.body):
        said = ast.get_docstring(node)
        where = f"{path}:{node.lineno} {owner}{node.name}"
        if said is None:
            yield f"{where} has no docstring"
        elif isinstance(node, ast.ClassDef):
            yield from of_class(where, node, said, symbols)
        else:
            yield from of_function(where, node, said, symbols)


def public(body, owner=""):
    """(prefix, node) of every public class and function in a module, methods included."""
    for node in body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_"):
            yield owner, node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body, f"{owner}{node.name}.")


def of_class(where, node, said, symbols):
    """Fields that are arrays or numbers are documented, with shapes and units."""
    parts = sections(said)
    listed = entries(parts.get("Parameters", "")) | entries(parts.get("Attributes", ""))
    fields = [n for n in node.body if isinstance(n, ast.AnnAssign) and n.simple]
    for field in fields:
        if not field.target.id.startswith("_"):
            yield from of_value(
                where, field.target.id, ast.unparse(field.annotation), listed, parts[""], symbols
            )
    constructors = [n for n in node.body if isinstance(n, ast.FunctionDef) and n.name == "__init__"]
    for constructor in constructors:
        for name, annotation in arguments(constructor):
            yield from of_value(where, name, annotation, listed, parts[""], symbols)


def of_function(where, node, said, symbols):
    """Arguments, the result and what is raised."""
    parts = sections(said)
    listed = entries(parts.get("Parameters", ""))
    named = arguments(node)
    if listed and (missing := [name for name, _ in named if name not in listed]):
        yield f"{where}: Parameters lacks {', '.join(missing)}"
    if gone := [name for name in listed if name not in dict(named)]:
        yield f"{where}: {', '.join(gone)} is no argument"
    for name, annotation in named:
        yield from of_value(where, name, annotation, listed, parts[""], symbols)
    returned = ast.unparse(node.returns) if node.returns else "None"
    result = "\n".join([parts[""], parts.get("Returns", ""), parts.get("Yields", "")])
    if ARRAYS.search(returned) and not SHAPE.search(result):
        yield f"{where}: no shape of what is returned, {returned}"
    if returned == "float" and node.name not in symbols and not UNIT.search(result):
        yield f"{where}: no unit of the number returned"
    for error in sorted(raised(node) - set(re.findall(r"\w+", said))):
        yield f"{where}: does not say when it raises {error}"


def of_value(where, name, annotation, listed, prose, symbols):
    """An array states its shape and a number its unit, unless the notation does for its name.

    It says so in its entry under Parameters or, where there is none, in the prose that names it.
    """
    array, number = ARRAYS.search(annotation), NUMBERS.search(annotation)
    counts = re.search(r"np\.(int64|bool)", annotation)
    if not (array or number) or "Callable" in annotation or name in symbols:
        return
    text = listed.get(name, prose if re.search(rf"\b{name}\b", prose) else None)
    if text is None:
        yield f"{where}: {name} is not documented"
        return
    if array and not SHAPE.search(text):
        yield f"{where}: {name} without its shape"
    if not UNIT.search(text) and not (counts or re.search(r"\bof (int|bool)\b", text)):
        yield f"{where}: {name} without its unit, and not in the notation"


def arguments(node):
    """(name, annotation) of every argument but self and cls."""
    every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    every += [a for a in (node.args.vararg, node.args.kwarg) if a is not None]
    return [
        (a.arg, ast.unparse(a.annotation) if a.annotation else "")
        for a in every
        if a.arg not in ("self", "cls") and not a.arg.startswith("_")
    ]


def raised(node):
    """The classes of errors raised by name in a function itself."""
    calls = [n.exc for n in ast.walk(node) if isinstance(n, ast.Raise) and n.exc is not None]
    named = [ast.unparse(c.func if isinstance(c, ast.Call) else c) for c in calls]
    return {name for name in named if re.fullmatch(r"[A-Z]\w+", name)}

"""Bugs of one place in the plain program, made from its syntax: what a port may have mistyped.

A sum becomes a difference or loses a term, a product loses a factor or becomes a quotient, a matrix
is transposed or is not, the arguments of a product that does not commute change places, a name
gives way to its like (alpha and beta, R and Rp), an index or a constant to its neighbour. Of three
numbers that a line assigns or returns, one has the other sign, is 0, or is another one of them.
"""

import ast
from collections.abc import Iterator
from typing import NamedTuple

LIKE = {
    "alpha": "beta",
    "alpha_body": "beta_body",
    "mu_v": "mu_omega",
    "d1": "d2",
    "d2": "n",
    "force": "torque",
}
"""Fields that are taken for each other."""
CALLS = {"argmin": "argmax", "minimum": "maximum"}
"""Functions of NumPy that are taken for each other."""
DROPPED = ("abs", "unit", "sorted")
"""Functions whose argument may be taken as it is."""
ORDERED = ("cross", "quaternion_product", "outer")
"""Functions of two arguments, whose order matters or may be thought to."""
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
}
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.Gt, ast.LtE),
    ast.Gt: (ast.Lt, ast.GtE),
    ast.LtE: (ast.GtE, ast.Lt),
    ast.GtE: (ast.LtE, ast.Gt),
}


ENTRIES = tuple(
    f" * [{', '.join(str(factor if i == j else 1) for j in range(3))}]"
    for factor in (-1, 0)
    for i in range(3)
) + tuple(
    f"[..., [{', '.join(str(i if k == j else k) for k in range(3))}]]"
    for j in range(3)
    for i in range(3)
    if i != j
)
"""What is done to an array of three numbers by which one of them is wrong."""


class Bug(NamedTuple):
    """A change of one line.

    Parameters
    ----------
    file : str
    function : str
        In which the line stands.
    old, new : str
        The line.
    text : str
        The whole file with it.
    """

    file: str
    function: str
    old: str
    new: str
    text: str


def bugs_of(file: str, text: str, lines: frozenset[int]) -> Iterator[Bug]:
    """Every bug of a file in the lines of these numbers, from 1.

    Parameters
    ----------
    file : str
    text : str
        Its content.
    lines : set of int
    """
    rows = text.splitlines()
    for function in ast.parse(text).body:
        if not isinstance(function, ast.FunctionDef):
            continue
        names = sorted({n.id for n in ast.walk(function) if isinstance(n, ast.Name)})
        in_slices = {
            part for n in ast.walk(function) if isinstance(n, ast.Slice) for part in ast.walk(n)
        }
        values = {n.value for n in ast.walk(function) if isinstance(n, ast.Assign | ast.Return)}
        for node in ast.walk(function):
            if node in in_slices:
                continue
            number = getattr(node, "lineno", 0)
            if number not in lines or not isinstance(node, ast.expr) or node.end_lineno != number:
                continue
            row = rows[number - 1]
            texts = [
                expression_text(other, row, node) for other in changed_expressions(node, names)
            ]
            if node in values:
                own = row[node.col_offset : node.end_col_offset]
                texts += [f"np.array({own}){done}" for done in ENTRIES]
            for text_of_node in texts:
                new = f"{row[: node.col_offset]}{text_of_node}{row[node.end_col_offset :]}"
                whole = "\n".join([*rows[: number - 1], new, *rows[number:]]) + "\n"
                yield Bug(file, function.name, row.strip(), new.strip(), whole)


def expression_text(other: ast.expr, row: str, node: ast.expr) -> str:
    """An expression in the place of another in a row, in brackets where it needs them."""
    text = ast.unparse(other)
    after = row[node.end_col_offset :]
    alone = row[: node.col_offset].endswith(("= ", "return ", "(", ", ", "["))
    alone = alone and (not after or after.startswith((")", ",", "]")))
    return f"({text})" if isinstance(other, ast.BinOp | ast.UnaryOp) and not alone else text


def changed_expressions(node: ast.expr, names: list[str]) -> Iterator[ast.expr]:
    """What may stand in the place of an expression.

    Parameters
    ----------
    node : ast.expr
    names : list of str
        Names that occur in its function.
    """
    match node:
        case ast.BinOp(left, operator, right):
            if type(operator) in OPERATORS:
                yield ast.BinOp(left, OPERATORS[type(operator)](), right)
            if isinstance(operator, ast.Add | ast.Sub | ast.Mult | ast.Div):
                yield left
            if isinstance(operator, ast.Add | ast.Mult):
                yield right
            if isinstance(operator, ast.Sub):
                yield ast.UnaryOp(ast.USub(), right)
            if isinstance(operator, ast.MatMult) and not is_transpose(left):
                yield ast.BinOp(ast.Attribute(left, "T"), operator, right)
            if isinstance(operator, ast.MatMult):
                yield ast.BinOp(right, operator, left)
                yield right
                yield ast.UnaryOp(ast.USub(), node)
        case ast.UnaryOp(ast.USub(), operand):
            yield operand
        case ast.Attribute(value, "T"):
            yield value
        case ast.Compare(left, [sign], others):
            for kind in COMPARISONS.get(type(sign), ()):
                yield ast.Compare(left, [kind()], others)
        case ast.Call(ast.Name(name) | ast.Attribute(_, name), arguments):
            if name in CALLS and isinstance(node.func, ast.Attribute):
                called = ast.Attribute(node.func.value, CALLS[name])
                yield ast.Call(called, arguments, node.keywords)
            if name in DROPPED and len(arguments) == 1:
                yield arguments[0]
            if name in ORDERED and len(arguments) == 2:
                yield ast.Call(node.func, arguments[::-1], [])
        case ast.Subscript(value, ast.Slice(None, ast.Constant(int(k)))):
            yield ast.Subscript(value, ast.Slice(ast.Constant(k), None))
        case ast.Subscript(value, ast.Slice(ast.Constant(int(k)), None)):
            yield ast.Subscript(value, ast.Slice(None, ast.Constant(k)))
        case ast.Subscript(value, ast.Constant(str(key))) if key in LIKE:
            yield ast.Subscript(value, ast.Constant(LIKE[key]))
        case ast.Subscript(value, ast.Constant(str(key))):
            for ours, like_ours in LIKE.items():
                if like_ours == key:
                    yield ast.Subscript(value, ast.Constant(ours))
            if key in ("mass", "multiplier", "offset", "h"):
                yield ast.Constant(1 if key != "offset" else 0)
        case ast.Constant(int(k)) if not isinstance(k, bool):
            yield ast.Constant(k + 1)
            if k > 0:
                yield ast.Constant(k - 1)
        case ast.Name(name, ast.Load()):
            if name.startswith("R"):
                yield ast.Attribute(node, "T")
            for taken in names:
                if taken != name and like(name, taken):
                    yield ast.Name(taken)
        case _:
            return


def is_transpose(node: ast.expr) -> bool:
    """Whether an expression is a transpose."""
    return isinstance(node, ast.Attribute) and node.attr == "T"


def like(name: str, other: str) -> bool:
    """Whether names may be taken for each other: of one letter, or of the other shape."""
    if name.replace("alpha", "beta") == other.replace("alpha", "beta"):
        return True
    first = name.partition("_")[0].rstrip("0123456789p")
    return len(first) <= 2 and first == other.partition("_")[0].rstrip("0123456789p")

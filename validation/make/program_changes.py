"""Changes of the plain program, one place at a time: what another program may have mistyped.

A sum becomes a difference or loses a term, a product loses a factor or becomes a quotient, a
matrix is transposed or is not, factors and arguments change places, a name gives way to its like,
an index or a constant to its neighbour, a comparison to its opposite.
"""

import ast
import hashlib
from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import NamedTuple

from quasistatic_ref.lab.vectors.check.patched import MODULES, text_of_file

LIKE = {
    "alpha": "beta", "alpha_body": "beta_body", "mu_v": "mu_omega", "d1": "d2",
    "force": "torque", "q": "target",
}  # fmt: skip
"""Fields, each of which may stand in the place of the other."""
LIKE |= {b: a for a, b in LIKE.items()}
CALLS = {"argmin": "argmax", "minimum": "maximum", "min": "max", "cos": "sin"}
"""Functions that are taken for each other."""
CALLS |= {b: a for a, b in CALLS.items()}
DROPPED = ("abs", "unit", "sorted", "root", "skew")
"""Functions whose argument may be taken as it is."""
ORDERED = ("cross", "quaternion_product", "arctan2", "angle_of")
"""Functions whose arguments may change places."""
UNIT = {"mass": 1, "multiplier": 1, "h": 1, "offset": 0}
"""Fields that may be left out, and what then stands there."""
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
}  # fmt: skip
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.Gt, ast.LtE), ast.Gt: (ast.Lt, ast.GtE), ast.LtE: (ast.GtE, ast.Lt),
    ast.GtE: (ast.LtE, ast.Gt), ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,),
}  # fmt: skip


class Change(NamedTuple):
    """A change of one place.

    Parameters
    ----------
    file, function : str
    line : int
        Counted from 1.
    old, new : str
        The expression.
    source : str
        The function with it.
    text : str
        The whole file with it.
    """

    file: str
    function: str
    line: int
    old: str
    new: str
    source: str
    text: str


class Swap(ast.NodeTransformer):
    """One node in the place of another."""

    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        """The new node for the old one."""
        return self.new if node is self.old else self.generic_visit(node)


def changes(text_of: Callable[[str], str] = text_of_file) -> Iterator[Change]:
    """All of them, of each line one in turn; which is first follows from the lines."""
    by_line: dict[tuple[str, int], list[Change]] = defaultdict(list)
    for module in MODULES:
        file = f"{module}.py"
        for one in changes_of_file(file, text_of(file)):
            by_line[file, one.line].append(one)
    lines = [sorted(ones, key=_hash) for ones in by_line.values()]
    lines.sort(key=lambda ones: _hash(ones[0]))
    for number in range(max(map(len, lines))):
        yield from (ones[number] for ones in lines if number < len(ones))


def changes_of_file(file: str, text: str) -> Iterator[Change]:
    """Those of the functions of a file."""
    rows = text.splitlines()
    for function in ast.parse(text).body:
        if not isinstance(function, ast.FunctionDef):
            continue
        first, last = function.lineno - 1, function.end_lineno
        own = "\n".join(rows[first:last])
        whole = ast.parse(own)
        names = sorted({one.id for one in ast.walk(whole) if isinstance(one, ast.Name)})
        known = {ast.unparse(whole)}
        for j, node in enumerate(ast.walk(whole)):
            for k, other in enumerate(changed(node, names)):
                tree = ast.parse(own)
                place = list(ast.walk(tree))[j]
                swap = Swap(place, list(changed(place, names))[k])
                new = ast.unparse(ast.fix_missing_locations(swap.visit(tree)))
                if new not in known:
                    known.add(new)
                    line = first + getattr(node, "lineno", 1)
                    texts = ast.unparse(node), ast.unparse(other)
                    file_text = "\n".join([*rows[:first], new, *rows[last:]]) + "\n"
                    yield Change(file, function.name, line, *texts, new, file_text)


def changed(node: ast.AST, names: list[str]) -> Iterator[ast.AST]:
    """What may stand in the place of a node.

    Parameters
    ----------
    node : ast.AST
    names : list of str
        Names that occur in its function.
    """
    match node:
        case ast.BinOp(left, operator, right):
            if type(operator) in OPERATORS:
                yield ast.BinOp(left, OPERATORS[type(operator)](), right)
            if isinstance(operator, ast.MatMult):
                yield ast.BinOp(ast.Attribute(left, "T"), operator, right)
                yield ast.BinOp(right, operator, left)
                yield right
                yield ast.UnaryOp(ast.USub(), ast.BinOp(left, operator, right))
            else:
                yield left
                if isinstance(operator, ast.Add | ast.Mult):
                    yield right
        case ast.UnaryOp(ast.USub(), operand):
            yield operand
        case ast.BoolOp(_, values):
            yield from values
        case ast.IfExp(_, one, other):
            yield one
            yield other
        case ast.Attribute(value, "T"):
            yield value
        case ast.Compare(left, [sign], others):
            for kind in COMPARISONS.get(type(sign), ()):
                yield ast.Compare(left, [kind()], others)
        case ast.Call(ast.Name(name) | ast.Attribute(_, name), arguments):
            if name in CALLS:
                called: ast.expr = ast.Name(CALLS[name])
                if isinstance(node.func, ast.Attribute):
                    called = ast.Attribute(node.func.value, CALLS[name])
                yield ast.Call(called, arguments, node.keywords)
            if name in DROPPED and len(arguments) == 1:
                yield arguments[0]
            if name in ORDERED:
                yield ast.Call(node.func, arguments[::-1], [])
        case ast.Subscript(value, ast.Constant(str(key))):
            if key in LIKE:
                yield ast.Subscript(value, ast.Constant(LIKE[key]))
            if key in UNIT:
                yield ast.Constant(UNIT[key])
        case ast.Subscript(value, ast.Constant(int(k))):
            yield ast.Subscript(value, ast.Constant(k + 1 if k < 2 else 0))
        case ast.Constant(bool()):
            return
        case ast.Constant(int(k)):
            yield ast.Constant(k + 1)
            if k > 0:
                yield ast.Constant(k - 1)
        case ast.Constant(float(x)):
            yield ast.Constant(2 * x)
        case ast.Name(name, ast.Load()):
            if name.startswith("R"):
                yield ast.Attribute(node, "T")
            yield from (ast.Name(other) for other in names if is_like(name, other))
        case ast.AugAssign(target, operator, value) if type(operator) in OPERATORS:
            yield ast.AugAssign(target, OPERATORS[type(operator)](), value)


def is_like(name: str, other: str) -> bool:
    """Whether another name may be taken for one: of one letter, or of the other shape."""
    if name.replace("alpha", "beta") == other.replace("alpha", "beta"):
        return name != other
    first, second = (one.partition("_")[0].rstrip("0123456789p") for one in (name, other))
    return len(first) <= 2 and first == second


def _hash(one: Change) -> str:
    return hashlib.sha256(f"{one.file} {one.function} {one.old} > {one.new}".encode()).hexdigest()

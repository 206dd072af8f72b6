"""Mutants of a source file, generated from its syntax tree: one wrong sign, comparison or index.

Operators: + and -, * and /, << and >>, ** and * change places; a minus or a `not` is dropped; a
comparison is turned round or loses its equality; an index or a bound of a slice is one off; an
axis is another; two indices, or two neighbours in a list, change places. Annotations, other types,
``__all__`` and messages are left alone.
"""

import ast
from collections import Counter
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass

OPERATORS = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
    ast.Pow: ast.Mult,
}
COMPARISONS = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
TYPES = ("tuple", "list", "dict", "set", "type", "Callable", "Mapping", "Sequence")
"""What stands before the brackets of a type."""


@dataclass(frozen=True)
class Mutant:
    """A file with one change.

    Parameters
    ----------
    file : str
        Inside the package.
    key : str
        File, function, what it was and what it is: the same while the function is.
    source : str
        The whole file, comments lost.
    """

    file: str
    key: str
    source: str


def mutants(file: str, source: str) -> Iterator[Mutant]:
    """All mutants of a file, in the order of its text."""
    seen = Counter()
    tree = ast.parse(source)
    for node, where in list(_expressions(tree)):
        before = ast.unparse(node)
        for new in _changed_copies(node):
            if ast.unparse(new) == before:  # two equal indices change places
                continue
            key = f"{file} {where}: {before} -> {ast.unparse(new)}"
            seen[key] += 1
            key += f" ({seen[key]})" if seen[key] > 1 else ""
            text = ast.unparse(_Replaced(node, new).visit(tree)) + "\n"
            _Replaced(new, node).visit(tree)
            yield Mutant(file, key, text)


class _Replaced(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old = old
        self.new = new

    def visit(self, node: ast.AST) -> ast.AST:
        return self.new if node is self.old else self.generic_visit(node)


def _expressions(tree: ast.AST, where: str = "module") -> Iterator[tuple[ast.AST, str]]:
    """Nodes that may be changed, with the function that they are in."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "bases", "type_params"):
            continue
        for node in value if isinstance(value, list) else [value]:
            if not isinstance(node, ast.AST) or isinstance(node, ast.JoinedStr) or _runs_not(node):
                continue
            inside = where
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                inside = node.name if where == "module" else f"{where}.{node.name}"
            if isinstance(node, ast.expr | ast.AugAssign | ast.keyword):
                yield node, inside
            yield from _expressions(node, inside)


def _runs_not(node: ast.AST) -> bool:
    """Whether a part only names: the list ``__all__``, or a type such as ``dict[str, Any]``."""
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__"
    generic = isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name)
    return generic and node.value.id in TYPES


def _changed_copies(node: ast.AST) -> Iterator[ast.AST]:
    """What may stand in the place of a node: copies of it with one change each."""
    if isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in OPERATORS:
        yield _with(node, op=OPERATORS[type(node.op)]())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield node.operand
    elif isinstance(node, ast.Compare):
        for k, op in enumerate(node.ops):
            for other in COMPARISONS[type(op)]:
                yield _with(node, ops=[*node.ops[:k], other(), *node.ops[k + 1 :]])
    elif isinstance(node, ast.Subscript):
        for index in _indices(node.slice):
            yield _with(node, slice=index)
    elif isinstance(node, ast.List) and not any(isinstance(e, ast.JoinedStr) for e in node.elts):
        for k in range(len(node.elts) - 1):
            left, right = node.elts[k : k + 2]
            yield _with(node, elts=[*node.elts[:k], right, left, *node.elts[k + 2 :]])
    elif isinstance(node, ast.keyword) and node.arg == "axis" and _number(node.value):
        yield _with(node, value=ast.Constant(int(node.value.value == 0)))


def _indices(index: ast.expr) -> Iterator[ast.expr]:
    """Neighbours of an index."""
    if _number(index):
        yield ast.Constant(index.value + 1)
    elif isinstance(index, ast.UnaryOp) and isinstance(index.operand, ast.Constant):
        yield ast.Constant(0)
    elif isinstance(index, ast.Slice):
        for bound in ("lower", "upper"):
            if (old := getattr(index, bound)) is not None:
                plus = ast.BinOp(old, ast.Add(), ast.Constant(1))
                yield _with(index, **{bound: plus})
    elif isinstance(index, ast.Tuple):
        for k, part in enumerate(index.elts):
            for new in _indices(part):
                yield _with(index, elts=[*index.elts[:k], new, *index.elts[k + 1 :]])
        if len(index.elts) == 2:
            yield _with(index, elts=index.elts[::-1])


def _number(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) is int


def _with(node: ast.AST, **changes: object) -> ast.AST:
    changed = copy(node)
    for name, value in changes.items():
        setattr(changed, name, value)
    return changed

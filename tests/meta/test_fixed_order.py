"""Between steps numbers are formed by + - * / and square roots in one written order.

Which order BLAS and NumPy's sums take, and what the C library makes of a sine, depend on the
processor (docs/exactness.md, "Whole runs"): the source of the path between steps calls none of them
but in the functions below.
"""

import ast
from pathlib import Path

import quasistatic_ref

PACKAGE = Path(quasistatic_ref.__file__).parent
FOLDERS = ("model", "contact", "step", "simulate")
SUMS = {"dot", "vdot", "inner", "outer", "einsum", "matmul", "tensordot", "linalg", "trace"}
REDUCTIONS = {"sum", "mean", "average", "prod", "cumsum"}
FUNCTIONS = {"sin", "cos", "tan", "arcsin", "arccos", "arctan", "arctan2", "asin", "acos", "atan"}
UNORDERED = SUMS | REDUCTIONS | FUNCTIONS | {"atan2", "hypot", "exp", "log"}
"""Names of what is called; ``@`` is found as an operator."""
EXCEPTIONS = {
    "which candidates are compared: every pair that is alike, in whatever order they are summed": (
        "contact/distance.py:repeated",
    ),
    "files, read and checked before a run": (
        "model/urdf/urdf_file.py",
        "model/urdf/urdf_tree.py",
    ),
    "angles by balls of flint, rounded correctly": ("model/angles.py:angle_of",),
    "sums of whole numbers": ("step/data.py:row_layout",),
    "a check that refuses; no number goes on from it": (
        "simulate/limits.py:Limits.out_of_reach",
        "step/arrays.py:finite",
        "step/contacts.py:Contacts._check_frames",
        "step/pivots.py:_surely_positive",
    ),
    "what the backend is given; the proof forms its own, without rounding": (
        "step/friction.py:slip_norm",
        "step/friction.py:slip_norms",
        "step/problem.py:StepProblem.__init__",
        "step/problem.py:StepProblem.set_parameters",
    ),
    "measured of an answer or of a run; the next step does not read it": (
        "model/mechanism.py:Mechanism.mass",
        "simulate/motions.py:LinkMotion.relative_to",
        "simulate/motions.py:LinkMotion.rotation_since",
        "simulate/wrenches.py:ContactsOverSteps.force",
        "simulate/wrenches.py:pair_forces",
        "simulate/wrenches.py:wrench_on",
        "step/contacts.py:Contacts.motion",
        "step/data.py:StepData.momentum",
        "step/friction.py:wrenches",
    ),
}
"""Reason -> files, or functions of files."""


def unordered_functions(node, owner=""):
    """Names of the functions below a node that use one of UNORDERED or ``@``; "" is the module."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        owner = f"{owner}.{node.name}".lstrip(".")
    called = isinstance(node, ast.Attribute) and node.attr in UNORDERED
    if called or isinstance(getattr(node, "op", None), ast.MatMult):
        yield owner
    for child in ast.iter_child_nodes(node):
        yield from unordered_functions(child, owner)


def test_only_the_exceptions_use_sums_and_sines_of_an_order_that_is_not_written():
    excepted = {place for places in EXCEPTIONS.values() for place in places}
    found = set()
    for folder in FOLDERS:
        for path in (PACKAGE / folder).rglob("*.py"):
            file = path.relative_to(PACKAGE).as_posix()
            for owner in unordered_functions(ast.parse(path.read_text("utf-8"))):
                found.add(file if file in excepted else f"{file}:{owner}")
    assert found == excepted

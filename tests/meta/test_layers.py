"""The core imports no optional part and no lab; third-party packages keep to their folders."""

import ast

import pytest

from quasistatic_ref.model.body import FIXED
from quasistatic_ref.model.joints import BASES, JOINTS
from tests.pages import PACKAGE
from tests.processes import printed_text, python

# What import-linter cannot see: the core's files that may name a folder of modules as a string.
DOORS = {"lab": "cli/main.py", "optional": "parts.py"}

# Kinds answer for themselves: who may ask for the class of a cone, and name a kind of joint.
CONES = {"FrictionCone", "PolyhedralCone", "CurvedCone", "EllipsoidCone"}
OF_CONES = ("step/cones.py", "certify/curved_cone.py", "optional/ellipsoid/cone.py")
OF_JOINTS = {FIXED, *BASES, *JOINTS}
READERS = (
    "model/joints/", "model/body.py", "model/tree", "model/inertia.py",
    "optional/pinocchio_models/", "files/", "cli/", "lab/",
)  # fmt: skip


def test_the_contracts_of_imports_in_pyproject_are_kept():
    call = (
        "from importlinter.cli import lint_imports\n"
        "raise SystemExit(lint_imports(no_cache=True, no_logo=True))"
    )
    python("-c", call)


def named_folders(node, name):
    """The folders that a string names as modules, in a file that may not."""
    if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
        return
    for folder, door in DOORS.items():
        inside = name.startswith(("lab/", f"{folder}/"))
        named = f"quasistatic_ref.{folder}" in node.value or node.value.startswith(f".{folder}")
        reference = ":`" in node.value  # of a docstring
        if named and not inside and not reference and not name.startswith(door):
            yield f"names {folder}"


def kinds(node, name):
    """The kind of a cone or a joint that a node asks for, in a file that may not."""
    function = getattr(node.func, "id", "") if isinstance(node, ast.Call) else ""
    if isinstance(node, ast.Compare) or function in ("isinstance", "issubclass"):
        names = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
        if names & CONES and name not in OF_CONES:
            yield "asks for the kind of a cone"
    if isinstance(node, ast.Constant) and node.value in OF_JOINTS and not name.startswith(READERS):
        yield "asks for the kind of a joint"


def wrong_words(name, source):
    """Sentences, one for each place of a file that names what it may not."""
    for node in ast.walk(ast.parse(source)):
        for wrong in (*named_folders(node, name), *kinds(node, name)):
            yield f"{name}:{node.lineno}: {wrong}"


@pytest.mark.long  # lint
def test_no_file_names_another_part_or_asks_for_a_kind():
    files = sorted(PACKAGE.rglob("*.py"))
    found = [
        wrong
        for path in files
        for wrong in wrong_words(path.relative_to(PACKAGE).as_posix(), path.read_text("utf-8"))
    ]
    assert found == []


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("cli/run.py", "x = 'quasistatic_ref.lab.commands'"),
        ("cli/run.py", "x = 'quasistatic_ref.optional.daqp'"),
        ("solve/a.py", "isinstance(cone, CurvedCone)"),
        ("simulate/a.py", "joint.kind == 'planar'"),
    ],
)
def test_a_planted_word_is_found(name, source):
    assert len([*wrong_words(name, source)]) == 1


@pytest.mark.long  # the contracts say the same of what is imported at once
def test_step_certify_and_solve_work_without_pinocchio_and_coal():
    modules = [
        "quasistatic_ref." + ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
        for folder in ("numbers", "exact", "step", "certify", "solve")
        for path in sorted((PACKAGE / folder).rglob("*.py"))
        if path.name != "__init__.py"
    ]
    assert len(modules) >= 9
    said = printed_text(
        "import sys",
        "for name in ('pinocchio', 'coal', 'hppfcl', 'matplotlib'): sys.modules[name] = None",
        *(f"import {module}" for module in modules),
        "from tests.helpers import sphere_on_floor",
        "from quasistatic_ref import solve_step",
        "print(solve_step(sphere_on_floor(wrench=(0, 0, -3, 0, 0, 0))).status)",
    )
    assert said == "optimal"


def test_the_judge_runs_without_cvxpy():
    said = printed_text(
        "import sys",
        "sys.modules['cvxpy'] = sys.modules['qpsolvers'] = None",
        "import numpy as np",
        "from tests.helpers import planted_step",
        "from quasistatic_ref.certify.residuals import optimality_residuals",
        "from quasistatic_ref.step.standard_form import standard_form",
        "step, delta_q, lam = planted_step(1)",
        "print(optimality_residuals(standard_form(step), delta_q, lam).worst < 1e-9)",
    )
    assert said == "True"

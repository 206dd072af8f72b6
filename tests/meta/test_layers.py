"""The core imports no optional part and no lab; third-party packages keep to their folders."""

import subprocess
import sys
from pathlib import Path

import pytest

import quasistatic_ref
from tests.meta.layers import violations

PACKAGE = Path(quasistatic_ref.__file__).parent


def test_the_walls_hold_and_the_list_of_what_crosses_them_is_true():
    assert violations(PACKAGE) == []


@pytest.mark.parametrize("folder", ["cli", "formats", "scenario"])
def test_a_file_of_tests_has_the_name_of_the_module_that_it_tests(folder):
    modules = {path.stem for path in (PACKAGE / folder).glob("*.py")}
    files = {path.stem for path in (PACKAGE.parent / "tests" / folder).glob("test_*.py")}
    assert {name.removeprefix("test_") for name in files} <= modules


PLANTED = {
    "the lab in the core": (
        "simulate/a.py",
        "def f():\n    from quasistatic_ref.lab.study import run",
        "later folder",
    ),
    "a lazy import": ("step/a.py", "import_module('quasistatic_ref.cli')", "later folder"),
    "the face": ("__init__.py", "from .step import data", "later folder"),
    "an optional part in another": (
        "optional/fast/a.py",
        "from quasistatic_ref.optional.show import words",
        "another part",
    ),
    "an optional part in the core": (
        "simulate/a.py",
        "def f():\n    from quasistatic_ref.optional.show import words",
        "later folder",
    ),
    "an optional part where the core begins": (
        "simulate/a.py",
        "with if_there():\n    from quasistatic_ref.optional.show import words",
        "later folder",
    ),
    "the lab as a string": ("cli/run.py", "x = 'quasistatic_ref.lab.commands'", "names the lab"),
    "an optional part as a string": (
        "cli/run.py",
        "x = 'quasistatic_ref.optional.fast'",
        "names a part",
    ),
    "an optional part for a type checker": (
        "errors.py",
        "if TYPE_CHECKING:\n    from quasistatic_ref.optional.show import words",
        "later folder",
    ),
    "the class of a cone": ("solve/a.py", "isinstance(cone, CurvedCone)", "asks for a kind"),
    "the word of a joint": ("simulate/a.py", "joint.kind == 'planar'", "asks for a kind"),
    "from an unknown folder": ("step/a.py", "import quasistatic_ref.attic", "no folder"),
    "cvxpy in the judge": ("certify/a.py", "import cvxpy as cp", "imports cvxpy"),
}


def package(tmp_path, file, source):
    path = tmp_path / "quasistatic_ref" / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source + "\n")
    return tmp_path / "quasistatic_ref"


@pytest.mark.parametrize(("file", "source", "says"), PLANTED.values(), ids=PLANTED)
def test_the_checker_catches_a_planted_violation(tmp_path, file, source, says):
    found = violations(package(tmp_path, file, source))
    assert len(found) == 1
    assert says in found[0]


def printed_text(*lines):
    """What these lines print in an interpreter of their own, which must end well."""
    command = [sys.executable, "-W", "error", "-c", "\n".join(lines)]
    root = str(PACKAGE.parent)
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=60, cwd=root, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_step_certify_and_solve_work_without_pinocchio_and_coal():
    modules = [
        "quasistatic_ref." + ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
        for room in ("step", "certify", "solve")
        for path in sorted((PACKAGE / room).rglob("*.py"))
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
        "step, delta_q, lam = planted_step(np.random.default_rng(1))",
        "print(optimality_residuals(standard_form(step), delta_q, lam).worst < 1e-9)",
    )
    assert said == "True"


def test_importing_the_package_loads_none_of_its_folders():
    said = printed_text(
        "import sys, quasistatic_ref",
        "loaded = [m for m in sys.modules if m.startswith('quasistatic_ref.')]",
        "print(loaded, 'numpy' in sys.modules, 'cvxpy' in sys.modules)",
    )
    assert said == "[] False False"

"""Solvers that installed packages announce: called by name, and refused in a sentence."""

import sys

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.calling.packages import announced_function, announced_solvers
from quasistatic_ref.lab.study.store.store import contents

PROBLEMS = "repetitions = 2\n[problems]\nset = 'contact-qp'\nfamilies = { gaps = 2 }\n"
"""Small and well conditioned, so that quadprog keeps nearly all digits."""

MODULE = """
import quadprog

def solve(P, q, G, h):
    x, _, _, _, z, _ = quadprog.solve_qp(P, -q, -G.T.copy(), -h)
    return x, z

def damped(P, q, G, h, damping=0.0):
    x, z = solve(P, q, G, h)
    return (1 - damping) * x, z

NUMBER = 3.0
"""


@pytest.fixture
def planted(tmp_path, importable):
    """A function that installs a package: a module, and a folder that describes it."""
    site = tmp_path / "site"
    site.mkdir()
    importable(site)

    def installed(package, entries, module="planted_package", text=MODULE):
        (site / f"{module}.py").write_text(text)
        folder = site / f"{package.replace('-', '_')}-1.2.dist-info"
        folder.mkdir()
        (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.2\n")
        lines = "\n".join(f"{name} = {value}" for name, value in entries.items())
        (folder / "entry_points.txt").write_text(f"[quasistatic_ref.solvers]\n{lines}\n")

    yield installed
    for name in [name for name in sys.modules if name.startswith("planted_package")]:
        del sys.modules[name]


def test_a_solver_of_an_installed_package_is_called_by_its_name(planted, run, tmp_path):
    """Right to 12 digits by ``*``; half of the optimum is wrong by its half: few digits.

    A package that cannot be imported costs itself only.
    """
    broken = {"broken": "planted_package_2:solve"}
    planted("planted-other", broken, "planted_package_2", "raise RuntimeError('no licence')")
    planted("planted-qp", {"mine": "planted_package:solve", "damped": "planted_package:damped"})
    own = '[solvers.half]\npackage = "damped"\noptions.default = { damping = 0.5 }\n'
    digits = {}
    for row in run(PROBLEMS + own + '[[runs]]\nsolvers = ["package:*", "half"]\n'):
        digits.setdefault(row["solver"], []).append(row["digits"]["delta_q"])
    assert set(digits) == {"mine", "damped", "half"}
    assert min(digits["mine"] + digits["damped"]) > 12
    assert max(digits["half"]) < 3
    found = contents(tmp_path / "store")
    assert found.study["versions"]["planted-qp"] == "1.2"
    assert "cannot be imported: RuntimeError: no licence" in found.unreached["package:broken"]


def test_names_that_are_not_clear_or_not_there_are_refused(planted, study):
    planted("planted-one", {"mine": "planted_package:solve"})
    planted("planted-two", {"mine": "planted_package:damped"})
    planted("planted-three", {"other": "planted_package:solve"})
    runs = '[[runs]]\nsolvers = ["package:NAME"]\n'
    with pytest.raises(InputError, match=r"by several packages, planted-.* and planted-.*; keep"):
        study(PROBLEMS + runs.replace("NAME", "mine"))
    with pytest.raises(InputError, match=r"announced by no package.* did you mean 'other'"):
        study(PROBLEMS + runs.replace("NAME", "othre"))
    with pytest.raises(InputError, match=r"solvers\.x\.package: is announced by no package"):
        study(PROBLEMS + '[solvers.x]\npackage = "nobody"\n[[runs]]\nsolvers = ["x"]\n')
    assert list(announced_solvers()) == ["mine", "other"]


@pytest.mark.parametrize(("value", "words"), [
    ("planted_package_3:solve", "cannot be imported: ModuleNotFoundError"),
    ("planted_package:nobody", "cannot be imported: AttributeError"),
    ("planted_package:NUMBER", "is not a function"),
])  # fmt: skip
def test_a_package_that_cannot_be_imported_is_said_with_its_reason(planted, value, words):
    planted("planted-other", {}, "planted_package_2", "raise RuntimeError('no licence')")
    planted("planted-qp", {"mine": value})
    with pytest.raises(InputError, match=words) as caught:
        announced_function("mine")
    assert f"{value} of planted-qp" in str(caught.value)
    assert "\n" not in str(caught.value)

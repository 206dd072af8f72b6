"""A wrong sign, operator or index in the paper's page or its judge makes a test fail."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import quasistatic_ref

ROOT = Path(__file__).parents[2]
PACKAGE = Path(quasistatic_ref.__file__).parent
FRICTION, FORM, JUDGE = "step/friction.py", "step/standard_form.py", "certify/optimality.py"
FAST = ("friction", "standard_form", "optimality")

MUTATIONS = {
    "n~ points the other way": (
        FRICTION,
        "[n, np.zeros((len(n), 1))]",
        "[-n, np.zeros((len(n), 1))]",
    ),
    "d~_2 uses d1": (FRICTION, "mu_v[:, None] * d2", "mu_v[:, None] * d1"),
    "d~_3 is not turned round": (FRICTION, "-d_tilde_1, -d_tilde_2]", "d_tilde_1, -d_tilde_2]"),
    "d~_3 and d~_4 change places": (FRICTION, "-d_tilde_1, -d_tilde_2]", "-d_tilde_2, -d_tilde_1]"),
    "d~_6 is d~_5": (FRICTION, "[d_tilde_5, -d_tilde_5]", "[d_tilde_5, d_tilde_5]"),
    "rows subtract d~": (FRICTION, "[:, None, :] + cone_dir", "[:, None, :] - cone_dir"),
    "the torque takes the wrong column": (FRICTION, "f_d1, f_d2, tau_n =", "f_d1, tau_n, f_d2 ="),
    "the wrench is an impulse": (FRICTION, "axis=1) / h", "axis=1)"),
    "h on the wrong side of M_u": (FORM, "step.M_u / h", "step.M_u * h"),
    "K_q without h": (FORM, "= h * step.K_q", "= step.K_q"),
    "tau_a against tau_k": (FORM, "tau_k + step.tau_a", "tau_k - step.tau_a"),
    "b is plus phi": (FORM, "b = -row_gaps", "b = row_gaps"),
    "(9) with the contact sign as printed": (JUDGE, "- A.T @ lam", "+ A.T @ lam"),
    "(9) with tau_a as printed": (JUDGE, "- h * step.tau_a", "+ step.tau_a"),
    "(10) the other way": (JUDGE, "np.maximum(-slack", "np.maximum(slack"),
    "(11) the other way": (JUDGE, "np.maximum(-lam", "np.maximum(lam"),
    "(12) added, not multiplied": (JUDGE, "slack * lam", "slack + lam"),
}


def chosen_tests():
    equations = [
        path
        for path in (ROOT / "tests" / "equations").glob("test_eq*.py")
        if "quasistatic_ref.contact" not in path.read_text()
    ]
    units = [ROOT / "tests" / "unit" / f"test_{name}.py" for name in FAST]
    return [str(path.relative_to(ROOT)) for path in sorted(equations + units)]


def outcome(folder, mutation=None):
    """The exit status of the chosen tests on a copy of the package, mutated or not."""
    folder.mkdir()
    without = shutil.ignore_patterns("__pycache__", ".hypothesis")
    shutil.copytree(PACKAGE, folder / "quasistatic_ref", ignore=without)
    shutil.copytree(ROOT / "tests", folder / "tests", ignore=without)
    shutil.copy(ROOT / "pyproject.toml", folder)
    if mutation is not None:
        file, old, new = mutation
        path = folder / "quasistatic_ref" / file
        source = path.read_text()
        assert source.count(old) == 1, f"{file} no longer holds {old!r} once: renew this mutation"
        path.write_text(source.replace(old, new))
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
    environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    environment["OMP_NUM_THREADS"] = environment["OPENBLAS_NUM_THREADS"] = "1"
    done = subprocess.run(
        [*command, *chosen_tests()],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """All outcomes, two at a time; None is the package as it is."""
    base = tmp_path_factory.mktemp("mutations")
    jobs = {None: None, **MUTATIONS}
    with ThreadPoolExecutor(2) as pool:
        running = {
            name: pool.submit(outcome, base / str(k), mutation)
            for k, (name, mutation) in enumerate(jobs.items())
        }
        return {name: job.result() for name, job in running.items()}


def test_the_package_as_it_is_passes(outcomes):
    status, said = outcomes[None]
    assert status == pytest.ExitCode.OK, said


@pytest.mark.parametrize("name", MUTATIONS)
def test_the_mutant_is_caught(outcomes, name):
    status, said = outcomes[name]
    assert status == pytest.ExitCode.TESTS_FAILED, said

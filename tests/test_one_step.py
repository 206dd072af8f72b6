"""The file for students: its program is the standard form, and its answers are the exact ones."""

import ast
import runpy

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quasistatic_ref as qr
from quasistatic_ref.certify.norm import correct_digits
from tests.made import GRAVITY, pinch_step, sphere_step
from tests.pages import EXAMPLES

FILE = EXAMPLES / "one_step.py"
PAGE = runpy.run_path(str(FILE))


def arrays(step):
    """The arguments of its `program`, from a step."""
    c = step.contacts
    contacts = list(zip(c.phi, c.n, c.d1, c.d2, c.J, c.mu_v, c.mu_omega * c.torsion, strict=True))
    return step.h, step.K_q, step.M_u, step.delta_q_bar_a, step.tau_a, step.tau_u, contacts


def grasp_step():
    return qr.load_scenario("bunny_grasp", steps=101, fast=True).run(progress=False).step_data(100)


STEPS = {
    "grasp": grasp_step,
    "pinch that slips": lambda: pinch_step(5.0, 0.3, 0.5, 0.02),
    "pinch that holds": lambda: pinch_step(5.0, 0.02, 0.5, 0.02),
}


@pytest.mark.filterwarnings("ignore:Solution may be inaccurate")
@pytest.mark.parametrize("name", STEPS)
def test_the_program_and_answer_of_the_example_are_those_of_the_package(name):
    step = STEPS[name]()
    form = qr.standard_form(step)
    H, g, A, b = PAGE["program"](*arrays(step))
    counts = np.ravel([[True] * 4 + [torsion] * 2 for torsion in step.contacts.torsion])
    for ours, theirs in zip(form, (H, g, A[counts], b[counts]), strict=True):
        np.testing.assert_allclose(theirs, ours, rtol=1e-14, atol=1e-14)
    delta_q, lam = PAGE["step"](*arrays(step))
    exact = qr.solve_step(step)
    assert correct_digits(step, delta_q, exact.delta_q) > 5
    impulse = form.A.T @ exact.lam
    np.testing.assert_allclose(A.T @ lam, impulse, atol=1e-6 * np.abs(impulse).max())


@pytest.mark.parametrize("torque", [0.02, 0.04])
def test_the_sphere_of_the_example_is_that_of_the_package(torque):
    wrench = (0, 0, -0.3 * GRAVITY, 0, 0, torque)
    inertia = 0.4 * 0.3 * 0.05**2
    step = sphere_step(0.3, inertia, 0.05, wrench, mu_v=1.0, mu_omega=0.01, phi=0.0, h=0.01)
    delta_q, _ = PAGE["sphere"](torque)
    assert np.abs(delta_q - qr.solve_step(step).delta_q).max() < 1e-9


def test_the_jacobian_of_the_example_is_a_central_difference():
    r, n = np.array([0.1, -0.2, 0.3]), np.array([0.6, 0.0, 0.8])
    J = PAGE["jacobian"](r, n)
    for i in range(3):
        turn = 1e-6 * np.eye(3)[i]
        ahead, behind = (Rotation.from_rotvec(sign * turn).apply(r) for sign in (1, -1))
        np.testing.assert_allclose(J[:, i], [*np.eye(3)[i], 0])
        np.testing.assert_allclose(J[:3, 3 + i], (ahead - behind) / 2e-6, atol=1e-9)
        assert J[3, 3 + i] == n[i]


def test_the_example_needs_numpy_and_cvxpy_alone_and_prints_lecture_1(capsys):
    tree = ast.parse(FILE.read_text("utf-8"))
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
    assert {alias.name for node in imports for alias in node.names} == {"cvxpy", "numpy"}
    runpy.run_path(str(FILE), run_name="__main__")
    printed = capsys.readouterr()
    assert "[87.6  0.  43.8  0. ] um" in printed.out
    assert "normal force 10.248 N" in printed.out
    assert printed.err == ""

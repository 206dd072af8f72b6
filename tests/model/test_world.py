"""A world of many bodies in parts, and the limits of its joints."""

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.model import tree_model
from tests.cases import cases
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import joint, link, robot
from tests.processes import printed_text
from tests.tolerances import ROUNDING

GRAVITY = np.array([1.0, -2.0, -9.81])


def balls(count):
    """Free balls, each of another mass, place and orientation."""
    return System([
        Body.of_shape(f"ball{k}", Sphere(0.1), 1.0 + k, xyz=(k, 2 * k, -k), rpy=(0.1 * k, 0.2, 0.3))
        for k in range(count)
    ])  # fmt: skip


def test_bodies_of_all_parts_move_and_weigh_as_each_alone():
    """Of a ball about its centre: J = [R 0; 0 R], and its weight is m R' g."""
    system = balls(9)
    assert len(system.workspace().parts) == 3
    kinematics = system.kinematics(system.q_start)
    J = np.zeros((10, 6, 54))
    weight = np.zeros(54)
    for k in range(9):
        number = system.link(f"ball{k}")
        v = system.joint(f"ball{k}/base").v
        R = Rotation.from_euler("xyz", [0.1 * k, 0.2, 0.3]).as_matrix()
        assert_within(kinematics.R[number], R)
        assert_within(kinematics.t[number], [k, 2 * k, -k])
        J[number, :, v] = np.kron(np.eye(2), R)
        weight[v] = [*((1.0 + k) * R.T @ GRAVITY), 0, 0, 0]
    assert_within(kinematics.J, J)
    # Weights are of size 100.
    force = system.gravity_force(system.q_start, GRAVITY)
    assert_within(force, weight, 100 * ROUNDING)


LIMITS = {
    "both sides": ("revolute", 'lower="-1" upper="2"', (-1.0, 2.0)),
    "up to zero": ("prismatic", 'lower="-1"', (-1.0, 0.0)),
    "from zero": ("prismatic", 'upper="2"', (0.0, 2.0)),
    "one position": ("revolute", 'lower="0.5" upper="0.5"', (0.5, 0.5)),
    "nothing said": ("revolute", "", None),
    "turning on": ("continuous", 'lower="-1" upper="2"', None),
}


@cases("kind, said, limits", LIMITS)
def test_a_joint_has_the_limits_that_its_file_gives_it(kind, said, limits):
    hinge = joint("j", "a", "b", kind)
    written = hinge.replace('lower="-1" upper="1" effort="1"', f'{said} effort="3"')
    assert written != hinge
    found = System([Body("one", robot(link("a"), link("b"), written))]).joint("one/j")
    assert (found.limits, found.effort) == (limits, 3.0)


def test_a_body_becomes_a_model_once(monkeypatch):
    made = []
    append = tree_model._pinocchio_model
    monkeypatch.setattr(
        tree_model, "_pinocchio_model", lambda *of: [made.append(of), append(*of)][1]
    )
    system = balls(9)
    system.kinematics(system.q_start)
    assert len(made) == 9


def test_a_body_of_a_shape_reads_no_file():
    said = printed_text(
        "import sys",
        "import quasistatic_ref as qr",
        "ball = qr.Body.of_shape('ball', qr.Sphere(0.1), 1.0)",
        "print(qr.System([ball]).n_u)",
        "print([name for name in sys.modules if name.startswith('quasistatic_ref.files')])",
    )
    assert said.split("\n") == ["6", "[]"]

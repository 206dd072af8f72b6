"""A formula planted wrong in model/ or contact/ makes `validate` fail."""

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref.contact import jacobian
from quasistatic_ref.lab.claims.claim import FAILS, HOLDS, finding
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.model.system import System
from quasistatic_ref.simulate import simulator

TRUE = {
    "jacobian": jacobian.ContactGeometry.jacobian,
    "cross": jacobian.cross_matrix,
    "closest": simulator.Simulator.closest_points,
    "gravity": System.gravity_force,
    "M_u": System.M_u,
    "integrate": System.integrate,
    "step_data": simulator.Simulator.step_data,
}


def phi_twice_as_large(self, kinematics):
    points = TRUE["closest"](self, kinematics)
    return points._replace(phi=2 * points.phi)


def straight_instead_of_a_screw(self, q, delta_q):
    """The base is moved by delta_q in the world's orientation of the start, then turned."""
    turned = TRUE["integrate"](self, q, delta_q)
    for joint in self.joints:
        if joint.kind == "floating":
            R = pin.Quaternion(np.array(q[joint.q][3:])).toRotationMatrix()
            turned[joint.q][:3] = q[joint.q][:3] + R @ delta_q[joint.v][:3]
    return turned


def half_the_spin(self, *arguments):
    """The other sign, rather than half, would change no answer: both spin rows are there."""
    J = TRUE["jacobian"](self, *arguments)
    J[:, 3] *= 0.5
    return J


FAULTS = {
    "r x omega instead of omega x r": (
        jacobian, "cross_matrix", lambda r: -TRUE["cross"](r), "rolling_sphere",
    ),
    "the same, against MuJoCo": (
        jacobian, "cross_matrix", lambda r: -TRUE["cross"](r), "mujoco_rows",
    ),
    "half the spin": (jacobian.ContactGeometry, "jacobian", half_the_spin, "by_hand"),
    "phi is twice as large": (
        simulator.Simulator, "closest_points", phi_twice_as_large, "incline_sliding",
    ),
    "gravity is half": (
        System, "gravity_force", lambda s, q, g: 0.5 * TRUE["gravity"](s, q, g), "free_fall",
    ),
    "masses are 1 ppm too heavy": (
        System, "M_u", lambda s, q: (1 + 1e-6) * TRUE["M_u"](s, q), "pushed_block",
    ),
    "translation is not a screw": (
        System, "integrate", straight_instead_of_a_screw, "rolling_sphere",
    ),
    "half of the way to the target": (
        simulator.Simulator, "step_data",
        lambda s, q, goal, *more: TRUE["step_data"](s, q, (q[: len(goal)] + goal) / 2, *more),
        "pushed_block",
    ),
}  # fmt: skip


@pytest.mark.parametrize("claim", sorted({fault[3] for fault in FAULTS.values()}))
def test_without_a_fault_the_claim_holds(claim):
    assert finding(BY_NAME[claim]).verdict == HOLDS


@pytest.mark.parametrize("name", FAULTS)
def test_the_fault_is_found(name, monkeypatch):
    owner, attribute, wrong, claim = FAULTS[name]
    monkeypatch.setattr(owner, attribute, wrong)
    assert finding(BY_NAME[claim]).verdict == FAILS

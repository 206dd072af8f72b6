"""A formula planted wrong in model/ or contact/ makes `validate` fail."""

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref.contact import jacobian
from quasistatic_ref.lab.claims.claim import FAILS, HOLDS, finding
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.model.system import System

TRUE = {
    "jacobian": jacobian.ContactGeometry.jacobian,
    "columns": jacobian.columns_at,
    "gravity": System.gravity_force,
    "integrate": System.integrate,
}


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


def other_turn(columns, r, n):
    """nu_origin - omega x r in place of nu_origin + omega x r; the spin is the same."""
    return 2 * TRUE["columns"](columns, 0 * r, n) - TRUE["columns"](columns, r, n)


FAULTS = {
    "r x omega instead of omega x r": (jacobian, "columns_at", other_turn, "mujoco_rows"),
    "half the spin": (jacobian.ContactGeometry, "jacobian", half_the_spin, "by_hand"),
    "gravity is half": (
        System, "gravity_force", lambda s, q, g: 0.5 * TRUE["gravity"](s, q, g), "free_fall",
    ),
    "translation is not a screw": (
        System, "integrate", straight_instead_of_a_screw, "rolling_sphere",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_claim_holds_and_fails_with_the_fault(name, monkeypatch):
    owner, attribute, wrong, claim = FAULTS[name]
    assert finding(BY_NAME[claim]).verdict == HOLDS
    monkeypatch.setattr(owner, attribute, wrong)
    assert finding(BY_NAME[claim]).verdict == FAILS

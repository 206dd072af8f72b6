"""Sines and cosines of joints of one coordinate."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.numbers.angles import cos_sin
from tests.files.urdf.urdf_texts import joint, link, mimic, robot


@pytest.mark.parametrize("followed", [False, True])
def test_sines_are_correctly_rounded_but_of_a_joint_that_another_mimics(followed):
    """Those are pinocchio's, of the C library, as docs/exactness.md says: within one ulp."""
    more = mimic("turn") if followed else ""
    joints = joint("turn", "base", "arm"), joint("grip", "arm", "hand", more=more)
    text = robot(*map(link, ("base", "arm", "hand")), *joints)
    system = qr.System([qr.Body("r", text, actuated="all")])
    arm = system.link("r/arm")
    off = 0
    for angle in np.random.default_rng(0).uniform(-3, 3, 2000):
        q = np.zeros(system.n_q)
        q[0] = angle
        of_link = system.at(q).kinematics.R[arm, :2, 0]
        rounded = np.array(cos_sin(angle))
        off += not (of_link == rounded).all()
        assert (np.abs(of_link - rounded) <= np.spacing(np.abs(rounded))).all()
    assert (off > 0) == followed

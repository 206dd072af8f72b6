"""Sums and differences of many joints at once against those of each: the same bits."""

import numpy as np
import pytest

from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.sums import MANY_JOINTS, Sums
from tests.closeness import assert_same
from tests.made import bits

KINDS = sorted({*BASES.values(), *JOINTS.values()}, key=lambda kind: kind.__name__)


class Odd(KINDS[0]):
    """A kind whose sum is another, which compiled code does not know."""

    def integrated(self, q, delta_q):
        """Half of its last entry."""
        return [*q[:-1], q[-1] / 2]


def joints_of(*kinds):
    """Joints of these kinds, one after another."""
    made: list[Joint] = []
    q = v = 0
    for kind in kinds:
        width = len(kind("j", False, slice(0), slice(0)).coordinates)
        entries = len(kind.neutral())
        made.append(kind("j", False, slice(q, q + entries), slice(v, v + width)))
        q += entries
        v += width
    return made


def turned(joints, rng):
    """A configuration with unit vectors, some of them special."""
    q = np.concatenate([rng.normal(size=joint.q.stop - joint.q.start) for joint in joints])
    for joint in joints:
        if joint.unit_vector:
            unit = q[joint.unit_part]
            axes = np.vstack([np.eye(len(unit)), -np.eye(len(unit))])
            unit[:] = axes[rng.integers(len(axes))] if rng.random() < 0.2 else unit
            unit /= np.sqrt(unit @ unit)
    return q


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_many_joints_at_once_are_each_by_itself(kind, rng):
    check(joints_of(*[kind, KINDS[0], Odd] * (2 * MANY_JOINTS)), rng)


@pytest.mark.extra("compiled")
@pytest.mark.parametrize("other", [*KINDS, Odd], ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_joints_by_compiled_code_are_each_by_itself(kind, other, rng):
    check(joints_of(kind, other), rng)
    check(joints_of(*[kind] * (1 + 2 * MANY_JOINTS)), rng)


@pytest.mark.parametrize("joints", [1, 1 + 2 * MANY_JOINTS])
@pytest.mark.parametrize("kind", [kind for kind in KINDS if len(kind.neutral()) == 2])
@pytest.mark.parametrize("unit", [*np.eye(2), *-np.eye(2)], ids=str)
def test_half_a_turn_is_pi_whichever_way_it_begins(unit, kind, joints):
    """Of the two names of one turn the positive one, as a difference of zeros has a sign."""
    change = Sums(joints_of(*[kind] * joints)).change(np.tile(unit, joints), np.tile(-unit, joints))
    assert change.tolist() == [np.pi] * joints


def test_each_of_several_changes_is_its_own(rng):
    joints = joints_of(*KINDS)
    sums = Sums(joints)
    q, delta_q = turned(joints, rng), rng.normal(size=(3, sums.n_v))
    assert_same(sums.plus_each(q, delta_q), [sums.plus(q, one) for one in delta_q])


def numbers(array):
    """The bits of an array; which NaN comes of an overflow depends on how Python adds."""
    return bits(np.where(np.isnan(array), np.nan, array))


def check(joints, rng):
    """Sums and differences of all joints, and those of each."""
    sums = Sums(joints)
    for size in (0.0, 1e-300, 1e-9, 1e-3, 1.0, 1e3, 1e8, 1e200):
        q, other = turned(joints, rng), turned(joints, rng)
        delta_q = size * rng.normal(size=joints[-1].v.stop) * (rng.random(joints[-1].v.stop) < 0.8)
        each = [
            joint.integrated(q[joint.q].tolist(), delta_q[joint.v].tolist()) for joint in joints
        ]
        assert numbers(sums.plus(q, delta_q)) == numbers(np.concatenate(each))
        for here, there in ((q, other), (q, q), (q, sums.plus(q, delta_q))):
            one = [
                joint.change(here[joint.q].tolist(), there[joint.q].tolist()) for joint in joints
            ]
            assert numbers(sums.change(here, there)) == numbers(np.concatenate(one))

"""Words that scenes are built with: bodies as tables of a scenario."""

from itertools import pairwise

from quasistatic_ref import Body
from tests.files.urdf.urdf_texts import collision, joint, link, robot

AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
TIP = '<sphere radius="0.01"/>'


def solid(mass, shape):
    """URDF of a homogeneous solid."""
    return Body.of_shape("solid", shape, mass).urdf


def placed(urdf, xyz, **more):
    """Table of a body."""
    return {"urdf": urdf, "pose": {"xyz": list(xyz)}, **more}


def driven(urdf, xyz, K_q, targets):
    """Table of a body whose joints have springs."""
    return placed(urdf, xyz, actuated=list(K_q), K_q=K_q, targets=targets)


def slides(axes, shape):
    """A link `tip` on slides along some axes, in their order, by motors of any strength."""
    links = ["post", *axes[:-1], "tip"]
    joints = [
        joint(axis, parent, child, "prismatic", AXES[axis]).replace('effort="1"', 'effort="1000"')
        for axis, (parent, child) in zip(axes, pairwise(links), strict=True)
    ]
    bare = [link(name, inertial="") for name in links[:-1]]
    return robot(*bare, link("tip", collision(shape), inertial=""), *joints)

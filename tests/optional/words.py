"""Words that scenes are built with: bodies as tables of a scenario."""

from quasistatic_ref import Body, Box
from tests.files.urdf import urdf_texts
from tests.files.urdf.urdf_texts import collision, link, robot

AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1", "s": "1 0 0"}
TIP = '<sphere radius="0.01"/>'


def solid(mass, shape):
    """URDF of a homogeneous solid."""
    return Body.of_shape("solid", shape, mass).urdf


def block(mass, size):
    """URDF of a homogeneous block."""
    return solid(mass, Box(size=size))


def placed(urdf, xyz, **more):
    """Table of a body."""
    return {"urdf": urdf, "pose": {"xyz": list(xyz)}, **more}


def free(urdf, xyz, force=(0, 0, 0), torque=(0, 0, 0)):
    """Table of a free body under a load [N, N m]."""
    loads = [{"t": 0.0, "force": list(force), "torque": list(torque)}]
    return placed(urdf, xyz, base="floating", wrenches=loads)


def driven(urdf, xyz, K_q, targets):
    """Table of a body whose joints have springs."""
    return placed(urdf, xyz, actuated=list(K_q), K_q=K_q, targets=targets)


def joint(name, parent, child, axis, kind="prismatic", at=(0, 0, 0)):
    """A joint whose motor may be of any strength."""
    text = urdf_texts.joint(name, parent, child, kind, axis, '<origin xyz="{} {} {}"/>'.format(*at))
    return text.replace('effort="1"', 'effort="1000"')


def slides(axes, shape, down=False):
    """A link `tip` on slides along some axes, in their order; `down` turns z round."""
    parts = [link("post", inertial="")]
    parent = "post"
    for i, axis in enumerate(axes):
        last = i == len(axes) - 1
        child = "tip" if last else f"l{i}"
        way = "0 0 -1" if down and axis == "z" else AXES[axis]
        parts.append(link(child, collision(shape) if last else "", inertial=""))
        parts.append(joint(axis, parent, child, way))
        parent = child
    return robot(*parts)

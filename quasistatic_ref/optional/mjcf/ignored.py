"""What an MJCF model says and the model here ignores, by names.

MuJoCo writes what it has read as one canonical file: without includes, frames of other files,
replicas and abbreviations, and with the attributes alone that are not as they are by default. What
of that is not read here is ignored, and listed: an attribute that nobody thought of is listed, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

import numpy as np

from quasistatic_ref.optional.mjcf.names import Names

if TYPE_CHECKING:
    from mujoco import MjModel, MjSpec

_PLACE = ("pos", "quat", "axisangle", "xyaxes", "zaxis", "euler")
_SECTIONS = (
    "actuator", "asset", "contact", "custom", "deformable", "extension", "keyframe", "sensor",
    "tendon", "visual", "worldbody",
)  # fmt: skip
_READ: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(_SECTIONS, ()),
    "body": ("name", "childclass", *_PLACE),
    "compiler": ("angle", "autolimits"),
    "default": ("class",),
    "frame": ("name", "childclass", *_PLACE),
    "freejoint": ("name",),
    "geom": (
        "name", "class", "type", "size", "fromto", "mesh", "hfield", "fitscale", "mass", "density",
        "shellinertia", "contype", "conaffinity", "group", "rgba", "material", "friction", *_PLACE,
    ),
    "inertial": ("mass", "diaginertia", "fullinertia", *_PLACE),
    "joint": ("name", "class", "type", "pos", "axis", "range", "limited", "frictionloss"),
    "mesh": (
        "name", "class", "file", "vertex", "face", "builtin", "params", "scale",
        "refpos", "refquat", "inertia",
    ),
}  # fmt: skip
"""Element -> its attributes that are read; of other elements nothing is read."""
_MASKS = ("contype", "conaffinity")
"""Whether they are 0 is read: other bits than the first are not."""
_COMPILER = (
    "LRopt", "conflict", "passthrough", "savecanonical", "savecompiled", "saveinertial",
    "texturedir", "usethread",
)  # fmt: skip
"""What MuJoCo's compiler is told of other things than bodies, joints, geoms and meshes."""


def ignored_of_spec(spec: MjSpec) -> list[str]:
    """What of a file is ignored: ``actuator.general[hip]``, ``joint[knee].armature``, ``option``.

    Parameters
    ----------
    spec : mujoco.MjSpec
        After it was compiled.
    """
    plain = type(spec)().compiler
    given = [name for name in _COMPILER if getattr(spec.compiler, name) != getattr(plain, name)]
    spec.compiler.savecompiled = True  # else what the compiler has read would be written, too
    written = ElementTree.fromstring(spec.to_xml())
    # A scenario has h and gravity of its own, whatever the file says.
    return ["option", *(f"compiler.{name}" for name in given), *_unread(written)]


def _unread(written: ElementTree.Element) -> list[str]:
    """The elements of a canonical file that are not read, and the attributes of those that are."""
    found = []
    front = [(element, "") for element in written]
    while front:
        element, where = front.pop(0)
        tag = element.tag
        name = element.get("class" if tag == "default" else "name")
        called = ("" if tag == "default" else where) + (f"{tag}[{name}]" if name else tag)
        if tag not in _READ or (where and tag in _SECTIONS):
            found.append(called)
            continue
        for attribute, value in element.attrib.items():
            bits = attribute in _MASKS and value not in ("0", "1")
            if attribute not in _READ[tag] or bits:
                found.append(f"{called}.{attribute}")
        inside = "" if tag in ("worldbody", "body", "frame") else f"{called}."
        front = [(child, inside) for child in element] + front
    return found


def ignored_of_free(model: MjModel, names: Names) -> list[str]:
    """What of the only body, which a free joint moves, the base of a scenario's body replaces."""
    found = []
    if np.any(model.body_pos[1]) or np.any(model.body_quat[1] != (1, 0, 0, 0)):
        found.append(f"body[{names.bodies[1]}].pos")
    if model.joint(0).name:
        found.append(f"joint[{names.joints[0]}].name")
    if np.any(model.dof_frictionloss[:6]):
        found.append(f"joint[{names.joints[0]}].frictionloss")
    return found

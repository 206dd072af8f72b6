"""The joints in the URDFs of bodies, with the joint that moves each of them."""

from collections.abc import Collection, Iterator
from typing import NamedTuple

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.urdf.xml import Tag
from quasistatic_ref.files.xml_text import xml_root
from quasistatic_ref.model.system import System
from quasistatic_ref.model.tree import Tree


class UrdfJoint(NamedTuple):
    """A joint of one axis, whose position is multiplier * q + offset, q being its leader's.

    Parameters
    ----------
    name, leader : str
        ``body/joint``; a joint that mimics no other leads itself.
    multiplier, offset : float
        [-, or m/rad or rad/m], [m, rad].
    tag : Tag
        Its element.
    """

    name: str
    leader: str
    multiplier: float
    offset: float
    tag: Tag


def urdf_joints(system: System, bodies: Collection[str]) -> Iterator[UrdfJoint]:
    """The joints of one axis that move, of the bodies of these names.

    Raises
    ------
    InputError
        If one of these has no URDF.
    """
    moves = {coordinate.name: (coordinate.name, 1.0, 0.0) for coordinate in system.coordinates}
    moves |= {mimic.name: (mimic.of, mimic.multiplier, mimic.offset) for mimic in system.mimics}
    for body, text in zip(system.bodies, system.texts, strict=True):
        if body.name in bodies and isinstance(body.urdf, Tree):
            source = str(body.urdf.path).strip("<>")
            problem = f'is made of a {source}, which has no URDF: give numbers, not "urdf"'
            raise InputError(problem, field=f"bodies.{body.name}")
        for joint in xml_root(text).findall("joint") if body.name in bodies else ():
            name = f"{body.name}/{joint.get('name')}"
            if name in moves:
                tag = Tag(joint, f"{body.name}: joint[{joint.get('name')}]")
                yield UrdfJoint(name, *moves[name], tag)

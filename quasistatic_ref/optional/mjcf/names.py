"""What the bodies, joints and geoms of an MJCF model are called in its URDF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mujoco import MjModel

WORLD = "worldbody"
"""The link of what stands in the world."""


@dataclass
class Names:
    """Names of which each is of one link, one joint or one geom only.

    Parameters
    ----------
    bodies, joints, geoms : list of str
        By MuJoCo's numbers: their own, or their kind and number where they have none.
    """

    bodies: list[str]
    joints: list[str]
    geoms: list[str]

    @classmethod
    def of(cls, model: MjModel) -> Names:
        """Those of a model of MuJoCo."""
        bodies = [model.body(i).name for i in range(1, model.nbody)]
        bodies.insert(0, _unlike(WORLD, bodies))
        joints = [model.joint(i).name for i in range(model.njnt)]
        geoms = [model.geom(i).name for i in range(model.ngeom)]
        return cls(_whole("body", bodies), _whole("joint", joints), _whole("geom", geoms))

    def free_body(self, name: str) -> str:
        """A link that MuJoCo does not have: `name`, or one like it."""
        self.bodies.append(_unlike(name, self.bodies))
        return self.bodies[-1]

    def free_joint(self, name: str) -> str:
        """A joint that MuJoCo does not have: `name`, or one like it."""
        self.joints.append(_unlike(name, self.joints))
        return self.joints[-1]


def _whole(kind: str, given: Sequence[str]) -> list[str]:
    """Names, those that are not given from kind and number."""
    names = list(given)
    for i, name in enumerate(given):
        names[i] = name or _unlike(f"{kind}{i}", names)
    return names


def _unlike(name: str, others: Sequence[str]) -> str:
    """A name that others do not have: with underscores at its end if need be."""
    while name in others:
        name += "_"
    return name

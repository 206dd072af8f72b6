"""A body: one mechanism, where it stands, and which of its joints are actuated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError, about_field, check_kind, fields_named
from quasistatic_ref.model.joints import BASES
from quasistatic_ref.model.solid import Homogeneous, solid_tree
from quasistatic_ref.model.tree import ALL, ALL_BUT_BASE, Tree
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.shapes.frozen import finite_number, freeze_array
from quasistatic_ref.text.plain import Plain

FIXED = "fixed"
BASE_WORDS = (FIXED, *BASES)

Described = Callable[[pin.Model, pin.GeometryModel | None], tuple[Tree, str]]
"""pinocchio's model of a body and of its shapes -> its tree, and the kind of its base."""


@fields_named(pose="give xyz=pose.translation and rpy=pinocchio.rpy.matrixToRpy(pose.rotation)")
@dataclass(frozen=True, eq=False)
class Body(Plain):
    """One mechanism in the world: a URDF, a shape or a pinocchio Model, and its base.

    Parameters
    ----------
    name : str
        Prefix of its links and joints, e.g. ``gripper`` for ``gripper/left_finger``.
    urdf : str or Path; or Tree
        Its file; or the URDF itself, a string that begins with ``<``, whose meshes are looked for
        in the working folder; or a mechanism, which :meth:`of_shape` and :meth:`of_pinocchio` make.
    base : str
        ``"fixed"``, ``"floating"``, ``"planar"`` (moving in the horizontal plane at the height of
        xyz, turning about the vertical) or ``"ball"`` (turning about xyz).
    actuated : tuple of str, "joints" or "all"
        Names of its joints, without the prefix; ``"base"`` is the base, which ``"all"`` takes, and
        ``"joints"`` does not.
    xyz : array_like, shape (3,)
        Where the root link is (fixed) or starts (otherwise), in the world [m].
    rpy : array_like, shape (3,)
        Its orientation, R = Rz(yaw) Ry(pitch) Rx(roll) [rad].
    positions : mapping of str to float
        Where joints start [m or rad]; 0 for those not named.
    package_dirs : tuple of Path
        Where ``package://`` URIs are looked for.

    Raises
    ------
    ModelError
        If a name cannot serve, or a number is not finite. What concerns the URDF itself is
        checked by :class:`~quasistatic_ref.model.system.System`.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3)
    >>> ball.name
    'ball'
    """

    name: str
    urdf: str | PathLike[str] | Tree
    base: str = "fixed"
    actuated: Sequence[str] = ()
    xyz: ArrayLike = (0.0, 0.0, 0.0)
    rpy: ArrayLike = (0.0, 0.0, 0.0)
    positions: Mapping[str, float] = field(default_factory=dict)
    package_dirs: Sequence[str | Path] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name or self.name == "world":
            problem = "must be a name other than 'world'"
            raise ModelError(problem, field="body.name", value=self.name)
        if any(c in "/#*" or c.isspace() for c in self.name):
            problem = "must not contain '/', '#', '*' or white space"
            raise ModelError(problem, field="body.name", value=self.name)
        if self.base not in BASE_WORDS:
            problem = f"is not a base{suggestion(str(self.base), BASE_WORDS)}"
            raise ModelError(problem, field=f"{self.name}.base", value=self.base)
        names = self.actuated
        if isinstance(names, str) and names in (ALL, ALL_BUT_BASE):
            object.__setattr__(self, "actuated", str(names))
        else:
            if not isinstance(names, list | tuple) or not all(isinstance(n, str) for n in names):
                problem = (
                    'must be "all", "joints" (all but the base) or a list of joint names, of which '
                    '"base" is the base'
                )
                raise ModelError(problem, field=f"{self.name}.actuated", value=names)
            object.__setattr__(self, "actuated", tuple(names))
        for key in ("xyz", "rpy"):
            with about_field(f"{self.name}.{key}"):
                freeze_array(self, key, (3,))
        xyz = np.asarray(self.xyz)
        rpy = np.asarray(self.rpy)
        obstacle = None if self.base == FIXED else BASES[self.base].obstacle(xyz, rpy, xyz)
        if obstacle is not None:
            raise ModelError(obstacle, field=f"{self.name}.rpy", value=rpy.tolist())
        for key, kinds, wanted in (
            (
                "urdf",
                str | PathLike | Tree,
                "a path, or a URDF as text; of_pinocchio takes a Model",
            ),
            ("positions", Mapping, "a mapping of joints to numbers, as in {'elbow': 0.3}"),
            ("package_dirs", list | tuple, "a list of folders"),
        ):
            check_kind(getattr(self, key), kinds, f"{self.name}.{key}", wanted, ModelError)
        if isinstance(self.urdf, PathLike):
            object.__setattr__(self, "urdf", Path(self.urdf))
        positions = {
            joint: finite_number(value, f"{self.name}.positions.{joint}")
            for joint, value in self.positions.items()
        }
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "package_dirs", tuple(self.package_dirs))

    @classmethod
    def of_shape(cls, name: str, shape: Homogeneous, mass: float, **more: Any) -> Body:
        """A homogeneous solid: one link, ``NAME/solid``, with one collision shape.

        Parameters
        ----------
        name : str
        shape : Sphere, Box, Cylinder or Capsule
            About the origin of the link, which is the centre of mass.
        mass : float
            [kg].
        more : object
            Of `base` (here ``"floating"`` by default), `actuated`, `xyz`, `rpy`.

        Returns
        -------
        Body

        Raises
        ------
        ModelError
            If the shape is another one, or the mass not positive.
        """
        return cls(name, solid_tree(shape, mass, name), **{"base": "floating", **more})

    @classmethod
    def of_pinocchio(
        cls,
        name: str,
        model: pin.Model,
        geometry: pin.GeometryModel | None = None,
        **more: Any,
    ) -> Body:
        """A pinocchio Model, with the shapes of its collision GeometryModel.

        Links are the Model's BODY frames. What fixed joints weld is one rigid body in pinocchio:
        its mass is that of the link at the joint's origin, the other links have none. Meshes are
        taken for their hulls. A root joint FreeFlyer, Planar or Spherical is the base. A Model that
        was built without ``mimic=True`` has joints that mimic others as free ones.

        Parameters
        ----------
        name : str
        model : pinocchio.Model
            Joints: revolute, prismatic or continuous about any axis, spherical, and mimics.
        geometry : pinocchio.GeometryModel, optional
            Boxes, spheres, capsules, cylinders, cones, ellipsoids and meshes.
        more : object
            Of `base` (that of the Model by default), `actuated`, `xyz`, `rpy`, `positions`; the
            joint of a base is called ``"base"``.

        Returns
        -------
        Body

        Raises
        ------
        InputError
            If `model` or `geometry` is something else, or
            ``optional/pinocchio_models`` is missing.
        ModelError
            If a joint or a shape is of another kind, or `base` is not that of the Model.

        Examples
        --------
        >>> import pinocchio as pin
        >>> arm = qr.Body.of_pinocchio("arm", pin.buildSampleModelManipulator(), actuated="all")
        >>> qr.System([arm]).n_a
        6
        """
        described_model: Described = part("described_model")
        tree, base = described_model(model, geometry)
        if base not in (FIXED, more.setdefault("base", base)):
            problem = f"must be {base!r}, as the root joint of the Model; leave it out"
            raise ModelError(problem, field=f"{name}.base", value=more["base"])
        return cls(name, tree, **more)

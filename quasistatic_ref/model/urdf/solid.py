"""Homogeneous solids as URDF: their moments of inertia, and a text of one link."""

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.frozen import finite_number
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Sphere

Homogeneous = Sphere | Box | Cylinder | Capsule
"""The shapes that a URDF has a name for, meshes aside."""


def solid_urdf(shape: Homogeneous, mass: float, name: str) -> str:
    """URDF text of one link, ``solid``, about whose origin the shape lies.

    Parameters
    ----------
    shape : Sphere, Box, Cylinder or Capsule
    mass : float
        [kg].
    name : str
        What it is called in messages.

    Raises
    ------
    ModelError
        If the shape is another one, or the mass not positive.
    """
    if not isinstance(shape, Homogeneous):
        problem = "must be a Sphere, Box, Cylinder or Capsule; other bodies need a URDF"
        raise ModelError(problem, field=f"{name}.shape", value=shape)
    m = finite_number(mass, f"{name}.mass")
    if not m > 0:
        raise ModelError("must be greater than 0", field=f"{name}.mass", value=mass)
    xx, yy, zz = solid_inertia(shape, m).tolist()
    sizes = " ".join(
        f'{key}="{" ".join(map(repr, np.atleast_1d(size).tolist()))}"'
        for key, size in shape.sizes.items()
    )
    return (
        '<robot name="solid" version="1.1"><link name="solid">'
        f'<inertial><mass value="{m!r}"/>'
        f'<inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="0" ixz="0" iyz="0"/></inertial>'
        f"<collision><geometry><{shape.kind} {sizes}/></geometry></collision></link></robot>"
    )


def solid_inertia(shape: Homogeneous, mass: float) -> Array:
    """Principal moments of a homogeneous solid about its centre, shape (3,) [kg m^2].

    Parameters
    ----------
    shape : Sphere, Box, Cylinder or Capsule
    mass : float
        [kg].
    """
    if isinstance(shape, Sphere):
        return np.full(3, 2 / 5 * mass * shape.radius**2)
    if isinstance(shape, Box):
        a, b, c = shape.half_extents**2
        return np.asarray(mass / 3 * np.array([b + c, a + c, a + b]))
    # A cylinder, and at the ends of a capsule two half balls, each by its share of the volume.
    r = shape.radius
    half = shape.half_length
    ends = 4 / 3 * r if isinstance(shape, Capsule) else 0.0
    balls = mass * ends / (2 * half + ends)
    cylinder = mass - balls
    along = cylinder / 2 * r**2 + 2 / 5 * balls * r**2
    # The centre of a half ball is 3/8 r from its flat face; about it, m r^2 (2/5 - 9/64).
    across = cylinder * (r**2 / 4 + half**2 / 3)
    across += balls * ((2 / 5 - 9 / 64) * r**2 + (half + 3 / 8 * r) ** 2)
    return np.array([across, across, along])

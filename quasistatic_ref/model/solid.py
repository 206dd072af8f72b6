"""Homogeneous solids: their moments of inertia, and a tree of one link."""

from pathlib import Path
from typing import Final

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.inertia import inertia_defect
from quasistatic_ref.model.tree import LinkShape, Tree, TreeLink
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.frozen import finite_number
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Sphere
from quasistatic_ref.tolerances import LARGE

Homogeneous = Sphere | Box | Cylinder | Capsule
"""The shapes that :func:`solid_inertia` knows."""

SOLID: Final = "solid"
"""The name of the link."""


def solid_tree(shape: Homogeneous, mass: float, name: str) -> Tree:
    """One link, ``solid``, about whose origin the shape lies.

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
        If the shape is another one, the mass is not positive, or a number is too large.
    """
    if not isinstance(shape, Homogeneous):
        problem = "must be a Sphere, Box, Cylinder or Capsule; other bodies need a URDF"
        if type(shape).__module__.startswith("coal"):
            problem = "must be one of this package, such as Box(box.halfSide) of a coal.Box"
        raise ModelError(problem, field=f"{name}.shape", value=type(shape).__name__)
    m = finite_number(mass, f"{name}.mass")
    if not m > 0:
        raise ModelError("must be greater than 0", field=f"{name}.mass", value=mass)
    collision = LinkShape(f"{SOLID}#0", shape, np.eye(3), np.zeros(3))
    sizes = {size: np.asarray(value).tolist() for size, value in shape.sizes.items()}
    _check_size(max(map(np.max, sizes.values())), f"{name}.shape", "m")
    _check_size(m, f"{name}.mass", "kg")
    moments = solid_inertia(shape, m)
    _check_size(moments.max(), f"{name}.inertia", "kg m^2")
    inertia = np.diag(moments)
    link = TreeLink(SOLID, m, np.zeros(3), inertia, (collision,), inertia_defect(inertia))
    return Tree(Path(f"<{SOLID}>"), f"{shape.kind} {sizes}, {m!r} kg", {SOLID: link}, ())


def _check_size(size: float, field: str, unit: str) -> None:
    if size > LARGE:
        raise ModelError(f"must be at most {LARGE:g} {unit}", field=field, value=float(size))


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

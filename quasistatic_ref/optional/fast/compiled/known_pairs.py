"""Pairs of shapes whose closest points follow from a formula, and what a library makes of them."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.fast.compiled.pairs import Pairs
from quasistatic_ref.shapes.convex_mesh import hull_of_mesh
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cylinder,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Shape,
    Sphere,
)
from quasistatic_ref.step.arrays import Array

ROUNDING = 1e-12
"""Of lengths up to 10 m [m]."""
UP = (0.0, 0.0, 1.0)
BEYOND = (1 - 2e-12, 2e-6, 0.0)
"""Nearly along x."""
FLOOR = HalfSpace(np.array(UP), 0.0)
BOX = Box(np.ones(3))
TURNED = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
"""About the vertical, by the angle of the triangle of sides 3, 4 and 5."""
TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (0.0, 0.5)])

Case = tuple[Shape, Shape, tuple[float, float, float], int, Sequence[float], Sequence[float]]
CASES: dict[str, Case] = {
    # phi = height - radius
    "a ball over a floor": (FLOOR, Sphere(0.5), (3.0, 4.0, 2.0), 1, [1.5], UP),
    # phi = distance of the centres - both radii, along (3, 4) / 5
    "two balls": (Sphere(1.0), Sphere(2.0), (3.0, 4.0, 0.0), 1, [2.0], (0.6, 0.8, 0.0)),
    "two balls in each other": (
        Sphere(4.0), Sphere(2.0), (3.0, 4.0, 0.0), 1, [-1.0], (0.6, 0.8, 0.0),
    ),
    # the corner (1, 1, 1) is (2, 3, 6) away, which is 7 long
    "a ball at a corner": (BOX, Sphere(2.0), (3.0, 4.0, 7.0), 1, [5.0], (2 / 7, 3 / 7, 6 / 7)),
    # the edge through (1, 1) is (3, 4) away
    "a ball at an edge": (BOX, Sphere(1.0), (4.0, 5.0, 0.25), 1, [4.0], (0.6, 0.8, 0.0)),
    "a ball in a face": (BOX, Sphere(0.5), (0.25, 0.5, 1.25), 1, [-0.25], UP),
    # the centre is 0.25 below the top: the nearest face
    "a ball inside": (BOX, Sphere(0.5), (0.25, 0.0, 0.75), 1, [-0.75], UP),
    # the lower face at height - 1
    "a box over a floor": (FLOOR, BOX, (0.0, 0.0, 1.5), 1, [0.5], UP),
    # the lower end at height - half the length - radius
    "a capsule over a floor": (FLOOR, Capsule(0.5, 1.0), (1.0, 0.0, 3.0), 1, [1.5], UP),
    # the axes are parallel, and a distance (3, 4) apart
    "two capsules": (
        Capsule(1.0, 1.0), Capsule(0.5, 1.0), (3.0, 4.0, 1.0), 1, [3.5], (0.6, 0.8, 0.0),
    ),
    # from the wall of radius 1, along (3, 4) / 5; from the rim, (3, 4) away in radius and height
    "a ball at a cylinder": (
        Cylinder(1.0, 1.0), Sphere(1.0), (3.0, 4.0, 0.5), 1, [3.0], (0.6, 0.8, 0.0),
    ),
    "a ball at a rim": (Cylinder(1.0, 1.0), Sphere(1.0), (4.0, 0.0, 5.0), 1, [4.0], (0.6, 0, 0.8)),
    # the lower face of one is 0.5 over the upper face of the other, which the turn leaves flat
    "two boxes": (BOX, BOX, (0.0, 0.0, 2.5), 1, [0.5], UP),
    # the edges through (1, 1) and (5, 4) are (4, 3) apart
    "two boxes by their edges": (
        BOX, Box(np.array([0.5, 0.5, 3.0])), (5.5, 4.5, 1.0), 1, [5.0], (0.8, 0.6, 0.0),
    ),
    # the edge through (1, 1) is (1, 2e-6) / 4 away, which is as far as the face within rounding
    "a capsule beyond an edge": (
        BOX, Capsule(0.5, 1.0), (1.25, 1 + 5e-7, 0.25), 1, [-0.25], BEYOND,
    ),
    "a ball beyond an edge": (BOX, Sphere(0.5), (1.25, 1 + 5e-7, 0.25), 1, [-0.25], BEYOND),
    # a corner at the height of the place
    "a tetrahedron over a floor": (
        FLOOR, hull_of_mesh(TETRAHEDRON, SIDES), (0.0, 0.0, 0.25), 1, [0.25], UP,
    ),
    # the slanted side is at (x + y + z - 1) / sqrt(3)
    "a ball at a tetrahedron": (
        hull_of_mesh(TETRAHEDRON, SIDES), Sphere(0.5), (2.0, 2.0, 2.0), 1,
        [5 / 3**0.5 - 0.5], (3**-0.5,) * 3,
    ),
    # four points at the height of the place, four half a unit higher
    "a cloud over a floor": (
        FLOOR, PointCloud(CORNERS), (1.0, 2.0, 0.5), 5, [0.5] * 4 + [1.0], UP,
    ),
    # (3, 4, 0) is 5 from the centre, the other point farther
    "a cloud at a ball": (
        Sphere(1.0), PointCloud(np.array([[0.0, 0.0, 0.0], [3.0, 9.0, 1.0]])),
        (3.0, 4.0, 0.0), 1, [4.0], (0.6, 0.8, 0.0),
    ),
    "a cloud in a box": (
        BOX, PointCloud(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 9.0]])),
        (0.0, 0.25, 0.75), 2, [-0.25, 8.75], UP,
    ),
}  # fmt: skip
"""alpha, beta, where beta is before all is turned and moved [m], k, each phi [m], the normal."""


PLACE = np.array([0.5, -1.25, 2.0])
"""Where alpha is."""


def wrong_points() -> str | None:
    """What the library of this process makes of known pairs that is wrong, in words."""
    pairs = []
    places = [PLACE]
    for i, (name, (alpha, beta, place, k, _, _)) in enumerate(CASES.items()):
        on_a = PlacedShape(name, 0, np.eye(3), np.zeros(3), alpha)
        on_b = PlacedShape(name, i + 1, np.eye(3), np.zeros(3), beta)
        pairs.append(ContactPair(name, on_a, on_b, 0.5, 0.0, 4, k))
        places.append(PLACE + TURNED @ place)
    columns = np.ascontiguousarray(TURNED.T)
    R = np.full(len(places), columns.ctypes.data)
    t = np.array([place.ctypes.data for place in places])
    n_c = sum(pair.n_c for pair in pairs)
    found = ClosestPoints(np.zeros(n_c), *np.zeros((3, n_c, 3)), *np.zeros((2, n_c), np.int64))
    both = Pairs(pairs, R, t, found)
    for _ in "ab":  # clouds keep lists of points
        decided = both.decided().tolist()
        for i, (name, case) in enumerate(CASES.items()):
            own = found.chosen(np.arange(both.start[i], both.start[i] + pairs[i].n_c))
            if i not in decided or not _right(own, case, places[i + 1]):
                return f"the closest points of {name} are wrong"
    return None


def _right(found: ClosestPoints, case: Case, place: Array) -> bool:
    """Whether contacts have the gaps and the normal of a case, and lie on the shapes."""
    alpha, beta, _, _, phi, normal = case
    errors = [
        found.phi - phi,
        found.n - TURNED @ normal,
        found.beta - found.alpha - found.phi[:, None] * found.n,
    ]
    for shape, points, t in ((alpha, found.alpha, PLACE), (beta, found.beta, place)):
        if not isinstance(shape, PointCloud):
            errors.append(shape.signed_distance((points - t) @ TURNED)[0])
    return all(np.abs(error).max() < ROUNDING for error in errors)

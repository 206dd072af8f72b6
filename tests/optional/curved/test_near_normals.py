"""Normals of curved solids that nearly touch, and answers that do not depend on earlier ones."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cone, Cylinder, convex_hull
from quasistatic_ref.optional.curved.faces import face, placed_kinks
from tests.closeness import assert_within
from tests.contact.still import in_world, solid_pair
from tests.processes import printed_text
from tests.tolerances import CURVED_PAIR

BOX = Box((0.05, 0.035, 0.025))
CAN = Cylinder(0.03, 0.05)
Z = np.array([0.0, 0.0, 1.0])


def test_a_side_ends_at_the_caps_though_the_normal_is_off_by_rounding():
    R = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
    side = face(in_world(Cylinder(1.0, 0.5), R=R), R @ [1.0, 0.0, 0.9e-11]).corners
    assert_within(side @ R, [[1.0, 0.0, -0.5], [1.0, 0.0, 0.5]], CURVED_PAIR)


@pytest.mark.parametrize("sine", [0.6, 1e-5])
def test_axes_that_are_nearly_parallel_have_a_normal_across_both(sine):
    """Cylinders one over the other, at a gap: the normal is z, and both lines cross at (x, 0)."""
    x = 0.05
    cosine = np.sqrt(1 - sine**2)
    along_x = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    skew = np.array([[0.0, -sine, cosine], [0, cosine, sine], [-1, 0, 0]])
    low = in_world(Cylinder(0.1, 0.3), R=along_x)
    top = in_world(Cylinder(0.05, 0.4), [x, 0, 0.16] + 0.2 * skew[:, 2], skew)
    found = solid_pair("p", low, top)
    assert_within(found.n, Z, CURVED_PAIR)
    assert_within(found.alpha, [x, 0.0, 0.1], 1e-10)


@pytest.mark.parametrize("gap", [3e-10, 5e-9, 1e-7])
@pytest.mark.parametrize("solid", [BOX, convex_hull(BOX.corners(Z)[0])], ids=["box", "mesh"])
@pytest.mark.parametrize("rimmed", [CAN, Cone(0.03, 0.05)], ids=["can", "cone"])
@pytest.mark.parametrize("lean", [1e-4, 1.2e-3, 0.02])
def test_a_corner_near_a_rim_and_almost_across_an_edge_has_its_own_normal(solid, rimmed, gap, lean):
    """The normal is known: the corner is put on it, which is `lean` from the edge's circle."""
    low = rimmed.half_length * (1 if rimmed is CAN else -1)
    angle = 0.7
    outward = np.array([np.cos(angle), np.sin(angle), 0.0])
    n = (outward + 0.5 * np.sign(low) * Z) / np.hypot(1, 0.5)
    corner = 0.03 * outward + low * Z + gap * n
    # The box has the corner (-,-,-); its edge along x is across the normal but for the lean.
    along = np.cross(n, Z) / np.linalg.norm(np.cross(n, Z))
    x = np.cos(lean) * along + np.sin(lean) * n
    across = n - (n @ x) * x
    y = Rotation.from_rotvec(np.pi / 4 * x).apply(across / np.linalg.norm(across))
    R = np.column_stack([x, y, np.cross(x, y)])
    R[:, 1:] *= np.sign(n @ R[:, 1:])
    R[:, 1:] = R[:, 1:] if np.linalg.det(R) > 0 else R[:, :0:-1]
    assert (n @ R > 0).all()
    t = corner + R @ BOX.half_extents
    found = solid_pair("p", in_world(rimmed), in_world(solid, t, R))
    assert found.phi == pytest.approx(gap, abs=1e-15)
    np.testing.assert_allclose(found.n, n, atol=1e-15 / gap + 1e-9)


ASKED = """
import numpy as np
from scipy.spatial.transform import Rotation
from quasistatic_ref import Box, Cone, Cylinder, Ellipsoid
from tests.contact.still import in_world, solid_pair

box = Box((0.05, 0.035, 0.025))
if turned:  # coal is first asked along a direction without zeros in the box's frame
    R = Rotation.from_rotvec([0.3, 0.4, 0.5]).as_matrix()
    solid_pair("p", in_world(Cylinder(0.03, 0.05)), in_world(box, [0.3, 0.2, 0.1], R))
rng = np.random.default_rng(5)
for _ in range(4):
    for shape in (Cylinder(0.03, 0.05), Cone(0.03, 0.05), Ellipsoid((0.02, 0.03, 0.05))):
        R = Rotation.random(rng=rng).as_matrix()
        t = 0.1 * rng.normal(size=3) + 0.1
        found = solid_pair("p", in_world(box), in_world(shape, t, R))
        print(np.hstack([found.phi, found.alpha, found.beta, found.n]).tobytes().hex())
"""


def test_answers_for_a_box_do_not_depend_on_what_coal_was_asked_before():
    first, turned = (printed_text(f"turned = {turned}", ASKED) for turned in (False, True))
    assert len(first.splitlines()) == 12
    assert first == turned


def test_a_slant_has_a_kink_at_its_own_normals_alone():
    """Those of a cone of 30 mm and a height of 40 mm rise by 3/5."""
    for rise, count in ((0.6, 1), (-0.6, 0), (0.61, 0)):
        n = np.array([np.sqrt(1 - rise**2), 0.0, rise])
        assert len(placed_kinks(in_world(Cone(0.03, 0.02)), n, 1e-3).axes) == count

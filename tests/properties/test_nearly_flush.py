"""Equal solids, one on the other, turned by next to nothing: no step of theirs is refused."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, Box, HalfSpace, convex_hull, load_scenario

STEPS = 20
FLAT = 1e-6
"""Angle [rad] up to which solids count as flush, and distance [m] by which these may move."""
IN_HALVES = np.array([[0, 0, 0], [np.pi, 0, 0], [3.14159, 0, 0], [0, 0, 1.5708]])
"""Turns of a box onto itself, or nearly [rad]."""


def prism(rng, half):
    """Vertices of a prism, shape (2 n, 3) [m]."""
    n = int(rng.integers(3, 9))
    angles = np.arange(n) * (2 * np.pi / n)
    ring = half[0] * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([np.column_stack([ring, np.full(n, z)]) for z in (-half[2], half[2])])


def mesh_urdf(folder, vertices):
    """A URDF of 1 kg of a convex mesh, which is written with all digits."""
    hull = convex_hull(vertices)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in hull.vertices.tolist()]
    lines += [f"f {i} {j} {k}" for i, j, k in (hull.triangles + 1).tolist()]
    (folder / "solid.obj").write_text("\n".join(lines), "utf-8")
    moment = hull.extent**2 / 6
    inertia = f'ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"'
    urdf = folder / "solid.urdf"
    urdf.write_text(
        f'<robot name="r"><link name="l"><inertial><mass value="1"/><inertia {inertia}/></inertial>'
        '<collision><geometry><mesh filename="solid.obj"/></geometry></collision></link></robot>',
        "utf-8",
    )
    return urdf


def drawn_scene(seed, folder):
    """Two equal solids on a floor, and by how much each is turned [rad]."""
    rng = np.random.default_rng(seed)
    half = rng.uniform(0.01, 0.1, 3) * 10 ** rng.uniform(-1, 1)
    is_box = rng.random() < 0.4
    if not is_box:
        vertices = Box(half).corners(half)[0] if rng.random() < 0.3 else prism(rng, half)
        urdf = mesh_urdf(folder, vertices)
    turn = 10 ** rng.uniform(-15, -2)
    place = rng.uniform(-1, 1, 3) * 10 ** rng.uniform(-3, 1.8) * rng.integers(0, 2)
    deep = half[2] * rng.choice([0.0, 1e-6, -1e-6])
    bodies = {}
    for name, z in (("low", half[2]), ("up", 3 * half[2] - deep)):
        way = rng.normal(size=3)
        onto = Rotation.from_euler("xyz", rng.choice(IN_HALVES) if is_box else np.zeros(3))
        by = Rotation.from_rotvec(turn * way / np.linalg.norm(way))
        pose = {
            "xyz": tuple(place + np.array([0, 0, z])),
            "rpy": tuple((by * onto).as_euler("xyz")),
        }
        if is_box:
            bodies[name] = Body.of_shape(name, Box(half), mass=1.0, **pose)
        else:
            bodies[name] = Body(name, urdf, base="floating", actuated=(), **pose)
    contact = {"mu_v": 0.5, "rows": 4}
    tables = {
        "h": 0.01,
        "steps": STEPS,
        "bodies": bodies,
        "shapes": {"floor": HalfSpace((0, 0, 1), float(place[2]))},
        "contacts": {
            "floor": {"alpha": "floor", "beta": "low", "k": 16, **contact},
            "on": {"alpha": "low", "beta": "up", "k": 40, **contact},
        },
    }
    return load_scenario(tables, backend="daqp", certify="off"), turn


@pytest.mark.parametrize(
    "seeds", [range(12), pytest.param(range(12, 200), marks=pytest.mark.long)], ids=str
)
def test_equal_solids_on_each_other_are_not_refused_and_those_that_are_flush_rest(seeds, tmp_path):
    for seed in seeds:
        scenario, turn = drawn_scene(seed, tmp_path)
        q = scenario.run(progress=False, findings=False).q
        places = q[1:, [0, 1, 2, 7, 8, 9]]  # after the step that sets them down
        if turn <= FLAT:
            assert np.abs(places - places[0]).max() <= FLAT, seed

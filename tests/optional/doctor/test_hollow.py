"""A mesh that is not convex, such as a fork: its hull fills what lies between its prongs."""

import numpy as np
import pytest
import trimesh

import quasistatic_ref as qr
from quasistatic_ref.optional.doctor.hollow import encloses, reaches

PARTS = (((0.06, 0.01, 0.02), (0.0, 0.005, 0.0)), ((0.01, 0.05, 0.02), (-0.025, 0.035, 0.0)),
         ((0.01, 0.05, 0.02), (0.025, 0.035, 0.0)))  # fmt: skip
"""Sizes and middles of three boxes that make a fork [m]."""
OUTLINE = np.array([
    (-3, 0), (-2, 0), (2, 0), (3, 0), (3, 1), (3, 6),
    (2, 6), (2, 1), (-2, 1), (-2, 6), (-3, 6), (-3, 1),
]) / 100  # fmt: skip
FLAT = [(0, 1, 11), (1, 8, 11), (1, 2, 8), (2, 7, 8), (2, 3, 7), (3, 4, 7), (4, 5, 7), (5, 6, 7),
        (8, 9, 11), (9, 10, 11)]  # fmt: skip
URDF = """<robot name="f"><link name="w"/><link name="f">{}</link><joint name="y" type="prismatic">
<parent link="w"/><child link="f"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="50" velocity="1"/></joint></robot>"""
SHAPE = '<collision><origin xyz="{} {} {}"/><geometry>{}</geometry></collision>'


def fork():
    """The fork as one closed mesh."""
    corners = np.vstack([np.c_[OUTLINE, np.full(12, z)] for z in (-0.01, 0.01)])
    faces = [t[::-1] for t in FLAT] + [tuple(12 + i for i in t) for t in FLAT]
    for i in range(12):
        j = (i + 1) % 12
        faces += [(i, j, 12 + j), (i, 12 + j, 12 + i)]
    mesh = trimesh.Trimesh(corners, faces)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(sum(np.prod(size) for size, _ in PARTS))
    return mesh


def findings(folder, shapes, xyz, size=(0.03, 0.03, 0.03), hull=True):
    """Findings of a fork that may push a cube."""
    (folder / "fork.urdf").write_text(URDF.format(shapes), "utf-8")
    base = {"urdf": str(folder / "fork.urdf"), "actuated": ["y"], "K_q": {"y": 1000}}
    cube = qr.Body.of_shape("cube", qr.Box(size=size), mass=0.1, xyz=xyz)
    floor = {"alpha": "floor", "beta": "cube", "mu_v": 0.3, "rows": 4, "k": 4}
    return qr.load_scenario({
        "h": 0.02, "steps": 5, "gravity": [0, 0, -9.81],
        "bodies": {"fork": base | {"pose": {"xyz": [0, 0, 0.02]}}, "cube": cube},
        "shapes": {"floor": qr.HalfSpace((0, 0, 1), 0.0)},
        "contacts": {"floor": floor, "push": floor | {"alpha": "fork/f", "hull": hull}},
    }).findings()  # fmt: skip


@pytest.mark.parametrize(
    ("xyz", "size", "alone"),
    [
        ((0, 0.04, 0.015), (0.03, 0.03, 0.03), True),  # free between the prongs
        ((0.004, 0.029, 0.015), (0.03, 0.03, 0.03), True),  # 1 mm from a prong and the base
        ((0.01, 0.04, 0.015), (0.03, 0.03, 0.03), False),  # 5 mm in a prong
        ((0, 0.02, 0.015), (0.03, 0.03, 0.03), False),  # 5 mm in the base
        ((0, 0.005, 0.02), (0.004, 0.004, 0.004), False),  # inside of the base, all of it
    ],
)
def test_the_finding_says_whether_the_mesh_or_its_hull_alone_overlaps(tmp_path, xyz, size, alone):
    fork().export(tmp_path / "fork.stl")
    shapes = SHAPE.format(0, 0, 0, '<mesh filename="fork.stl"/>')
    overlaps = [x for x in findings(tmp_path, shapes, xyz, size) if x.name == "initial-penetration"]
    found = next(x for x in overlaps if "push" in x.cause)
    split = "split the mesh of fork/f#0 into convex parts, each a <collision>"
    assert (found.remedy == split) == alone
    assert ("the mesh itself does not" in found.cause) == alone
    assert found.remedy.endswith("mm farther apart") != alone


def test_a_split_mesh_leaves_the_cube_free(tmp_path):
    shapes = ""
    for k, (size, middle) in enumerate(PARTS):
        trimesh.creation.box(size).export(tmp_path / f"part{k}.stl")
        shapes += SHAPE.format(*middle, f'<mesh filename="part{k}.stl"/>')
    said = findings(tmp_path, shapes, (0, 0.04, 0.015), hull=False)
    assert "initial-penetration" not in {x.name for x in said}


def test_balls_overlap_the_fork_where_they_overlap_one_of_its_boxes():
    surface = fork().triangles
    rng = np.random.default_rng(3)
    depth = 1e-4
    seen = []
    for centre in rng.uniform((-0.05, -0.02, -0.03), (0.05, 0.08, 0.03), (300, 3)):
        radius = rng.uniform(0.002, 0.02)
        boxes = [qr.Box(size=size).signed_distance((centre - middle)[None])[0][0]
                 for size, middle in PARTS]  # fmt: skip
        if abs(min(boxes) + depth - radius) < depth:
            continue  # within what the smallest triangles show
        overlaps = min(boxes) < radius - depth
        assert reaches(surface - centre, qr.Sphere(radius), np.zeros(3), depth) == overlaps
        assert encloses(surface, centre) == (min(boxes) < 0)
        seen.append(overlaps)
    assert 50 < sum(seen) < 250

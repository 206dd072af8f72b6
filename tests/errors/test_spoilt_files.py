"""A spoilt file of each format is accepted, or refused in one sentence."""

import json
import re
import resource
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from quasistatic_ref import (
    Body,
    QuasistaticError,
    System,
    load_scenario,
    load_solution,
    load_step,
    load_trajectory,
    save_step,
    save_trajectory,
    solve_step,
    verify,
)
from quasistatic_ref.lab.vectors.check.answers import answers_read
from quasistatic_ref.lab.vectors.files import answers_written
from tests.errors.scene import scene_written
from tests.files.urdf.urdf_texts import collision, link, robot, urdf_of_text
from tests.made import loaded_mesh, point_cloud, solution_text
from tests.oracles.shape_files import (
    COLLADA,
    PCD_BODY,
    TETRAHEDRON,
    exported,
    pcd,
    plain_gltf,
)
from tests.pages import ROOT

LONGEST = 2000
"""Most characters of a sentence."""
MEMORY = 2 << 30
"""Most bytes that a reader may ask for, by whatever number stands in a header."""
SIZES = Path("/proc/self/statm")
"""Of this process, in pages: the first is its address space."""
TOKEN = re.compile(rb"[-+]?\d[\w.+-]*|[A-Za-z_][\w:.-]*|\"[^\"\n]*\"|[^\w\s]")
OTHERS = (
    *(b"", b"nan", b"inf", b"-1", b"0", b"1e308", b"1e-323", b"9223372036854775808", b'"x"', b"["),
    *(b"{}", b"null", b"..", b"\x00", b"\xff", b"\n", "\u00e9".encode(), b"x" * 1000),
    *(b"a." * 1200 + b"a", b"[" * 1200, b"{a=" * 1200, b'"\\"".' * 1200 + b"a"),
)
"""What stands in the place of a token or of some bytes."""
POINTS = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
    b"property float z\nend_header\n0 0 0\n1 0 0\n"
)


def scene_read(path):
    """A scenario whose files are good."""
    load_scenario(path).simulator()


def robot_read(path):
    """A URDF."""
    System([Body("r", path)])


def mesh_read(path):
    """The corners of a mesh, named by a URDF next to it."""
    mesh = collision(f'<mesh filename="{path.name}"/>')
    System([Body("r", urdf_of_text(path.parent, robot(link("r", mesh)), "mesh.urdf"), "floating")])
    return loaded_mesh(path).corners


def points_read(path):
    """The points of a cloud."""
    return point_cloud(path).points


def read_by_others(path):
    """The points of a mesh or cloud as another reader has them, or a few lines by hand."""
    content = path.read_bytes()
    if path.suffix in (".stl", ".obj", ".off") or path.name == "m.ply":
        scene = trimesh.load_scene(path, process=False, maintain_order=True, skip_materials=True)
        return np.concatenate([
            one.vertices[np.unique(one.faces)] if hasattr(one, "faces") else one.vertices
            for one in scene.dump()
        ])  # fmt: skip
    if path.suffix == ".dae":
        words = re.search(rb"<float_array[^>]*>([^<]*)", content)[1].split()
        return np.array(words, dtype=float).reshape(-1, 3)
    if path.suffix == ".glb":
        json_length, start = int.from_bytes(content[12:16], "little"), content.index(b"BIN\0") + 4
        tree = json.loads(content[20 : 20 + json_length])
        (at,) = (one["bufferView"] for one in tree["accessors"] if one["type"] == "VEC3")
        view = tree["bufferViews"][at]
        return np.frombuffer(content, "<f4", view["byteLength"] // 4,
                             start + view.get("byteOffset", 0)).reshape(-1, 3)  # fmt: skip
    lines = re.split(rb'DATA ascii\n|"?x"?,y,z,.*\n', content)[-1].splitlines()
    lines = [line.partition(b"#")[0].strip() for line in lines]
    rows = [line.split(b"," if b"," in line else None) for line in lines if line]
    first = 1 if path.suffix == ".pcd" else 0
    rows = np.array([[cell or b"nan" for cell in row[first : first + 3]] for row in rows], float)
    return rows[~np.isnan(rows).any(axis=1)]


def step_solved(path):
    """A step."""
    solve_step(load_step(path), "none")


def solution_verified(path):
    """A solution of the step next to it."""
    step = load_step(path.with_name("step.json"))
    verify(load_solution(path, step))


READERS = {
    "scene.toml": scene_read,
    "r.urdf": robot_read,
    "m.obj": mesh_read,
    "m.stl": mesh_read,
    "b.stl": mesh_read,
    "m.off": mesh_read,
    "m.ply": mesh_read,
    "m.gltf": mesh_read,
    "m.glb": mesh_read,
    "m.dae": mesh_read,
    "c.xyz": points_read,
    "c.csv": points_read,
    "c.ply": point_cloud,
    "c.pcd": points_read,
    "c.npy": point_cloud,
    "c.npz": point_cloud,
    "step.json": step_solved,
    "solution.json": solution_verified,
    "run.npz": lambda path: load_trajectory(path).step_data(0),
    "rows.json": lambda path: answers_read(path.parent, "rows"),
}
"""A file of each format, and what reads it."""


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """A folder of good files."""
    folder = tmp_path_factory.mktemp("good")
    scene_written(folder)
    run = load_scenario("sphere_spin", ["steps=1"]).run()
    step = run.step_data(0)
    save_trajectory(folder / "run.npz", run)
    save_step(folder / "step.json", step)
    answers_written(folder, "rows", "mine", {"one": {"A": [[1.0]], "b": [1.0]}})
    for name, save in (("c.npy", np.save), ("c.npz", np.savez)):
        save(folder / name, POINTS)
    contents = {
        "r.urdf": (ROOT / "models/door/door.urdf").read_bytes(),
        "m.obj": TETRAHEDRON.encode(),
        "m.stl": exported("stl_ascii"),
        "b.stl": b"solid".ljust(80) + exported("stl")[80:],
        "m.off": exported("off"),
        "m.ply": exported("ply"),
        "m.gltf": plain_gltf(),
        "m.glb": exported("glb"),
        "m.dae": COLLADA.encode(),
        "c.xyz": b"0 0 0\n1 0 0\n",
        "c.csv": b"x,y,z,blue\n0,0,0,255\n1,0,0,255\n",
        "c.ply": PLY,
        "c.pcd": pcd("ascii", PCD_BODY),
        "solution.json": solution_text(solve_step(step, "none")).encode(),
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    return folder


@pytest.fixture(scope="module")
def bounded(good):
    """Ends with a MemoryError what asks for more than MEMORY, once all good files are made."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    if SIZES.exists():
        taken = int(SIZES.read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (taken + MEMORY, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, before)


def spoilt(content, places, others):
    """A file with a token, or some bytes, replaced at each place, a share of its length."""
    for place, other in zip(places, others, strict=True):
        at = int(place * len(content))
        token = TOKEN.search(content, at)
        begin, end = token.span() if token and place < 0.9 else (at, at + 3)
        content = content[:begin] + other + content[end:]
    return content


def same_points(one, other):
    """Whether two readings span the same box: they may have other orders, and repeat points."""
    return np.allclose(*([np.min(x, axis=0), np.max(x, axis=0)] for x in (one, other)), atol=1e-6)


@pytest.mark.usefixtures("bounded")
@pytest.mark.parametrize("name", READERS)
@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(places=st.lists(st.floats(0, 1), min_size=1, max_size=3), data=st.data())
def test_a_spoilt_file_is_read_as_others_read_it_or_refused_in_a_sentence(good, name, places, data):
    read = READERS[name]
    path = good / name
    content = path.read_bytes()
    whole = read(path)
    others = [data.draw(st.sampled_from(OTHERS)) for _ in places]
    path.write_bytes(spoilt(content, places, others))
    try:
        points = read(path)
        if isinstance(points, np.ndarray) and not same_points(points, whole):
            assert same_points(points, read_by_others(path))
    except QuasistaticError as refusal:
        sentence = str(refusal)
        assert 0 < len(sentence) <= LONGEST
        assert "\n" not in sentence
    finally:
        path.write_bytes(content)

"""Every field of the table of scenarios is read by code: one that nothing reads is no field."""

import tomllib

import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.files.scenario.scenario_table import TABLES
from quasistatic_ref.text.table_reader import TableReader
from tests.errors.scene import SCENE, changed, scene_written
from tests.files.urdf.urdf_texts import link, robot, urdf_of_text

EVERY_FIELD = tomllib.loads("""
cone = "pyramid"
law = "convex"
distances = "closed"
fast = false
record = "full"
roots = []
findings = { ignore = ["artifact"] }
solver = { backend = "clarabel", accuracy = 1e-12, certify = "full" }
[slab]
urdf = "slab.urdf"
base = "planar"
support = { mu_v = 0.5, mu_omega = 0.01 }
pose = { xyz = [0.0, 30.0, 0.0] }
package_dirs = []
[rail]
gravity_compensated = true
joint_friction = { slide = 0.1 }
joint_limits = { slide = [-1.0, 1.0] }
[shapes]
sphere = { radius = 0.1 }
cylinder = { radius = 0.1, length = 0.2 }
cone = { radius = 0.1, length = 0.2 }
ellipsoid = { size = [0.1, 0.2, 0.3] }
mesh = { file = "mesh.obj", scale = [1.0, 1.0, 1.0] }
""")
MESH = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n"


@pytest.fixture
def scene(tmp_path):
    """A file with every field."""
    more = dict(EVERY_FIELD)
    slab, rail, solids = (more.pop(name) for name in ("slab", "rail", "shapes"))
    written = changed(
        SCENE,
        *more.items(),
        ("bodies/slab", slab),
        ("bodies/ball/cloud", "cloud.xyz"),
        ("contacts/floor/k", {"within": "5 mm"}),
        ("contacts/floor/hull", False),
        *((f"bodies/rail/{name}", value) for name, value in rail.items()),
        *((f"shapes/a {kind}", {kind: sizes}) for kind, sizes in solids.items()),
    )
    urdf_of_text(tmp_path, robot(link("slab")), "slab.urdf")
    urdf_of_text(tmp_path, MESH, "mesh.obj")
    return scene_written(tmp_path, written)


def kind_of(where):
    """The kind of table at a dotted name such as ``bodies.ball.wrenches[0]``, if it has one."""
    parts = where.split(".")
    if parts[-1] in TABLES:
        return parts[-1]
    if len(parts) > 1:
        parts[1] = "NAME"
    listed = parts[-1].endswith("]")
    name = ".".join(parts).partition("[")[0]
    names = {"": "the top of the file"}
    return names.get(name, f"[[{name}]]" if listed else f"[{name}]")


def test_every_field_is_read(scene, monkeypatch):
    readers = []
    made = TableReader.__init__

    def noted(reader, *arguments, **more):
        made(reader, *arguments, **more)
        readers.append(reader)

    monkeypatch.setattr(TableReader, "__init__", noted)
    load_scenario(scene)
    file = "quasistatic_ref/files/scenario/scenario_table.py"
    tables = {kind: [r for r in readers if kind_of(r.where) == kind] for kind in TABLES}
    for kind, fields in TABLES.items():
        left = {name for reader in tables[kind] for name in reader.names_left()}
        written = {name for reader in tables[kind] for name in reader.fields}
        for name in fields:
            assert name in written, f"{kind} {name} of {file} is not in this test's scene: add it"
            assert name not in left, f"{kind} {name} of {file} is read by no code: read it"

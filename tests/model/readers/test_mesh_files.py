"""Meshes become convex hulls, from files that are where they may be."""

import io
import os
import re
from zipfile import ZipFile

import numpy as np
import pytest
import trimesh

from quasistatic_ref import Body, ModelError, System
from quasistatic_ref.model.readers.mesh_files import loaded_mesh, mesh_hull, mesh_path
from quasistatic_ref.model.urdf import urdf_shapes
from quasistatic_ref.model.urdf.urdf import loaded_urdf
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from tests.closeness import assert_within
from tests.model.urdf.urdf_texts import collision, link, robot, urdf_of_text
from tests.tolerances import CLOSED_FORM

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
DENTED = TETRAHEDRON.replace("f 2 3 4", "v 0.2 0.2 0.2\nf 2 3 5\nf 3 4 5\nf 4 2 5")


def test_a_mesh_of_a_urdf_is_loaded_scaled_and_noted(tmp_path):
    urdf_of_text(tmp_path, DENTED, "a.obj")
    mesh = '<mesh filename="a.obj" scale="2 2 2"/>'
    urdf = loaded_urdf(urdf_of_text(tmp_path, robot(link("a", collision(mesh)))))
    shape = urdf.shapes[0].shape
    assert isinstance(shape, ConvexMesh)
    assert_within(shape.volume, 8 / 6, 1e-6)
    assert urdf.notes[0] == (
        "a#0: mesh replaced by its convex hull, 4 corners; "
        "it is not convex (by 40 %), so a contact with it must say hull = true"
    )


def test_a_package_address_is_looked_for_in_package_dirs(tmp_path):
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    expected = urdf_of_text(tmp_path / "arm" / "meshes", TETRAHEDRON, "a.obj")
    found = mesh_path("package://arm/meshes/a.obj", tmp_path / "arm", (tmp_path,))
    assert found == expected.resolve()


PLACES = {
    "in the repository": "repo/arm/meshes/a.obj",
    "next to the file": "repo/arm/urdf/arm/meshes/a.obj",
    "in a folder of another name": "repo/meshes/a.obj",
}


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
def test_a_package_address_is_looked_for_above_the_file(tmp_path, place):
    urdf = tmp_path / "repo" / "arm" / "urdf"
    urdf.mkdir(parents=True)
    (tmp_path / "repo" / ".git").mkdir()
    outside = tmp_path / "arm" / "meshes"
    for folder in (outside, (tmp_path / place).parent):
        folder.mkdir(parents=True, exist_ok=True)
        urdf_of_text(folder, TETRAHEDRON, "a.obj")
    assert mesh_path("package://arm/meshes/a.obj", urdf) == (tmp_path / place).resolve()
    (tmp_path / place).unlink()
    with pytest.raises(ModelError, match="no such file"):  # nothing outside of the repository
        mesh_path("package://arm/meshes/a.obj", urdf)


OUTSIDE = {
    "up": ("../secret.obj", "leads to .*, outside the folder of this file"),
    "absolute": ("{root}/secret.obj", "leads to .*, outside the folder of this file"),
    "link": ("link.obj", "leads to .*, outside the folder of this file"),
    "file": ("file:///a.obj", "must be package://NAME/PATH or a relative path"),
    "no package": ("package://arm/b.obj", r"no such file \(looked for in .*home.*--root FOLDER"),
    "missing": ("b.obj", "no such file"),
    "kind": ("a.blend", "is not a known kind of mesh; known: .3mf, .dae, .glb"),
}


@pytest.mark.parametrize(("address", "words"), OUTSIDE.values(), ids=OUTSIDE)
def test_a_mesh_that_is_not_where_it_may_be_is_refused(tmp_path, address, words):
    home = tmp_path / "home"
    home.mkdir()
    secret = urdf_of_text(tmp_path, TETRAHEDRON, "secret.obj")
    (home / "link.obj").symlink_to(secret)
    with pytest.raises(ModelError, match=words):
        mesh_path(address.format(root=tmp_path), home, ())


def test_a_mesh_that_is_too_large_is_refused(tmp_path):
    (tmp_path / "a.stl").touch()
    os.truncate(tmp_path / "a.stl", 17 * 2**20)
    meshes = collision('<mesh filename="a.stl"/>')
    with pytest.raises(ModelError, match="is larger than 16 MiB") as caught:
        loaded_urdf(urdf_of_text(tmp_path, robot(link("a", meshes))))
    assert caught.value.field == "link[a].collision[0].mesh.filename"


COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="s">
<float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="sc"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#sc"/></scene></COLLADA>
"""
# Each of these lost a triangle or a corner without a word, or took memory for what is not there.
MALFORMED = {
    "a letter for an index": ("0 3 2 1", "0 3 x 1"),
    "a fraction": ("0 3 2 1", "0 3 2.5 1"),
    "an index that is not there": ("0 3 2 1", "0 3 99 1"),
    "no XML": ("</COLLADA>", ""),
}


@pytest.mark.parametrize(("right", "wrong"), MALFORMED.values(), ids=MALFORMED)
def test_a_malformed_collada_mesh_is_refused_by_name(tmp_path, right, wrong):
    assert COLLADA.count(right) == 1
    path = urdf_of_text(tmp_path, COLLADA.replace(right, wrong), "a.dae")
    with pytest.raises(ModelError, match=r"a\.dae: cannot be read as a mesh"):
        mesh_hull(path, np.ones(3))


@pytest.mark.parametrize(
    ("asset", "metres"),
    [('<unit name="u" meter="0.001"/>', 0.001), ('<unit name="inch" meter="0.0254"/>', 0.0254)],
)
def test_the_unit_of_a_collada_mesh_is_applied(tmp_path, asset, metres):
    text = COLLADA.replace('<unit name="meter" meter="1"/>', asset)
    for up in ("Z_UP", "Y_UP"):  # which is left as it is
        path = urdf_of_text(tmp_path, text.replace("Z_UP", up), "a.dae")
        hull = mesh_hull(path, np.ones(3))
        assert_within(hull.vertices, metres * CORNERS, 1e-15)


@pytest.mark.parametrize(("unit", "metres"), [("millimeter", 0.001), ("inch", 0.0254)])
def test_the_unit_of_a_3mf_mesh_is_applied(tmp_path, unit, metres):
    file = io.BytesIO(trimesh.creation.box((1, 2, 4)).export(file_type="3mf"))
    path = tmp_path / "a.3mf"
    with ZipFile(file) as written, ZipFile(path, "w") as changed:
        for name in written.namelist():
            text = written.read(name)
            changed.writestr(name, re.sub(rb'unit="\w+"', f'unit="{unit}"'.encode(), text))
    assert_within(mesh_hull(path, np.ones(3)).volume, 8 * metres**3, 1e-12)


CORNERS = np.array([[0, 0, 0], [0, 0, 1], [0, 1, 0], [1, 0, 0]])
"""Of the tetrahedron, sorted."""
TWO = """o a
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1
usemtl red\nf 1 3 2\nf 1 2 4
usemtl blue\nf 1 4 3\nf 2 3 4
o b
v 3 0 0\nv 4 0 0\nv 3 1 0\nv 3 0 1
f 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8
"""


def test_a_hull_is_of_all_vertices_of_all_objects(tmp_path):
    hull = mesh_hull(urdf_of_text(tmp_path, TWO, "a.obj"), np.ones(3))
    corners = {(0, 0, 0), (0, 0, 1), (0, 1, 0), (4, 0, 0), (3, 1, 0), (3, 0, 1)}
    assert {tuple(p) for p in hull.vertices} == corners  # the others are on an edge
    assert not hull.is_convex


def test_two_materials_are_one_convex_mesh(tmp_path):
    path = urdf_of_text(tmp_path, TWO.split("o b")[0], "a.obj")
    hull = mesh_hull(path, np.array([1.0, -2.0, 3.0]))
    assert hull.is_convex
    assert_within(hull.volume, 1 * 2 * 3 / 6, CLOSED_FORM)


def test_two_nodes_of_a_collada_file_stand_where_it_places_them(tmp_path):
    node = '<node><instance_geometry url="#g"/></node>'
    text = COLLADA.replace("</node>\n", f"</node>{node}".replace("<node>", MOVED) + "\n")
    hull = mesh_hull(urdf_of_text(tmp_path, text, "a.dae"), np.ones(3))
    assert_within(hull.vertices.max(axis=0), np.array([4.0, 2.0, 2.0]), CLOSED_FORM)


MOVED = "<node><translate>2 0 0</translate><scale>2 2 2</scale>"
POINTS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.1 0.1 0.1\n"


def test_an_obj_of_points_alone_is_their_hull_and_noted(tmp_path):
    urdf_of_text(tmp_path, POINTS, "a.obj")
    text = robot(link("a", collision('<mesh filename="a.obj"/>')))
    urdf = loaded_urdf(urdf_of_text(tmp_path, text))
    assert_within(urdf.shapes[0].shape.volume, 1 / 6, CLOSED_FORM)
    note = "a#0: a mesh of points alone, whose convex hull is taken, 4 corners"
    assert urdf.notes == (note,)


def test_an_empty_mesh_is_left_out_of_a_urdf_and_noted(tmp_path):
    urdf_of_text(tmp_path, "solid\nendsolid\n", "a.stl")
    text = robot(link("a", collision('<mesh filename="a.stl"/>')))
    urdf = loaded_urdf(urdf_of_text(tmp_path, text))
    assert urdf.shapes == ()
    assert urdf.notes == ("a#0: left out, since a.stl is empty",)
    with pytest.raises(ModelError, match=r"a\.stl: vertices: is empty: the mesh has no vertices"):
        mesh_hull(tmp_path / "a.stl", np.ones(3))


@pytest.mark.parametrize("kind", ["off", "ply", "glb", "stl"])
def test_a_format_is_read_as_trimesh_wrote_it(tmp_path, kind):
    path = tmp_path / f"a.{kind}"
    box = trimesh.creation.box((1, 2, 4))
    path.write_bytes(trimesh.Scene(box).export(file_type=kind) if kind == "glb" else
                     _bytes(box.export(file_type=kind)))  # fmt: skip
    hull = mesh_hull(path, np.ones(3))
    assert_within(hull.volume, 8.0, 1e-6)
    assert hull.is_convex


def _bytes(content):
    return content.encode() if isinstance(content, str) else content


def test_a_mesh_that_is_named_five_times_is_read_once_and_has_one_hull(tmp_path, monkeypatch):
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\n")
    mesh = (
        '<collision><geometry><mesh filename="m.obj" scale="{0} {0} {0}"/></geometry></collision>'
    )
    scales = (1, 1, 1, 1, 1, 2)
    shapes = "".join(map(mesh.format, scales))
    (tmp_path / "m.urdf").write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')
    counts = []
    monkeypatch.setattr(
        urdf_shapes, "loaded_mesh", lambda path: counts.append(path) or loaded_mesh(path)
    )
    *same, larger = System([Body("b", tmp_path / "m.urdf")]).shapes
    assert len(counts) == 1
    assert len({id(placed.shape) for placed in same}) == 1
    assert np.ptp(larger.shape.vertices, axis=0).tolist() == [2, 2, 2]

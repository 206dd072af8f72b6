"""Meshes become convex hulls, from files that are where they may be."""

import os
import re
import sys
import warnings

import numpy as np
import pytest
import trimesh

from quasistatic_ref import Body, InputError, ModelError, System, load_scenario
from quasistatic_ref.files.content import text_written
from quasistatic_ref.files.mesh_files import loaded_mesh, mesh_hull, mesh_path
from quasistatic_ref.files.urdf import shapes as urdf_shapes
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from tests.cases import cases
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import collision, link, loaded_urdf, robot, urdf_of_text
from tests.oracles.shape_files import COLLADA, TETRAHEDRON, bytes_of, exported, plain_gltf
from tests.tolerances import CLOSED_FORM

DENTED = TETRAHEDRON.replace("f 2 3 4", "v 0.2 0.2 0.2\nf 2 3 5\nf 3 4 5\nf 4 2 5")

UNSCALED = np.ones(3)


def urdf_of_mesh(folder, name, more=""):
    """A link whose shape is a mesh next to its file."""
    mesh = collision(f'<mesh filename="{name}"{more}/>')
    return loaded_urdf(urdf_of_text(folder, robot(link("a", mesh))))


def test_a_mesh_of_a_urdf_is_loaded_scaled_and_noted(tmp_path):
    urdf_of_text(tmp_path, DENTED, "a.obj")
    urdf = urdf_of_mesh(tmp_path, "a.obj", ' scale="2 2 2"')
    shape = urdf.shapes[0].shape
    assert isinstance(shape, ConvexMesh)
    assert_within(shape.volume, 8 / 6, 1e-6)
    assert urdf.notes[0] == (
        "a#0: mesh replaced by its convex hull, 4 corners; "
        "it is not convex (by 40 %), so a contact with it must say hull = true"
    )


@pytest.mark.parametrize("scheme", ["package", "model"])
def test_a_package_address_is_looked_for_in_package_dirs(tmp_path, scheme):
    expected = text_written(tmp_path / "arm/meshes/a.obj", TETRAHEDRON)
    found = mesh_path(f"{scheme}://arm/meshes/a.obj", tmp_path / "elsewhere", (tmp_path,))
    assert found == expected.resolve()
    with pytest.raises(ModelError, match=f"no such file .*{scheme}://arm/b.obj"):
        mesh_path(f"{scheme}://arm/b.obj", tmp_path)


@cases("uri", {"relative": "file://a.obj", "absolute": "file://{root}/a.obj"})
def test_a_file_address_is_a_path(tmp_path, uri):
    mesh = text_written(tmp_path / "a.obj", TETRAHEDRON)
    assert mesh_path(uri.format(root=tmp_path), tmp_path) == mesh.resolve()


PLACES = {
    "in the repository": "repo/arm/meshes/a.obj",
    "next to the file": "repo/arm/urdf/arm/meshes/a.obj",
    "in a folder of another name": "repo/meshes/a.obj",
}


@cases("place", PLACES)
def test_a_package_address_is_looked_for_above_the_file(tmp_path, place):
    urdf = tmp_path / "repo/arm/urdf"
    (tmp_path / "repo/.git").mkdir(parents=True)
    for mesh in ("arm/meshes/a.obj", place):
        text_written(tmp_path / mesh, TETRAHEDRON)
    assert mesh_path("package://arm/meshes/a.obj", urdf) == (tmp_path / place).resolve()
    (tmp_path / place).unlink()
    with pytest.raises(ModelError, match="no such file"):  # nothing outside of the repository
        mesh_path("package://arm/meshes/a.obj", urdf)


@pytest.mark.parametrize(("uri", "place", "mark"), [
    ("../meshes/a.obj", "arm/meshes/a.obj", None),
    ("../../meshes/a.obj", "meshes/a.obj", "package.xml"),
    ("../../other/meshes/a.obj", "other/meshes/a.obj", ".git"),
])  # fmt: skip
def test_a_relative_path_leads_anywhere_in_its_package(tmp_path, uri, place, mark):
    urdf = tmp_path / "arm/urdf"
    urdf.mkdir(parents=True)
    mesh = text_written(tmp_path / place, TETRAHEDRON)
    if mark is not None:
        with pytest.raises(ModelError, match="outside the folder of this file"):
            mesh_path(uri, urdf)
        (tmp_path / mark).touch()
    assert mesh_path(uri, urdf) == mesh.resolve()
    with pytest.raises(ModelError, match="outside the folder of this file") as refused:
        mesh_path(uri, urdf, is_of_file=False)
    (root,) = (one for one in mesh.parents if one.name == uri.replace("../", "").split("/")[0])
    assert f"name its folder: --root {root}, or package_dirs" in str(refused.value)


def test_a_link_beside_the_folder_is_no_folder_beside_it(tmp_path):
    text_written(tmp_path / "elsewhere/a.obj", TETRAHEDRON)
    (tmp_path / "arm/urdf").mkdir(parents=True)
    (tmp_path / "arm/meshes").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(ModelError, match="outside the folder of this file"):
        mesh_path("../meshes/a.obj", tmp_path / "arm/urdf")


def test_a_relative_path_leads_anywhere_in_the_folder_of_its_scenario(tmp_path):
    urdf_of_text(tmp_path, TETRAHEDRON, "a.obj")
    mesh = collision('<mesh filename="../../a.obj"/>')
    text_written(tmp_path / "robots/urdf/r.urdf", robot(link("a", mesh)))
    scene = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
    scene += '[bodies.r]\nurdf = "robots/urdf/r.urdf"\nbase = "floating"\n'
    (shape,) = load_scenario(urdf_of_text(tmp_path, scene, "s.toml")).system.shapes
    assert_within(shape.shape.volume, 1 / 6, CLOSED_FORM)


def test_a_mesh_of_a_scenario_itself_lies_in_its_folder(tmp_path):
    text_written(tmp_path / "robots/a.obj", TETRAHEDRON)
    scene = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
    scene += '[bodies.r]\nurdf = "r.urdf"\n[shapes.m]\nmesh = { file = "../robots/a.obj" }\n'
    text_written(tmp_path / "scenes/r.urdf", robot(link("a")))
    with pytest.raises(ModelError, match=r"m\.mesh\.file: leads to .*, outside the folder of"):
        load_scenario(urdf_of_text(tmp_path / "scenes", scene, "s.toml"))


OUTSIDE = {
    "up": ("../secret.obj", "leads to .*, outside the folder of this file"),
    "absolute": ("{root}/secret.obj", "leads to .*, outside the folder of this file"),
    "link": ("link.obj", "leads to .*, outside the folder of this file"),
    "a file anywhere": ("file://{root}/secret.obj", "leads to .*, outside the folder of this file"),
    "on the web": ("https://host/a.obj", "must be package://NAME/PATH, model://NAME/PATH or a rel"),
    "twice": (
        "file://https://host/a.obj",
        "must be package://NAME/PATH, model://NAME/PATH or a rel",
    ),
    "no package": ("package://arm/b.obj", r"no such file \(looked for in .*home.*--root FOLDER"),
    "missing": ("file://b.obj", "no such file .*home; put the mesh there, or write its path"),
    "kind": ("a.blend", "is not a known kind of mesh; known: .dae, .glb"),
}


@cases("address, words", OUTSIDE)
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
    with pytest.raises(ModelError, match="is larger than 16 MiB") as caught:
        urdf_of_mesh(tmp_path, "a.stl")
    assert caught.value.field == "link[a].collision[0].mesh.filename"


# Each of these lost a triangle or a corner without a word, or took memory for what is not there.
MALFORMED = {
    "a letter for an index": ("0 3 2 1", "0 3 x 1"),
    "a fraction": ("0 3 2 1", "0 3 2.5 1"),
    "an index that is not there": ("0 3 2 1", "0 3 99 1"),
    "another count": ('count="12"', 'count="15"'),
    "another number of triangles": ('<triangles count="4">', '<triangles count="5">'),
    "a part that is not there": ('url="#g"', 'url="#h"'),
    "NaN, which pycollada takes for 0": ("0 0 0 1 0 0", "0 0 nan 1 0 0"),
    "no XML": ("</COLLADA>", ""),
}


@cases("right, wrong", MALFORMED)
def test_a_malformed_collada_mesh_is_refused_by_name(tmp_path, right, wrong):
    assert COLLADA.count(right) == 1
    path = urdf_of_text(tmp_path, COLLADA.replace(right, wrong), "a.dae")
    with pytest.raises(ModelError, match=r"a\.dae: "):
        mesh_hull(path, UNSCALED)


@pytest.mark.parametrize(
    ("asset", "metres"),
    [('<unit name="u" meter="0.001"/>', 0.001), ('<unit name="inch" meter="0.0254"/>', 0.0254)],
)
def test_the_unit_of_a_collada_mesh_is_applied(tmp_path, asset, metres):
    text = COLLADA.replace('<unit name="meter" meter="1"/>', asset)
    for up in ("Z_UP", "Y_UP"):  # which is left as it is
        path = urdf_of_text(tmp_path, text.replace("Z_UP", up), "a.dae")
        hull = mesh_hull(path, UNSCALED)
        assert_within(hull.vertices, metres * CORNERS, 1e-15)


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
    hull = mesh_hull(urdf_of_text(tmp_path, TWO, "a.obj"), UNSCALED)
    corners = {(0, 0, 0), (0, 0, 1), (0, 1, 0), (4, 0, 0), (3, 1, 0), (3, 0, 1)}
    assert {tuple(p) for p in hull.vertices} == corners  # the others are on an edge
    assert not hull.is_convex


def test_two_materials_are_one_convex_mesh(tmp_path):
    path = urdf_of_text(tmp_path, TWO.split("o b")[0], "a.obj")
    hull = mesh_hull(path, np.array([1.0, -2.0, 3.0]))
    assert hull.is_convex
    assert_within(hull.volume, 1 * 2 * 3 / 6, CLOSED_FORM)


def test_two_nodes_of_a_collada_file_stand_where_it_places_them(tmp_path):
    text = COLLADA.replace("</node>\n", f"</node>{MOVED}\n")
    hull = mesh_hull(urdf_of_text(tmp_path, text, "a.dae"), UNSCALED)
    assert_within(hull.vertices.max(axis=0), np.array([4.0, 2.0, 2.0]), CLOSED_FORM)


MOVED = '<node><translate>2 0 0</translate><scale>2 2 2</scale><instance_geometry url="#g"/></node>'
POINTS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.1 0.1 0.1\n"


def test_an_obj_of_points_alone_is_their_hull_and_noted(tmp_path):
    urdf_of_text(tmp_path, POINTS, "a.obj")
    urdf = urdf_of_mesh(tmp_path, "a.obj")
    assert_within(urdf.shapes[0].shape.volume, 1 / 6, CLOSED_FORM)
    note = "a#0: a mesh of points alone, whose convex hull is taken, 4 corners"
    assert urdf.notes == (note,)


def test_an_empty_mesh_is_left_out_of_a_urdf_and_noted(tmp_path):
    urdf_of_text(tmp_path, "solid\nendsolid\n", "a.stl")
    urdf = urdf_of_mesh(tmp_path, "a.stl")
    assert urdf.shapes == ()
    assert urdf.notes == ("a#0: left out, since a.stl is empty",)
    with pytest.raises(ModelError, match=r"a\.stl: vertices: is empty: the mesh has no vertices"):
        mesh_hull(tmp_path / "a.stl", UNSCALED)


@pytest.mark.parametrize("kind", ["off", "ply", "glb", "stl"])
def test_a_format_is_read_as_trimesh_wrote_it(tmp_path, kind):
    path = tmp_path / f"a.{kind}"
    path.write_bytes(exported(kind))
    hull = mesh_hull(path, UNSCALED)
    assert_within(hull.volume, 8.0, 1e-6)
    assert hull.is_convex


def test_a_mesh_that_is_named_five_times_is_read_once_and_has_one_hull(tmp_path, monkeypatch):
    urdf_of_text(tmp_path, TETRAHEDRON, "m.obj")
    mesh = collision('<mesh filename="m.obj" scale="{0} {0} {0}"/>')
    shapes = "".join(map(mesh.format, (1, 1, 1, 1, 1, 2)))
    path = urdf_of_text(tmp_path, robot(link("a", shapes)))
    counts = []
    monkeypatch.setattr(
        urdf_shapes, "loaded_mesh", lambda path: counts.append(path) or loaded_mesh(path)
    )
    *same, larger = System([Body("b", path)]).shapes
    assert len(counts) == 1
    assert len({id(placed.shape) for placed in same}) == 1
    assert np.ptp(larger.shape.vertices, axis=0).tolist() == [2, 2, 2]


def gltf_at(uri):
    """The same, whose buffer is elsewhere."""
    return plain_gltf(buffers=[{"uri": uri, "byteLength": 72}])


PLACED = '<instance_geometry url="#g"/>'
STL = exported("stl_ascii")
OFF = exported("off")
PLY = exported("ply")
PLY_TEXT = b"""ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
end_header
0 0 0
1 0 0
0 1 0
0 0 1
"""
FACE = PLY_TEXT.replace(
    b"end_header", b"element face 1\nproperty list uchar int vertex_indices\nend_header"
)
LIES = {
    "text for JSON": ("a.gltf", b"", "cannot be read as a mesh: it is malformed"),
    "a pipe": ("a.gltf", gltf_at("pipe"), "a pipe, not"),
    "a file elsewhere": ("a.gltf", gltf_at("../x"),
                         "must be a file in the folder of this one"),
    "a short buffer": ("a.gltf", gltf_at("data:,"),
                       r"buffers\[0\]: must be 72, as the file states \(got 0\)"),
    "long buffers": ("a.gltf", plain_gltf(buffers=5 * [{"uri": "zeros", "byteLength": 2**24}]),
                     "unpacks to more than 64 MiB"),
    "a view beyond its buffer": ("a.gltf", plain_gltf(
        bufferViews=[{"buffer": 0, "byteLength": 99}]), r"Views\[0\]: is not within its buffer"),
    "an array beyond its view": ("a.gltf", plain_gltf().replace(b'"count": 4', b'"count": 5'),
                                 r"accessors\[0\]: is not within bufferViews\[0\]"),
    "zeros without bytes": ("a.gltf", plain_gltf().replace(b'"bufferView": 0, ', b""),
                            "is compressed, sparse or normalized"),
    "a node in itself": ("a.gltf", plain_gltf(nodes=[{"mesh": 0, "children": [0]}]), "one place"),
    "a fan": ("a.gltf", plain_gltf().replace(b'"indices": 1', b'"indices": 1, "mode": 6'), "a fan"),
    "a GLB cut off": ("a.glb", exported("glb")[:-4], "bytes: must be"),
    "a solid cut off": ("a.stl", STL + STL[: STL.rindex(b"outer")], "is cut off or not in"),
    "a solid without its end": ("a.stl", STL.replace(b"endsolid", b""), "is cut off or not in"),
    "a binary STL cut off": ("a.stl", exported("stl")[:-1], "must begin with solid, or hold 50"),
    "a word of its own": ("a.stl", STL.replace(b"endloop", b"color", 1), "line 7: must begin with"),
    "fewer faces": ("a.off", OFF[:-10], "line 2: must be the number of points and of faces"),
    "a face cut short": ("a.off", OFF.rstrip()[:-1] + b"\n", "line 22: must have 3 corners"),
    "a face of one": ("a.obj", TETRAHEDRON + "f 1\n", "line 9: must be a face of three corners"),
    "a corner too many": ("a.obj", TETRAHEDRON + "f 1 2 9\n", "triangles: must be numbers of ver"),
    "a line that is none": ("a.obj", TETRAHEDRON + "x 1 2\n", "line 9: is a line of an OBJ that"),
    "a binary PLY cut off": ("a.ply", PLY[:-1], r"face\[11\].vertex_indices: must be 3.*got 2"),
    "faces without corners": ("a.ply", PLY.replace(b"_indices", b"_numbers"), "must be faces with"),
    "an empty face": ("a.ply", FACE + b"0\n", r"face\[0\]: must be a face of three corners"),
    "two lines for a point": ("a.ply", PLY_TEXT.replace(b"0 0 1", b"0 0\n1"), "lines: must be 4"),
    "a list of half a corner more": ("a.ply", FACE + b"3.5 0 1 2\n",
                                     r"face\[0\].vertex_indices: must have a whole number of"),
    "half a corner": ("a.ply", FACE + b"3 0 1.5 2\n",
                      "face: must be whole numbers"),
    "no such mesh": ("a.gltf", plain_gltf(nodes=[{"mesh": 1}]), r"nodes: is placed.*'meshes\[1\]'"),
    "nothing placed": ("a.gltf", plain_gltf(nodes=[{}]), "places none of the triangles that it"),
    "a longer PLY": ("a.ply", PLY + b"x", "holds more than its header says"),
    "very many parts": ("a.dae", COLLADA.replace(PLACED, 10_000 * PLACED),
                        "places more than 5000000 vertices and triangles"),
    "an unknown extension": ("a.gltf", plain_gltf(extensionsRequired=["ACME_bent"]),
                             "extensionsRequired: is an extension that is not read.*ACME_bent"),
    "instances": ("a.gltf", plain_gltf(extensionsRequired=["EXT_mesh_gpu_instancing"]),
                  "extensionsRequired: is an extension .*'EXT_mesh_gpu_instancing'"),
    "meshopt": ("a.gltf", plain_gltf(bufferViews=[{"extensions": {"EXT_meshopt_compression": {}}}]),
                r"bufferViews\[0\]: is compressed by EXT_meshopt_compression; export it without"),
    "a buffer that only meshopt fills": (
        "a.gltf", plain_gltf(buffers=[{"extensions": {"EXT_meshopt_compression": {}}}]),
        r"buffers\[0\]: is compressed by EXT_meshopt_compression"),
    "weights of a mesh": ("a.gltf", plain_gltf(meshes=[{"primitives": [], "weights": [0, 1.0]}]),
                          r"meshes\[0\].weights: are of morph targets and not 0"),
    "weights of a node": ("a.gltf", plain_gltf(nodes=[{"mesh": 0, "weights": [0.5]}]),
                          r"nodes\[0\].weights: are of morph targets and not 0"),
    "a skew": ("a.dae", COLLADA.replace("<node>", '<node id="n"><skew>45 1 0 0 0 1 0</skew>'),
               r"node\[n\]: has a skew, which is not read"),
    "far away": ("a.obj", TETRAHEDRON.replace("1 0 0", "1e200 0 0"), "must be at most 1e.15 m"),
}  # fmt: skip


@cases("name, content, words", LIES)
def test_the_statements_of_a_mesh_file_are_compared_with_its_content(
    tmp_path, name, content, words
):
    """Next to it lie a pipe, 16 MiB and a glTF of another shape."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "zeros").touch()
    os.truncate(tmp_path / "zeros", 2**24)
    for other, part in trimesh.creation.box().export(file_type="gltf").items():
        (tmp_path / other).write_bytes(part)
    (tmp_path / name).write_bytes(bytes_of(content))
    with pytest.raises(ModelError, match=f"^{re.escape(str(tmp_path))}/.*{words}"):
        loaded_mesh(tmp_path / name)


SAME = {
    "a Latin-1 letter in OBJ": ("a.obj", b"# K\xf6rper\n" + TETRAHEDRON.encode()),
    "three dots of Windows": ("a.obj", b"o a\x85b\n" + TETRAHEDRON.encode()),
    "a Latin-1 name in STL": ("a.stl", b"solid K\xf6rper\n" + STL.partition(b"\n")[2]),
    "a Latin-1 comment in OFF": ("a.off", b"OFF # K\xf6rper\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1"),
    "counts in the line of OFF": ("a.off", b"OFF4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"),
    "a Latin-1 name in COLLADA": ("a.dae", COLLADA.replace('id="sc"', 'id="sc" name="\xf6"')
                                  .encode("latin-1")),
    "a header that begins with solid": ("a.stl", b"solid".ljust(80) + exported("stl")[80:]),
    "a material that is not there": ("a.dae", COLLADA.replace(
        '<instance_geometry url="#g"/>', '<instance_geometry url="#g"><bind_material>'
        '<technique_common><instance_material symbol="m" target="#none"/></technique_common>'
        "</bind_material></instance_geometry>")),
    "a line as a face": ("a.obj", TETRAHEDRON + "f 1 2\n"),
    "back from the last point": ("a.obj", TETRAHEDRON.replace("f 2 3 4", "f -3 -2 -1")),
}  # fmt: skip


@cases("name, content", SAME)
def test_a_whole_mesh_file_is_read(tmp_path, name, content):
    (tmp_path / name).write_bytes(bytes_of(content))
    vertices = loaded_mesh(tmp_path / name).vertices
    extent = np.ptp(vertices, axis=0)
    assert extent.tolist() in ([1, 1, 1], [1, 2, 4], [0.001, 0.002, 0.004])


def test_a_vertex_that_no_triangle_uses_is_in_no_hull(tmp_path):
    """Nor one of a line, nor in glTF; and the y axis of glTF is said to be up."""
    for stray in ("v 0 0 9\n", "v 0 0 9\nl 1 5\n"):
        path = urdf_of_text(tmp_path, TETRAHEDRON + stray, "a.obj")
        assert_within(mesh_hull(path, UNSCALED).volume, 1 / 6, CLOSED_FORM)
        (note,) = urdf_of_mesh(tmp_path, "a.obj").notes
        assert note.endswith("4 corners; vertices that no triangle uses are left out: 1")
    (tmp_path / "a.gltf").write_bytes(plain_gltf())
    (note,) = urdf_of_mesh(tmp_path, "a.gltf").notes
    assert "its y axis is up; it is not turned, rpy = [1.5708, 0, 0]" in note


LOOKS = {
    "asset": {"version": "2.0"},
    "extensionsUsed": ["KHR_materials_unlit", "ACME_bent"],
    "extensionsRequired": ["KHR_materials_unlit", "KHR_texture_transform"],
}
NOTED = {
    "looks alone": ("a.gltf", plain_gltf(**LOOKS), "its y axis is up; it is not turned, rpy"),
    "weights of 0": ("a.gltf", plain_gltf(nodes=[{"mesh": 0, "weights": [0, 0.0]}]), "y axis"),
    "instances that are not required": (
        "a.gltf", plain_gltf(nodes=[{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {}}}]),
        "instances by EXT_mesh_gpu_instancing are left out",
    ),
    "a skin": ("a.gltf", plain_gltf(nodes=[{"mesh": 0, "skin": 0}]), "its skin is not applied"),
    "x up": ("a.dae", COLLADA.replace("Z_UP", "X_UP"), "x axis is up; .* rpy = [0, -1.5708, 0]"),
}  # fmt: skip


@cases("name, content, words", NOTED)
def test_a_mesh_file_that_is_read_otherwise_than_meant_is_noted(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(bytes_of(content))
    mesh = loaded_mesh(tmp_path / name)
    assert len(mesh.triangles) == 4
    assert re.search(words.replace("[", r"\["), mesh.note)


@pytest.mark.parametrize(("name", "package"), [("a.dae", "collada")])
def test_a_format_names_the_extra_that_it_needs(tmp_path, monkeypatch, name, package):
    (tmp_path / name).write_bytes(b"")
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError, match=rf"needs {package}: pip install 'quasistatic-ref\["):
        loaded_mesh(tmp_path / name)


@pytest.mark.parametrize("failure", [MemoryError, ImportError, KeyboardInterrupt, OSError])
def test_an_error_that_says_nothing_of_the_file_does_not_call_it_malformed(
    tmp_path, monkeypatch, failure
):
    """Nor what a library warns of: that its own code is old."""
    (tmp_path / "a.gltf").write_bytes(plain_gltf())
    load = trimesh.load_scene
    monkeypatch.setattr(
        trimesh, "load_scene", lambda *a, **k: warnings.warn("old", stacklevel=1) or load(*a, **k)
    )
    assert len(loaded_mesh(tmp_path / "a.gltf").triangles) == 4
    monkeypatch.setattr(trimesh, "load_scene", lambda *_, **__: (_ for _ in ()).throw(failure()))
    with pytest.raises(failure):
        loaded_mesh(tmp_path / "a.gltf")

"""Meshes become convex hulls, from files that are where they may be."""

import os
import re
import shlex
import sys
import warnings

import numpy as np
import pytest
import trimesh

from quasistatic_ref import Body, InputError, ModelError, System, load_scenario
from quasistatic_ref.files.urdf import shapes as urdf_shapes
from tests.cases import cases
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import collision, link, loaded_urdf, robot, urdf_of_text
from tests.made import loaded_mesh, mesh_hull, mesh_path, text_written
from tests.oracles.shape_files import COLLADA, TETRAHEDRON, bytes_of, plain_gltf
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


FOUND = {
    # name: address, the mesh and a file that marks a package, both in the folder above two others
    "file": ("file://a.obj", "arm/urdf/a.obj", "no_mark"),
    "file anywhere below": ("file://{}/arm/urdf/a.obj", "arm/urdf/a.obj", "no_mark"),
    "package in the repository": ("package://arm/meshes/a.obj", "arm/meshes/a.obj", ".git"),
    "package next to the file": ("package://arm/meshes/a.obj", "arm/urdf/arm/meshes/a.obj", ".git"),
    "package of another name": ("package://arm/meshes/a.obj", "meshes/a.obj", ".git"),
    "package that the folder above is": (
        "package://arm/meshes/a.obj",
        "arm/meshes/a.obj",
        "no_mark",
    ),
    "package beside the file": ("model://meshes/a.obj", "arm/meshes/a.obj", "no_mark"),
    "package beside the package": (
        "package://hand/meshes/a.obj",
        "hand/meshes/a.obj",
        "arm/package.xml",
    ),
    "path from the folder above": ("meshes/a.obj", "arm/meshes/a.obj", "no_mark"),
    "path from the folder above, on": ("meshes/b/a.obj", "arm/meshes/b/a.obj", "no_mark"),
    "path beside": ("../meshes/a.obj", "arm/meshes/a.obj", "no_mark"),
    "path in the package": ("../../meshes/a.obj", "meshes/a.obj", "package.xml"),
    "path in the repository": ("../../other/meshes/a.obj", "other/meshes/a.obj", ".git"),
}


@cases("address, place, mark", FOUND)
def test_a_mesh_is_looked_for_in_its_package_and_not_above(tmp_path, address, place, mark):
    text_written(tmp_path / "arm/meshes/a.obj", TETRAHEDRON)
    top = tmp_path / "top"
    mesh = text_written(top / place, TETRAHEDRON)
    text_written(top / "arm/urdf" / "arm.urdf", "")
    text_written(top / mark, "")
    address = address.format(top)
    assert mesh_path(address, top / "arm/urdf") == mesh.resolve()
    mesh.unlink()
    with pytest.raises(ModelError, match=r"no such file|outside the folder"):
        mesh_path(address, top / "arm/urdf")


ROOTS = {
    "../meshes/a.obj": "arm/meshes",
    "../../meshes/a.obj": "meshes",
    "../../other/meshes/a.obj": "other",
}


@pytest.mark.parametrize("address", ROOTS)
def test_a_relative_path_in_a_text_leads_out_of_no_folder_and_the_option_is_named(
    tmp_path, address
):
    folder = text_written(tmp_path / "arm/urdf/arm.urdf", "").parent
    text_written(folder / address, TETRAHEDRON)
    root = shlex.quote(str(tmp_path / ROOTS[address]))
    remedy = f"name its folder: --root {root}, or package_dirs"
    with pytest.raises(ModelError, match=f"outside the folder of this file .*{re.escape(remedy)}"):
        mesh_path(address, folder, is_of_file=False)


def test_a_relative_path_leads_anywhere_in_the_folder_of_its_scenario(tmp_path):
    urdf_of_text(tmp_path, TETRAHEDRON, "a.obj")
    mesh = collision('<mesh filename="../../a.obj"/>')
    text_written(tmp_path / "robots/urdf/r.urdf", robot(link("a", mesh)))
    scene = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
    scene += '[bodies.r]\nurdf = "robots/urdf/r.urdf"\nbase = "floating"\n'
    (shape,) = load_scenario(urdf_of_text(tmp_path, scene, "s.toml")).system.shapes
    assert_within(shape.shape.volume, 1 / 6, CLOSED_FORM)


LEADS = "leads to .*, outside the folder of this file"
PACKAGE = "must be package://NAME/PATH, model://NAME/PATH or a rel"
OUTSIDE = {
    "../../secret.obj": LEADS,
    "{}/secret.obj": LEADS,
    "file://{}/secret.obj": LEADS,
    "link.obj": LEADS,
    "../linked/secret.obj": LEADS,
    "../../above/a.obj": LEADS,
    "a.obj": LEADS,
    "linked/secret.obj": LEADS,
    "meshes/../../secret.obj": LEADS,
    "package://above/a.obj": LEADS,
    "package://arm/../secret.obj": LEADS,
    "package://arm/link.obj": LEADS,
    "package://linked/secret.obj": LEADS,
    "package://secret.obj": LEADS,
    "model:///{}/secret.obj": LEADS,
    "model://./link.obj": LEADS,
    "model://../../secret.obj": LEADS,
    "https://host/a.obj": PACKAGE,
    "file://https://host/a.obj": PACKAGE,
    "package://arm/b.obj": r"no such file \(looked for in .*urdf.*--root FOLDER",
    "file://b.obj": "no such file .*urdf; put the mesh there, or write its path",
    "a.blend": "is not a known kind of mesh; known: .dae, .glb",
}


@pytest.mark.parametrize("address", OUTSIDE)
def test_a_mesh_that_is_not_where_it_may_be_is_refused(tmp_path, address):
    """Nor is a folder beside that of the file where a link leads out of both."""
    secret = urdf_of_text(tmp_path, TETRAHEDRON, "secret.obj")
    text_written(tmp_path / "above/a.obj", TETRAHEDRON)
    text_written(tmp_path / "arm/a.obj", TETRAHEDRON)
    text_written(tmp_path / "arm/meshes/b.obj", TETRAHEDRON)
    (tmp_path / "arm/link.obj").symlink_to(secret)
    folder = text_written(tmp_path / "arm/urdf/arm.urdf", "").parent
    (folder / "link.obj").symlink_to(secret)
    (tmp_path / "arm/linked").symlink_to(tmp_path)
    with pytest.raises(ModelError, match=OUTSIDE[address]):
        mesh_path(address.format(tmp_path), folder)


def test_a_mesh_that_is_too_large_is_refused(tmp_path):
    (tmp_path / "a.stl").touch()
    os.truncate(tmp_path / "a.stl", 17 * 2**20)
    with pytest.raises(ModelError, match="is larger than 16 MiB") as caught:
        urdf_of_mesh(tmp_path, "a.stl")
    assert caught.value.field == "link[a].collision[0].mesh.filename"


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
    "looks alone.gltf": (plain_gltf(**LOOKS), "its y axis is up; it is not turned, rpy"),
    "weights of 0.gltf": (plain_gltf(nodes=[{"mesh": 0, "weights": [0, 0.0]}]), "y axis"),
    "instances that are not required.gltf": (
        plain_gltf(nodes=[{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {}}}]),
        "instances by EXT_mesh_gpu_instancing are left out",
    ),
    "a skin.gltf": (plain_gltf(nodes=[{"mesh": 0, "skin": 0}]), "its skin is not applied"),
    "x up.dae": (COLLADA.replace("Z_UP", "X_UP"), r"x axis is up; .* rpy = \[0, -1.5708, 0]"),
}


@pytest.mark.parametrize("name", NOTED)
def test_a_mesh_file_that_is_read_otherwise_than_meant_is_noted(tmp_path, name):
    content, words = NOTED[name]
    (tmp_path / name).write_bytes(bytes_of(content))
    mesh = loaded_mesh(tmp_path / name)
    assert len(mesh.triangles) == 4
    assert re.search(words, mesh.note)


def test_a_format_names_the_extra_that_it_needs(tmp_path, monkeypatch):
    (tmp_path / "a.dae").touch()
    monkeypatch.setitem(sys.modules, "collada", None)
    with pytest.raises(InputError, match=r"needs collada: pip install 'quasistatic-ref\["):
        loaded_mesh(tmp_path / "a.dae")


@pytest.mark.parametrize("failure", [MemoryError, ImportError, KeyboardInterrupt, OSError])
def test_a_file_is_not_malformed_for_an_error_that_is_not_of_it(tmp_path, monkeypatch, failure):
    """Nor for what a library warns of: that its own code is old."""
    (tmp_path / "a.gltf").write_bytes(plain_gltf())
    load = trimesh.load_scene
    monkeypatch.setattr(
        trimesh, "load_scene", lambda *a, **k: warnings.warn("old", stacklevel=1) or load(*a, **k)
    )
    assert len(loaded_mesh(tmp_path / "a.gltf").triangles) == 4
    monkeypatch.setattr(trimesh, "load_scene", lambda *_, **__: (_ for _ in ()).throw(failure()))
    with pytest.raises(failure):
        loaded_mesh(tmp_path / "a.gltf")

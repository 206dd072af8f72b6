"""Meshes become convex hulls, from files that are where they may be."""

import os
from types import SimpleNamespace

import coal
import numpy as np
import pytest

from quasistatic_ref import ModelError
from quasistatic_ref.model.readers.mesh_files import mesh_hull, mesh_path
from quasistatic_ref.model.urdf.urdf import loaded_urdf
from quasistatic_ref.optional.readers.dae import check_dae
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from tests.closeness import assert_within
from tests.model.urdf.urdf_texts import collision, link, robot, urdf_of_text
from tests.tolerances import CLOSED_FORM

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
DENTED = TETRAHEDRON.replace("f 2 3 4", "v 0.2 0.2 0.2\nf 2 3 5\nf 3 4 5\nf 4 2 5")


def test_a_convex_mesh_is_its_hull(tmp_path):
    hull = mesh_hull(urdf_of_text(tmp_path, TETRAHEDRON, "a.obj"), np.array([1.0, -2.0, 3.0]))
    assert_within(hull.volume, 1 * 2 * 3 / 6, CLOSED_FORM)
    assert hull.is_convex
    assert len(hull.vertices) == len(hull.triangles) == 4


def test_a_dented_mesh_knows_by_how_much(tmp_path):
    hull = mesh_hull(urdf_of_text(tmp_path, DENTED, "a.obj"), np.ones(3))
    # The dent is the tetrahedron over the outer face whose tip is at (0.2, 0.2, 0.2): with
    # x + y + z = 0.6 there instead of 1, it holds 0.4 of the volume.
    assert_within(hull.excess, 0.4, 1e-6)
    assert not hull.is_convex


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


def test_a_mesh_may_be_as_large_as_the_largest(tmp_path, monkeypatch):
    urdf_of_text(tmp_path, TETRAHEDRON, "a.obj")
    size = (tmp_path / "a.obj").stat().st_size
    for most in (size, size - 1):
        monkeypatch.setattr("quasistatic_ref.model.readers.mesh_files.LARGEST_MESH", most)
        if most == size:
            assert mesh_path("a.obj", tmp_path, ()).stat().st_size == size
    with pytest.raises(ModelError, match="is larger than"):
        mesh_path("a.obj", tmp_path, ())


def test_a_package_address_is_looked_for_in_package_dirs(tmp_path):
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    expected = urdf_of_text(tmp_path / "arm" / "meshes", TETRAHEDRON, "a.obj")
    found = mesh_path("package://arm/meshes/a.obj", tmp_path / "arm", (tmp_path,))
    assert found == expected.resolve()


OUTSIDE = {
    "up": ("../secret.obj", "leads to .*, outside the folder of this file"),
    "absolute": ("{root}/secret.obj", "leads to .*, outside the folder of this file"),
    "link": ("link.obj", "leads to .*, outside the folder of this file"),
    "file": ("file:///a.obj", "must be package://NAME/PATH or a relative path"),
    "no package": ("package://arm/a.obj", r"needs package_dirs \(--root FOLDER\), which contain"),
    "missing": ("b.obj", "no such file"),
    "kind": ("a.blend", "is not a known kind of mesh; known: .dae, .obj, .stl"),
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
# Each of these took all of the memory, or lost a triangle without a word.
HOSTILE = {
    "a letter for an index": ("0 3 2 1", "0 3 x 1", r"<p>: must be a whole number.*\(got 'x'\)"),
    "a fraction": ("0 3 2 1", "0 3 2.5 1", "<p>: must be a whole number"),
    "a negative index": ("0 3 2 1", "0 3 -1 1", "<p>: must be a whole number"),
    "an index of 33 bits": ("0 3 2 1", "0 3 4294967296 1", "<p>: is larger than 2147483647"),
    "triangles that are not there": ('"4"><input', '"4000000000"><input', "<triangles count>"),
    "numbers that are not there": ('count="12"', 'count="4000000000"', "<float_array count>"),
    "an offset": ('offset="0"', 'offset="4000000000"', "<input offset>: is larger than"),
    "a bomb": ("<COLLADA", "<!DOCTYPE a [<!ENTITY b 'c'>]><COLLADA", "DOCTYPE is not allowed"),
}


def test_a_collada_mesh_is_loaded(tmp_path):
    urdf_of_text(tmp_path, COLLADA, "a.dae")
    hull = mesh_hull(mesh_path("a.dae", tmp_path, ()), np.ones(3))
    assert len(hull.vertices) == len(hull.triangles) == 4
    assert_within(hull.volume, 1 / 6, CLOSED_FORM)


def test_an_index_may_be_the_largest_of_31_bits(tmp_path):
    check_dae(urdf_of_text(tmp_path, "<mesh><p>2147483647</p></mesh>", "a.dae"))


@pytest.mark.parametrize(("right", "wrong", "words"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_collada_mesh_is_refused_before_it_is_loaded(tmp_path, right, wrong, words):
    assert COLLADA.count(right) == 1
    urdf_of_text(tmp_path, COLLADA.replace(right, wrong), "a.dae")
    with pytest.raises(ModelError, match=words) as caught:
        mesh_path("a.dae", tmp_path, ())
    assert "a.dae" in str(caught.value)


def test_an_unreadable_mesh_is_named_without_places_in_a_library(tmp_path):
    urdf_of_text(tmp_path, "solid\nendsolid\n", "a.stl")
    body = urdf_of_text(tmp_path, robot(link("a", collision('<mesh filename="a.stl"/>'))))
    with pytest.raises(ModelError, match=r"a\.stl") as caught:
        loaded_urdf(body)
    assert "line" not in str(caught.value)
    assert "function" not in str(caught.value)


LIBRARY = {
    "places, reason, hint": "From file: /a.cpp\nat line: 9\nFile is empty\nHint: look elsewhere\n",
    "reason and hint": "File is empty\nHint: look elsewhere",
    "one line": "File is empty",
    "one line and an empty one": "File is empty\n\n",
}
"""What a mesh library says of an empty file; coal's own words have the form of the first."""


@pytest.mark.parametrize("said", LIBRARY.values(), ids=LIBRARY)
def test_the_reason_of_a_mesh_library_is_the_line_before_its_hint(tmp_path, monkeypatch, said):
    def load(*_):
        raise RuntimeError(said)

    monkeypatch.setattr(coal, "MeshLoader", lambda: SimpleNamespace(load=load))
    with pytest.raises(ModelError, match=r"a\.stl: cannot be read as a mesh: File is empty$"):
        mesh_hull(tmp_path / "a.stl", np.ones(3))

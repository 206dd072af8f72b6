"""Meshes become convex hulls, from files that are where they may be."""

from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.model.mesh_files import mesh_hull, mesh_path
from quasistatic_ref.model.urdf import loaded_urdf
from tests.tolerances import CLOSED_FORM, EXACT
from tests.unit.urdf_texts import collision, link, robot, written

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
DENTED = TETRAHEDRON.replace("f 2 3 4", "v 0.2 0.2 0.2\nf 2 3 5\nf 3 4 5\nf 4 2 5")


def test_a_convex_mesh_is_its_hull(tmp_path: Path) -> None:
    hull = mesh_hull(written(tmp_path, TETRAHEDRON, "a.obj"), np.array([1.0, -2.0, 3.0]))
    np.testing.assert_allclose(hull.volume, 1 * 2 * 3 / 6, rtol=EXACT, atol=CLOSED_FORM)
    assert hull.is_convex
    assert len(hull.vertices) == len(hull.triangles) == 4


def test_a_dented_mesh_knows_by_how_much(tmp_path: Path) -> None:
    hull = mesh_hull(written(tmp_path, DENTED, "a.obj"), np.ones(3))
    # The dent is the tetrahedron over the outer face whose tip is at (0.2, 0.2, 0.2): with
    # x + y + z = 0.6 there instead of 1, it holds 0.4 of the volume.
    np.testing.assert_allclose(hull.excess, 0.4, rtol=EXACT, atol=1e-6)
    assert not hull.is_convex


def test_a_flat_mesh_is_refused() -> None:
    with pytest.raises(ModelError, match="vertices: must not lie in one plane"):
        convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])


def test_a_mesh_of_a_urdf_is_loaded_scaled_and_noted(tmp_path: Path) -> None:
    written(tmp_path, DENTED, "a.obj")
    mesh = '<mesh filename="a.obj" scale="2 2 2"/>'
    urdf = loaded_urdf(written(tmp_path, robot(link("a", collision(mesh)))))
    shape = urdf.shapes[0].shape
    assert isinstance(shape, ConvexMesh)
    np.testing.assert_allclose(shape.volume, 8 / 6, rtol=EXACT, atol=1e-6)
    assert urdf.notes[0].startswith("a#0: mesh replaced by its convex hull, 4 corners; it is not")


def test_a_package_address_is_looked_for_in_package_dirs(tmp_path: Path) -> None:
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    expected = written(tmp_path / "arm" / "meshes", TETRAHEDRON, "a.obj")
    found = mesh_path("package://arm/meshes/a.obj", tmp_path / "arm", (tmp_path,))
    assert found == expected.resolve()


OUTSIDE = {
    "up": ("../secret.obj", "leads to .*, outside the folder of this file"),
    "absolute": ("{root}/secret.obj", "leads to .*, outside the folder of this file"),
    "link": ("link.obj", "leads to .*, outside the folder of this file"),
    "file": ("file:///a.obj", "must be package://NAME/PATH or a relative path"),
    "no package": ("package://arm/a.obj", "in the folders of package_dirs, and the body has none"),
    "missing": ("b.obj", "no such file"),
    "kind": ("a.blend", "is not a known kind of mesh; known: .dae, .obj, .stl"),
}


@pytest.mark.parametrize(("address", "words"), OUTSIDE.values(), ids=OUTSIDE)
def test_a_mesh_that_is_not_where_it_may_be_is_refused(
    tmp_path: Path, address: str, words: str
) -> None:
    home = tmp_path / "home"
    home.mkdir()
    secret = written(tmp_path, TETRAHEDRON, "secret.obj")
    (home / "link.obj").symlink_to(secret)
    with pytest.raises(ModelError, match=words):
        mesh_path(address.format(root=tmp_path), home, ())

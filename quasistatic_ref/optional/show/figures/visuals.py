"""What bodies look like: the visual elements of their URDFs."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np
from matplotlib.colors import to_hex

from quasistatic_ref.errors import ModelError
from quasistatic_ref.files.mesh_files import loaded_mesh
from quasistatic_ref.files.urdf.file import UrdfText, urdf_text
from quasistatic_ref.files.urdf.geometry import FileMesh, written_shape
from quasistatic_ref.files.urdf.xml import Tag
from quasistatic_ref.files.xml_text import xml_root
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.model.tree import Tree
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.looks import body_colours
from quasistatic_ref.optional.show.figures.surfaces import surface_points, triangles
from quasistatic_ref.shapes.shape import Shape
from quasistatic_ref.simulate.scene import Scene

AROUND, UP = 32, 12
"""Corners of round shapes around their axis and along it."""


class Visual(NamedTuple):
    """One visual element of a URDF: a shape, its pose on a link, and its colour.

    Parameters
    ----------
    link : int
    corners : ndarray, shape (3T, 3)
        Triangles, in the link's frame [m].
    colour : str
        ``#rrggbb``: of the URDF, or else of the body.
    """

    link: int
    corners: Array
    colour: str


def visuals(scene: Scene) -> list[Visual]:
    """Visual elements of all bodies; those that cannot be read are left out: they bear no load."""
    colours = body_colours(scene.system)
    return [
        visual
        for body in scene.system.bodies
        for visual in _of_body(body, scene.system, colours[body.name])
    ]


def _of_body(body: Body, system: System, body_colour: str) -> Iterator[Visual]:
    if isinstance(body.urdf, Tree):  # it is made of none
        return
    urdf = urdf_text(body.urdf)
    robot = xml_root(urdf.text)
    named = {material.get("name"): material for material in robot.findall("material")}
    for link in robot.findall("link"):
        for element in link.findall("visual"):
            visual = Tag(element, f"link[{link.get('name')}].visual")
            try:
                shape = written_shape(visual)
                if shape is None:
                    continue
                R, t = visual.frame()
                corners = _corners(shape, urdf, body.package_dirs)
            except ModelError:
                continue
            colour = _colour(element, named) or body_colour
            number = system.link(f"{body.name}/{link.get('name')}")
            yield Visual(number, corners @ R.T + t, colour)


def _corners(shape: Shape | FileMesh, urdf: UrdfText, package_dirs: Sequence[str | Path]) -> Array:
    """Triangles as triples of points, shape (3T, 3) [m]."""
    if not isinstance(shape, FileMesh):
        return triangles(surface_points(shape, AROUND, UP))
    mesh = loaded_mesh(urdf.mesh_path(shape.uri, package_dirs))
    return np.asarray((mesh.vertices * shape.scale)[mesh.triangles.ravel()])


def _colour(visual: Element, named: dict[str | None, Element]) -> str | None:
    """The colour of a visual element's material, or of the robot's material of that name."""
    colour = visual.find("material/color")
    if colour is None:
        material = visual.find("material")
        shared = None if material is None else named.get(material.get("name"))
        colour = None if shared is None else shared.find("color")
    rgba = "" if colour is None else colour.get("rgba", "")
    try:
        red, green, blue, _ = map(float, rgba.split())
        return to_hex((red, green, blue))
    except ValueError:  # it is no colour
        return None

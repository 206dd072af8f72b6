"""Objects, places and animations as three.js and meshcat's viewer read them, in plain JSON."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.optional.show.figures.surfaces import normals
from quasistatic_ref.step.data import Array

DISCRETE = 2300
"""three.js's name of steps between keyframes."""
DIGITS = 9
"""Decimals of lengths [m]: a nanometre is finer than float32, in which three.js keeps them."""
NORMAL_DIGITS = 3
"""Decimals of normals [-], which only light a surface."""


def material(colour: int, opacity: float) -> dict[str, Any]:
    """A surface that is lit, seen from both sides; its opacity is 0 to 1 [-]."""
    both_sides = 2
    return {
        "type": "MeshPhongMaterial", "color": colour, "opacity": opacity,
        "transparent": opacity < 1, "side": both_sides,
    }  # fmt: skip


def thing(
    points: Array, kind: str, look: dict[str, Any], colours: Array | None = None
) -> dict[str, Any]:
    """An object of three.js.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        Points, or the corners of triangles, three each [m].
    kind : str
        ``"Points"`` or ``"Mesh"``.
    look : dict
        Its material.
    colours : ndarray, shape (N, 3), optional
        Of each point, from 0 to 1 [-].
    """
    attributes = {"position": _attribute(points)}
    if colours is not None:
        attributes["color"] = _attribute(colours)
    if kind == "Mesh":
        attributes["normal"] = _attribute(normals(points), NORMAL_DIGITS)
    geometry = {"type": "BufferGeometry", "data": {"attributes": attributes}}
    return {
        "metadata": {"version": 4.5, "type": "Object"},
        "geometries": [geometry | {"uuid": "g"}],
        "materials": [look | {"uuid": "m"}],
        "object": {"uuid": "o", "type": kind, "geometry": "g", "material": "m"},
    }


def _attribute(values: Array, digits: int = DIGITS) -> dict[str, Any]:
    return {"itemSize": 3, "type": "Float32Array", "array": np.round(values, digits).ravel()}


def object_set(path: str, what: dict[str, Any]) -> dict[str, Any]:
    """The command that puts an object at a path.

    three.js keeps what it animates by the object's uuid: each has its path for one.
    """
    named = what | {"object": what["object"] | {"uuid": path}}
    return {"type": "set_object", "path": path, "object": named}


def colour_clip(path: str, fps: float, colours: Array) -> dict[str, Any]:
    """How the colour of what is at a path changes.

    Parameters
    ----------
    path : str
    fps : float
        Frames a second [1/s].
    colours : ndarray, shape (N, 3)
        One a frame, from 0 to 1 [-]; each stays until the next.
    """
    track = _track(".material.color", "color", colours) | {"interpolation": DISCRETE}
    return {"path": f"{path}/<object>", "clip": {"fps": fps, "name": "default", "tracks": [track]}}


def clip(path: str, fps: float, t: Array, R: Array, scale: Array | None = None) -> dict[str, Any]:
    """The motion of what is at a path, at fps frames a second [1/s].

    Positions t have the shape (N, 3) [m], rotations R (N, 3, 3), each scale (N, 3) [-].
    """
    quaternions = Rotation.from_matrix(R).as_quat()  # [x y z w], as three.js has them
    tracks = [_track(".position", "vector3", t), _track(".quaternion", "quaternion", quaternions)]
    if scale is not None:
        tracks.append(_track(".scale", "vector3", scale))
    return {"path": path, "clip": {"fps": fps, "name": "default", "tracks": tracks}}


def _track(name: str, kind: str, values: Array) -> dict[str, Any]:
    keys = [{"time": k, "value": value} for k, value in enumerate(np.round(values, DIGITS))]
    return {"name": name, "type": kind, "keys": keys}


def z_along(directions: Array) -> Array:
    """Rotations that take z to each direction, shape (N, 3, 3); any for a direction of zero."""
    length = np.linalg.norm(directions, axis=1, keepdims=True)
    z = np.where(length > 0, directions / np.where(length > 0, length, 1), [0.0, 0.0, 1.0])
    return np.stack([*tangents(z), z], axis=2)

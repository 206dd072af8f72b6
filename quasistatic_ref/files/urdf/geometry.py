"""The shape in a collision or visual element of a URDF, as written."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.files.urdf.xml import Tag
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Shape, Sphere

GEOMETRIES = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "mesh": ("filename", "scale"),
}
"""Shape -> its attributes."""
_SOLIDS: dict[str, Callable[..., Shape]] = {
    "box": Box,
    "sphere": Sphere,
    "cylinder": Cylinder,
    "capsule": Capsule,
}


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A mesh as written: its URI, and the `scale` of each coordinate, shape (3,) [-]."""

    uri: str
    scale: Array


FileShape = Shape | FileMesh
"""A shape as written."""


def written_shape(collision: Tag) -> FileShape | None:
    """The shape of a collision or visual element; None if one of its sizes is 0.

    Of a mesh's scale the first three numbers count; the others are taken away, and noted.

    Raises
    ------
    ModelError
        If it has none, more than one, or one that is not known.
    """
    geometry = collision.child("geometry")
    tags = [child.tag for child in geometry.element]
    if len(tags) != 1:
        raise ModelError("must contain exactly one shape", field=geometry.where, value=tags)
    kind = tags[0]
    shape = geometry.inner(geometry.element[0], f"{collision.where}.{kind}")
    if kind not in GEOMETRIES:
        raise ModelError(f"is not a shape{suggestion(kind, GEOMETRIES)}", field=shape.where)
    shape.only(*GEOMETRIES[kind])
    if kind == "mesh":
        scales = shape.element.get("scale", "").split()
        if len(scales) > 3:
            shape.notes.append(
                f"{shape.where}.scale: of its {len(scales)} numbers the first three count"
            )
            shape.element.set("scale", " ".join(scales[:3]))
        scale = shape.numbers("scale", 3, default=1.0)
        if not (scale != 0).all():
            return None
        return FileMesh(shape.expanded("filename").strip(), scale)
    sizes = {
        name: shape.numbers(name, 3) if name == "size" else shape.number(name)
        for name in GEOMETRIES[kind]
    }
    if np.min([*sizes.values()]) == 0 and not (kind == "capsule" and sizes["radius"] > 0):
        return None
    try:
        return _SOLIDS[kind](**sizes)
    except ModelError as error:  # about a size
        name = str(error.field)
        error.field = f"{shape.where}.{name}"
        error.value = shape.text(name)
        raise

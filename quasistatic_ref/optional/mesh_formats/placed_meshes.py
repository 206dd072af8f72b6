"""Meshes in glTF and COLLADA, which place parts many times: read by trimesh.

Before it reads a file, the sizes that the file states are compared with the file, and what it
places is counted; afterwards it must have read as many triangles.
"""

import base64
import json
from collections.abc import Callable, Hashable, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, Final, NamedTuple
from urllib.parse import unquote
from xml.etree.ElementTree import Element, tostring

import numpy as np

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.files.mesh import Mesh
from quasistatic_ref.files.text import check_equal, decimal
from quasistatic_ref.files.xml_text import DEEPEST, MOST_ELEMENTS, xml_root
from quasistatic_ref.optional.mesh_formats.files import LARGEST_UNPACKED, check_unpacked, malformed
from quasistatic_ref.optional.mesh_formats.mesh_texts import text_of_mesh
from quasistatic_ref.optional.mesh_formats.polygons import fans_of_faces, triangles_of_faces
from quasistatic_ref.parts import needed_package
from quasistatic_ref.text.content import bytes_read, text_of

MOST_PLACED = 5_000_000
"""Most vertices and triangles of a file, each counted as often as it is placed."""
PART = 500
"""A part takes the memory of so many vertices."""
TRIANGLE = 6
"""A triangle of COLLADA takes the memory of so many vertices."""
UP = "its y axis is up; it is not turned, rpy = [1.5708, 0, 0] stands it up"
X_UP = "its x axis is up; it is not turned, rpy = [0, -1.5708, 0] stands it up"
LOOKS_OF_GLTF = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_xmp")
"""How extensions of glTF begin that move nothing."""
COUNTED = "KHR_mesh_quantization"
"""One that is read: whole numbers as coordinates, which may not be normalized."""
INSTANCES = "EXT_mesh_gpu_instancing"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
GLB = 12
"""Bytes of a GLB before its chunks."""
COMPONENTS = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
"""Bytes of the kinds of numbers of a glTF."""
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
STRIP, FAN = 5, 6
"""Modes of a glTF's triangles that follow one another."""
LOOKS = (
    *("library_images", "library_effects", "library_materials", "bind_material"),
    *("library_cameras", "instance_camera", "library_lights", "instance_light"),
)
"""Elements of COLLADA that place nothing; one that is broken costs pycollada the geometry."""


class _Part(NamedTuple):
    """A part of a file: its own size, its triangles, and the parts that it contains.

    Parameters
    ----------
    size : int
        Vertices and triangles of its own.
    triangles : int
    parts : sequence
        Names of those that it contains.
    """

    size: int
    triangles: int
    parts: Sequence[Hashable]


class _Stated(NamedTuple):
    """A file whose counts were checked, in the form in which trimesh reads it.

    Parameters
    ----------
    kind : str
        Extension, without a dot.
    content : bytes
        All of it: it names no other file.
    triangles : int
        How many it places.
    note : str
    """

    kind: str
    content: bytes
    triangles: int
    note: str = ""


def _placed_triangles(parts: Mapping[Hashable, _Part], top: Sequence[Hashable]) -> int:
    """How many triangles the parts `top` have, with all that they contain.

    Raises
    ------
    ModelError
        If a part is missing or contains itself, none is placed, or there are more than MOST_PLACED.
    """
    totals: dict[Hashable, tuple[int, int]] = {}

    def total(name: Hashable, depth: int) -> tuple[int, int]:
        if name not in parts:
            raise ModelError("is placed, but not in the file; export it again", value=name)
        if depth > DEEPEST:
            problem = f"is nested deeper than {DEEPEST} parts, or contains itself; export it flat"
            raise ModelError(problem, value=name)
        if name not in totals:
            size, triangles, below = parts[name]
            pairs = [(PART + size, triangles), *(total(one, depth + 1) for one in below)]
            totals[name] = sum(size for size, _ in pairs), sum(count for _, count in pairs)
        return totals[name]

    sizes = [total(name, 0) for name in top]
    size = sum(size for size, _ in sizes)
    if size > MOST_PLACED:
        raise ModelError(f"places more than {MOST_PLACED} vertices and triangles", value=size)
    count = sum(count for _, count in sizes)
    if not count and any(part.triangles for part in parts.values()):
        raise ModelError("places none of the triangles that it holds; export it again")
    return count


def _gltf(path: Path, content: bytes) -> _Stated:
    """A glTF or GLB, with its buffers."""
    chunk = b""
    if content[:4] == b"glTF":
        content, chunk = _glb(content)
    tree = json.loads(text_of(content, path, ModelError))
    _check_extensions(tree)
    for name in ("buffers", "bufferViews", "accessors", "meshes", "nodes"):
        if (count := len(tree.get(name, ()))) > MOST_ELEMENTS:
            raise ModelError(f"are more than {MOST_ELEMENTS}", field=name, value=count)
    buffers: list[bytes] = []
    for number, buffer in enumerate(tree.get("buffers", ())):
        with about_field(f"buffers[{number}]"):
            data = _buffer(path, buffer.get("uri"), chunk)[: buffer["byteLength"]]
            check_equal("bytes", len(data), buffer["byteLength"])
            buffers.append(data)
            check_unpacked(sum(map(len, buffers)))
            uri = f"data:;base64,{base64.b64encode(data).decode()}"
            tree["buffers"][number] = {"uri": uri, "byteLength": len(data)}
    views = tree.get("bufferViews", ())
    accessors = tree.get("accessors", ())
    _check_gltf_sizes(buffers, views, accessors)
    parts: dict[Hashable, _Part] = {}
    for number, mesh in enumerate(tree.get("meshes", ())):
        with about_field(f"meshes[{number}]"):
            counts = [_primitive(one, accessors) for one in mesh["primitives"]]
            triangles = sum(count for _, count in counts)
            size = triangles + sum(PART + count for count, _ in counts)
            parts[f"meshes[{number}]"] = _Part(size, triangles, ())
    nodes = tree.get("nodes", ())
    for number, node in enumerate(nodes):
        below: list[Hashable] = [f"nodes[{one}]" for one in node.get("children", ())]
        below += [f"meshes[{node['mesh']}]"] if "mesh" in node else []
        parts[f"nodes[{number}]"] = _Part(0, 0, below)
    scenes = tree.get("scenes", ())
    top = scenes[tree.get("scene", 0)].get("nodes", ()) if scenes else ()
    once = [*top, *(one for node in nodes for one in node.get("children", ()))]
    if len(set(once)) < len(once):
        raise ModelError("must stand in one place each", field="nodes")
    with about_field("nodes"):
        count = _placed_triangles(parts, [f"nodes[{one}]" for one in top])
    notes = [UP]
    if any(INSTANCES in node.get("extensions", ()) for node in nodes):
        notes.append(f"instances by {INSTANCES} are left out")
    if any("skin" in node for node in nodes):
        notes.append("its skin is not applied")
    return _Stated("gltf", json.dumps(tree).encode(), count, "; ".join(notes))


def _check_extensions(tree: Mapping[str, Any]) -> None:
    """Refuse what changes the shape and is not read: required extensions, weights of morphs."""
    for name in tree.get("extensionsRequired", ()):
        if not (name == COUNTED or name.startswith(LOOKS_OF_GLTF)):
            problem = "is an extension that is not read; export it without"
            raise ModelError(problem, field="extensionsRequired", value=name)
    for part in ("buffers", "bufferViews"):
        for number, one in enumerate(tree.get(part, ())):
            if compressed := [name for name in MESHOPT if name in one.get("extensions", ())]:
                problem = f"is compressed by {compressed[0]}; export it without"
                raise ModelError(problem, field=f"{part}[{number}]")
    for part in ("meshes", "nodes"):
        for number, one in enumerate(tree.get(part, ())):
            if any(one.get("weights", ())):
                problem = "are of morph targets and not 0; apply them, and export the shape"
                raise ModelError(problem, field=f"{part}[{number}].weights", value=one["weights"])


def _glb(content: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary chunk of a GLB file."""
    version, length = np.frombuffer(content[4:GLB].ljust(8, b"\0"), "<u4").tolist()
    check_equal("version", version, 2)
    check_equal("bytes", len(content), length)
    chunks: dict[bytes, bytes] = {}
    at = GLB
    while at < length:
        (size,) = np.frombuffer(content[at : at + 4].ljust(4, b"\0"), "<u4").tolist()
        chunk = content[at + 8 : at + 8 + size]
        check_equal("bytes of a chunk", len(chunk), size)
        chunks.setdefault(content[at + 4 : at + 8], chunk)
        at += 8 + size
    return chunks[b"JSON"], chunks.get(b"BIN\0", b"")


def _buffer(path: Path, uri: str | None, chunk: bytes) -> bytes:
    if uri is None:
        return chunk
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2], validate=True)
    file = (path.parent / unquote(uri)).resolve()
    if not file.is_relative_to(path.parent.resolve()):
        raise ModelError("must be a file in the folder of the glTF file", field="uri", value=uri)
    return bytes_read(file, ModelError, LARGEST_UNPACKED)


def _check_gltf_sizes(
    buffers: Sequence[bytes], views: Sequence[Any], accessors: Sequence[Any]
) -> None:
    """Check that views lie within buffers, and accessors within views."""
    total = 0
    for number, view in enumerate(views):
        start, size = view.get("byteOffset", 0), view["byteLength"]
        if not 0 <= start <= start + size <= len(buffers[view["buffer"]]):
            raise ModelError("is not within its buffer", field=f"bufferViews[{number}]")
        total += size
    for number, accessor in enumerate(accessors):
        width = COMPONENTS[accessor["componentType"]] * WIDTHS[accessor["type"]]
        count, start = accessor["count"], accessor.get("byteOffset", 0)
        total += count * width
        if "bufferView" in accessor:
            view = views[accessor["bufferView"]]
            end = start + (count - 1) * view.get("byteStride", width) + width
            if not (start >= 0 and count > 0 and end <= view["byteLength"]):
                problem = f"is not within bufferViews[{accessor['bufferView']}]"
                raise ModelError(problem, field=f"accessors[{number}]")
    check_unpacked(total // 2)


def _primitive(primitive: Mapping[str, Any], accessors: Sequence[Any]) -> tuple[int, int]:
    """Numbers of vertices and triangles of a primitive."""
    positions = accessors[primitive["attributes"]["POSITION"]]
    indices = accessors[primitive["indices"]] if "indices" in primitive else positions
    mode = primitive.get("mode", 4)
    for array in (positions, indices):
        if "bufferView" not in array or "sparse" in array or array.get("normalized"):
            problem = "is compressed, sparse or normalized; export it as plain numbers"
            raise ModelError(problem)
    if mode == FAN:
        raise ModelError("is a fan of triangles; export it as triangles")
    count = indices["count"]
    triangles = {4: count // 3, STRIP: max(0, count - 2)}.get(mode, 0)
    return positions["count"], triangles


def _collada(_: Path, content: bytes) -> _Stated:
    """A COLLADA file."""
    pycollada = needed_package("collada", "dae", "a .dae mesh")
    text = text_of_mesh(content)
    root = xml_root(text)
    if prefix := root.tag.rpartition(":")[0]:
        root.set("xmlns", root.get(f"xmlns:{prefix}", ""))
    for element in root.iter():
        element.tag = element.tag.rpartition(":")[2]
    for element in [root, *root.iter("node"), *root.iter("instance_geometry")]:
        for looks in [one for one in element if one.tag in LOOKS]:
            element.remove(looks)
    unit = root.find("asset/unit")
    if unit is not None and not decimal(unit.get("meter", "1")) > 0:
        raise ModelError("must be greater than 0", field="unit", value=unit.get("meter"))
    named = {element.get("id"): element for element in root.iter() if element.get("id")}
    parts: dict[Hashable, _Part] = {}
    for geometry in root.iter("geometry"):
        with about_field(f"geometry[{geometry.get('id')}]"):
            triangles = sum(map(_collada_triangles, geometry.findall("mesh/*")))
            size = sum(_float_count(array) for array in geometry.iter("source"))
            parts[geometry] = _Part(size // 3 + TRIANGLE * triangles, triangles, ())
    for node in root.iter("node"):
        if node.find("skew") is not None:
            problem = "has a skew, which is not read; apply it, and export the shape"
            raise ModelError(problem, field=f"node[{node.get('id')}]")
        placed = [_target(one) for one in node if one.tag in ("instance_geometry", "instance_node")]
        below = [named.get(target, target) for target in placed]
        parts[node] = _Part(0, 0, [*node.findall("node"), *below])
    scene = root.find("scene/instance_visual_scene")
    shown = named[_target(scene)].findall("node") if scene is not None else []
    with about_field("scene"):
        count = _placed_triangles(parts, shown)
    content = tostring(root)
    ignored = [pycollada.common.DaeUnsupportedError, pycollada.common.DaeBrokenRefError]
    with malformed("a mesh", pycollada.common.DaeError):
        # What trimesh leaves out is an error here.
        collada = pycollada.Collada(BytesIO(content), ignore=ignored)
        primitives = [one for geometry in collada.geometries for one in geometry.primitives]
        polygons = [one for one in primitives if isinstance(one, pycollada.polylist.Polylist)]
        are_cut = [_cut_by_ears(each) for each in polygons]
        if any(are_cut):
            written = BytesIO()
            collada.xmlnode.write(written)
            content = written.getvalue()
    up = {"Y_UP": UP, "X_UP": X_UP}.get(root.findtext("asset/up_axis", "").strip(), "")
    return _Stated("dae", content, count, up)


def _cut_by_ears(polygons: Any) -> bool:
    """Write a set of polygons as triangles, and tell so, if trimesh's fans do not fill each.

    Parameters
    ----------
    polygons : collada.polylist.Polylist
    """
    is_face = polygons.vcounts >= 3
    rows = np.flatnonzero(np.repeat(is_face, polygons.vcounts))
    if not len(rows):
        return False
    sizes = polygons.vcounts[is_face]
    corners = polygons.vertex[polygons.vertex_index].astype(np.float64)
    triangles = triangles_of_faces(corners, rows, sizes)
    if (triangles == fans_of_faces(rows, sizes)).all():
        return False
    node = polygons.xmlnode
    namespace, brace, _ = node.tag.rpartition("}")
    lists = [one for one in node if one.tag.rpartition("}")[2] in ("vcount", "p")]
    for one in lists[:-1]:
        node.remove(one)
    lists[-1].tag = f"{namespace}{brace}p"
    lists[-1].text = " ".join(map(str, polygons.index[triangles].ravel().tolist()))
    node.tag = f"{namespace}{brace}triangles"
    node.set("count", str(len(triangles)))
    return True


def _target(element: Element) -> str:
    return element.get("url", "").removeprefix("#")


def _float_count(source: Element) -> int:
    """Number of values in a COLLADA source, checked against the count that it states."""
    array = source.find("float_array")
    if array is None:
        return 0
    words = (array.text or "").split()
    with about_field(f"float_array[{array.get('id')}]"):
        for word in words:
            decimal(word)
        check_equal("count", len(words), int(array.get("count", len(words))))
    return len(words)


def _collada_triangles(primitive: Element) -> int:
    """How many triangles a set of polygons has; of another element, none."""
    inputs = [int(one.get("offset", 0)) for one in primitive.findall("input")]
    width = 1 + max(inputs, default=0)
    lists = [len((p.text or "").split()) for p in primitive.findall("p")]
    corners = [count // width for count in lists]
    stated = int(primitive.get("count", 0))
    match primitive.tag:
        case "triangles":
            check_equal("corners", sum(lists), 3 * width * stated)
            return stated
        case "polylist":
            corners = [int(word) for word in primitive.findtext("vcount", "").split()]
            check_equal("corners", sum(lists), width * sum(corners))
        case "polygons" | "tristrips" | "trifans":
            pass
        case _:
            return 0
    check_equal("faces", len(corners), stated)
    return sum(max(0, count - 2) for count in corners)


PLACED: Final[dict[str, Callable[[Path, bytes], _Stated]]] = {
    ".gltf": _gltf,
    ".glb": _gltf,
    ".dae": _collada,
}
"""Extension -> such a file, of which the sizes were compared."""


def placed_mesh(path: Path, content: bytes) -> Mesh:
    """The mesh of all parts of a file, each where the file places it, in metres."""
    import trimesh  # takes as long as a short run

    stated = PLACED[path.suffix.lower()](path, content)
    with np.errstate(all="ignore"):  # what is not read is counted
        scene = trimesh.load_scene(
            BytesIO(stated.content),
            file_type=stated.kind,
            process=False,
            maintain_order=True,
            skip_materials=True,
        )
        placed = scene.dump()
    # Lines have no vertices that count.
    shown = [one for one in placed if type(one).__name__ in ("Trimesh", "PointCloud")]
    nothing = np.zeros((0, 3))
    vertices = np.concatenate([nothing, *(one.vertices for one in shown)])
    starts = np.cumsum([0, *(len(one.vertices) for one in shown)])
    faces = [getattr(one, "faces", nothing) + n for one, n in zip(shown, starts, strict=False)]
    triangles = np.concatenate([nothing, *faces]).astype(np.int64)
    check_equal("triangles", len(triangles), stated.triangles)
    units = "meters" if stated.kind == "gltf" or scene.units is None else scene.units
    metres = trimesh.units.unit_conversion(units, "meters")
    return Mesh(metres * vertices, triangles, stated.note)

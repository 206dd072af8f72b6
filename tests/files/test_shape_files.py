"""Files of clouds and of meshes: each format gives the same points, each defect is a sentence."""

import io
import os
import re
import struct

import numpy as np
import pypcd4
import pytest
import trimesh

from quasistatic_ref import ModelError
from tests.cases import refusal
from tests.closeness import assert_same, assert_within
from tests.made import loaded_mesh, mesh_hull, point_cloud, seen_points
from tests.oracles.shape_files import (
    COLLADA,
    PCD_BODY,
    PCD_HEADER,
    TETRAHEDRON,
    bytes_of,
    exported,
    pcd,
    plain_gltf,
)

CLOUDS = {".xyz", ".csv", ".txt", ".pts", ".pcd", ".npy", ".npz"}
BOTH = {".obj", ".off", ".ply"}
POINTS = np.array([[0.1, -0.2, 0.3], [1.0, 2e-3, -0.5]])
TEXT = "0.1 -0.2 0.3\n1.0 2e-3 -0.5\n"
XYZ = "element vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
PLY_ASCII = f"""ply
format ascii 1.0
comment made by hand
{XYZ}property uchar red
element face 1
property list uchar int vertex_indices
end_header
0.1 -0.2 0.3 255
1.0 2e-3 -0.5 0
3 0 1 0
"""
GRID = """element range_grid 4
property list uchar int vertex_indices
element tristrips 1
property list int int vertex_indices
element edge 1
property int vertex1
property int vertex2
end_header
"""
"""What scanners write after their points: none of it is a face."""
SCAN = f"""ply
format ascii 1.0
obj_info num_cols 2
{XYZ}{GRID}{TEXT}1 0
1 1
0
1 2
4 0 1 2 -1
0 1
"""
SCAN_IN_BYTES = (
    f"ply\nformat binary_little_endian 1.0\nobj_info num_cols 2\n{XYZ}{GRID}".encode()
    + POINTS.tobytes()
    + struct.pack("<BiBiBBi5i2i", 1, 0, 1, 1, 0, 1, 2, 4, 0, 1, 2, -1, 0, 1)
)
RED_FIRST = XYZ.replace("2\n", "2\nproperty uchar red\n", 1)
RED_POINTS = b"".join(struct.pack("<B3d", 7, *point) for point in POINTS)


def npy(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def compressed_pcd():
    cloud = pypcd4.PointCloud.from_points(POINTS, ("x", "y", "z"), (np.float64,) * 3)
    file = io.BytesIO()
    cloud.save(file, pypcd4.Encoding.BINARY_COMPRESSED)
    return file.getvalue()


def npz(**arrays):
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


GOOD = {
    "spaces.xyz": "# a comment\n0.1 -0.2 0.3\n\n1.0\t2e-3   -0.5 # end\n",
    "CRLF and a mark.XYZ": b"\xef\xbb\xbf0.1 -0.2 0.3\r\n1 2e-3 -.5\r\n",
    "colours.xyz": "0.1 -0.2 0.3 255 0 0\n1.0 2e-3 -0.5 255 0 0\n",
    "commas.xyz": "0.1,-0.2,0.3\n1.0,2e-3,-0.5\n",
    "header.xyz": f"X Y Z\n{TEXT}",
    "unseen.xyz": f"nan nan nan\n{TEXT}0 NaN 1\n",
    "header.csv": "x,y,z\n0.1, -0.2, 0.3\n1.0,2e-3,-0.5\n",
    "columns moved.csv": 'id,"Z",X,y\n0,0.3,0.1,-0.2\n1,-0.5,1.0,2e-3\n',
    "normals.csv": "0.1,-0.2,0.3,0,0,1\n1.0,2e-3,-0.5,0,0,1\n",
    "semicolons.csv": "x;y;z\n0.1;-0.2;0.3\n1.0;2e-3;-0.5\n",
    "tabs.txt": "0.1\t-0.2\t0.3\n1.0\t2e-3\t-0.5\n",
    "intensity.pts": "2\n0.1 -0.2 0.3 0 255 0 0\n1.0 2e-3 -0.5 0 255 0 0\n",
    "text.pcd": pcd("ascii", PCD_BODY),
    "no COUNT.pcd": pcd("ascii", PCD_BODY, PCD_HEADER.replace("COUNT 1 1 1 1\n", "")),
    "binary.pcd": pcd("binary", RED_POINTS),
    "compressed.pcd": compressed_pcd(),
    "float64.npy": npy(POINTS),
    "Python 2.npy": npy(POINTS).replace(b"(2, 3), }  ", b"(2L, 3L), }"),
    "one array.npz": npz(cloud=POINTS),
    "several arrays.npz": npz(colours=np.ones((2, 4)), points=POINTS),
    "text.ply": PLY_ASCII,
    "list.ply": f"ply\nformat ascii 1.0\n{XYZ}property list uchar float t\nend_header\n"
    "0.1 -0.2 0.3 1 0\n1.0 2e-3 -0.5 1 0\n",
    "camera.ply": "ply\nformat ascii 1.0\nelement camera 1\nproperty float f\n"
    f"{XYZ}end_header\n1\n{TEXT}",
    "little.ply": f"ply\nformat binary_little_endian 1.0\n{RED_FIRST}element face 0\n"
    "property list uchar int vertex_indices\nend_header\n".encode() + RED_POINTS,
    "big.ply": f"ply\nformat binary_big_endian 1.0\n{XYZ}end_header\n".encode()
    + POINTS.astype(">f8").tobytes(),
    "scan.ply": SCAN,
    "scan in bytes.ply": SCAN_IN_BYTES,
    "points.off": f"OFF\n2 0 0\n{TEXT}",
    "counts in the first line.off": f"OFF2 0 0\n{TEXT}",
    "Latin-1 comment.off": f"OFF # K\xf6rper\n2 0 0\n{TEXT}".encode("latin-1"),
    "object.obj": "o thing\nv 0.1 -0.2 0.3\nvn 0 0 1\nv 1.0 2e-3 -0.5 1.0\nf 1 2 1\n",
    "Latin-1 comment.obj": b"# K\xf6rper\nv 0.1 -0.2 0.3\nv 1.0 2e-3 -0.5\n",
    "dots of Windows.obj": b"o a\x85b\nv 0.1 -0.2 0.3\nv 1.0 2e-3 -0.5\n",
    "a line as a face.obj": "v 0.1 -0.2 0.3\nv 1.0 2e-3 -0.5\nf 1 2\n",
    "back from the last point.obj": "v 0.1 -0.2 0.3\nv 1.0 2e-3 -0.5\nf -2 -1 -2\n",
}  # fmt: skip


def readers(path):
    """What reads the points of a file: a cloud's reader, a mesh's, or both."""
    kind = path.suffix.lower()
    if kind in CLOUDS | BOTH:
        yield lambda: point_cloud(path).points
    if kind not in CLOUDS:
        yield lambda: loaded_mesh(path).vertices


@pytest.mark.parametrize("name", GOOD)
def test_every_format_gives_the_points_bit_for_bit(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(bytes_of(GOOD[name]))
    for read in readers(path):
        assert_same(read(), POINTS)


STL = exported("stl_ascii")
OFF = exported("off")
PLY = exported("ply")
PLACED = '<instance_geometry url="#g"/>'
MATERIAL = (
    '<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="m" '
    'target="#none"/></technique_common></bind_material></instance_geometry>'
)
WHOLE = {
    "text.off": (OFF, 8.0),
    "bytes.ply": (PLY, 8.0),
    "bytes.glb": (exported("glb"), 8.0),
    "text.stl": (STL, 8.0),
    "bytes.stl": (exported("stl"), 8.0),
    "a header that begins with solid.stl": (b"solid".ljust(80) + exported("stl")[80:], 8.0),
    "Latin-1 name.stl": (b"solid K\xf6rper\n" + STL.partition(b"\n")[2], 8.0),
    "Latin-1 name.dae": (
        COLLADA.replace('id="sc"', 'id="sc" name="\xf6"').encode("latin-1"), 1 / 6,
    ),
    "a material that is not there.dae": (COLLADA.replace(PLACED, MATERIAL), 1 / 6),
}  # fmt: skip
"""A file, as trimesh wrote it or changed, and the volume of its mesh [m^3]."""


@pytest.mark.parametrize("name", WHOLE)
def test_a_mesh_is_read_as_it_was_written(tmp_path, name):
    content, volume = WHOLE[name]
    (tmp_path / name).write_bytes(bytes_of(content))
    hull = mesh_hull(tmp_path / name, np.ones(3))
    assert_within(hull.volume, volume, 1e-6)
    assert hull.is_convex


def gltf_at(uri):
    """The tetrahedron as a glTF whose buffer is elsewhere."""
    return plain_gltf(buffers=[{"uri": uri, "byteLength": 72}])


PLY_TEXT = f"ply\nformat ascii 1.0\n{XYZ}end_header\n{TEXT}"
FACE = PLY_TEXT.replace(
    "end_header", "element face 1\nproperty list uchar int vertex_indices\nend_header"
)
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
"""Changes of a COLLADA that lost a triangle or a corner without a word, or took memory."""
MESHOPT = {"extensions": {"EXT_meshopt_compression": {}}}
BAD = {
    "other words.pcd": ("solid thing\n", "header: lacks these lines; add .*'FIELDS', 'SIZE'"),
    "no body.pcd": (pcd("binary", b""), "points: must be 2 .got 0"),
    "an odd type.pcd": (
        pcd("binary", bytes(54), PCD_HEADER.replace("SIZE 1", "SIZE 3")), "cannot be read as PCD",
    ),
    "more numbers.pcd": (
        pcd("ascii", PCD_BODY + b"1 2 3\n"), "numbers: must be 8, as the file states .got 11",
    ),
    "no points.pcd": (pcd("ascii", b"", PCD_HEADER.replace(" 2\n", " 0\n")), "not 0"),
    "compressed and cut off.pcd": (compressed_pcd()[:-3], "points: must be"),
    "compressed, of more points.pcd": (
        compressed_pcd().replace(b"POINTS 2", b"POINTS 3"), "POINTS: must be WIDTH times HEIGHT",
    ),
    "a pickle.npy": (npy(np.array([{}], dtype=object)), "is a pickle"),
    "cut off.npy": (npy(POINTS)[:-1], "does not have the size that it says"),
    "pairs.npy": (npy(POINTS[:, :2]), "numbers of shape .N, 3. .got 'float64"),
    "many points.npy": (
        npy(np.zeros((1_000_001, 3), np.int8)), "holds more than 1000000 points",
    ),
    "two arrays.npz": (npz(a=POINTS, b=POINTS), "must contain one array, or one that is"),
    "empty.xyz": ("\n# nothing\n", "points: must contain at least one point"),
    "unseen.xyz": ("nan nan nan\n", "must contain at least one point"),
    "infinity.xyz": ("0 0 0\n0 inf 0\n", "line 2: must be a finite decimal number"),
    "two numbers.xyz": ("0 0 0\n1 2\n", r"line 2: must be three numbers, x y z.*'1 2'"),
    "overflow.xyz": ("0 1e999 0\n", "line 1:.*overflows.*'1e999'"),
    "far away.xyz": ("1e15 0 0\n0 -1.1e15 0\n", r"must be at most 1e\+15 m"),
    "not text.xyz": (b"0 0 0\n\xff\xfe 0 0\n", "line 2: is not UTF-8 text"),
    "no column z.csv": ("x,y,u\n1,2,3\n", "line 1: must name the column z once"),
    "many points.csv": ("x,y,z\n" + "0,0,1\n" * 1_000_001, "holds more than 1000000 points"),
    "many lines.csv": ("0,0,1\n" + "\n" * 2_000_000, "holds more than 2000000 lines"),
    "another number.pts": ("3\n0 0 0\n1 0 0\n", "points: must be 3"),
    "no z.obj": ("v 1 2\n", "line 1: must be a point, x y z .got '1 2'"),
    "a face of one.obj": (TETRAHEDRON + "f 1\n", "line 9: must be a face of three corners"),
    "a corner too many.obj": (TETRAHEDRON + "f 1 2 9\n", "triangles: must be numbers of ver"),
    "a line that is none.obj": (TETRAHEDRON + "x 1 2\n", "line 9: is a line of an OBJ that"),
    "far away.obj": (TETRAHEDRON.replace("1 0 0", "1e200 0 0"), "must be at most 1e.15 m"),
    "fewer faces.off": (OFF[:-10], "line 2: must be the number of points and of faces"),
    "a face cut short.off": (OFF.rstrip()[:-1] + b"\n", "line 22: must have 3 corners"),
    "no words.ply": ("hello\n", "must begin with ply"),
    "a point less.ply": (
        PLY_ASCII.split("1.0 2e-3")[0], r"vertex: must be 2, as the file states \(got 1\)",
    ),
    "a count beyond 64 bits.ply": (
        PLY_ASCII.replace("vertex 2", "vertex 9999999999999999999"),
        "vertex: must be 9999999999999999999",
    ),
    "a scan cut off.ply": (SCAN[:-5], "edge"),
    "a scan cut off in bytes.ply": (SCAN_IN_BYTES[:-5], "edge"),
    "cut off.ply": (PLY[:-1], r"face\[11\].vertex_indices: must be 3.*got 2"),
    "longer.ply": (PLY + b"x", "holds more than its header says"),
    "faces without corners.ply": (PLY.replace(b"_indices", b"_numbers"), "must be faces with"),
    "an empty face.ply": (FACE + "0\n", r"face\[0\]: must be a face of three corners"),
    "two lines for a point.ply": (PLY_TEXT.replace("2e-3 -", "2e-3\n-"), "lines: must be 2"),
    "half a corner more.ply": (
        FACE + "3.5 0 1 0\n", r"face\[0\].vertex_indices: must have a whole number of",
    ),
    "half a corner.ply": (FACE + "3 0 1.5 0\n", "face: must be whole numbers"),
    "no JSON.gltf": ("", "cannot be read as a mesh: it is malformed"),
    "a pipe.gltf": (gltf_at("pipe"), "a pipe, not"),
    "a file elsewhere.gltf": (gltf_at("../x"), "must be a file in the folder of the glTF file"),
    "a short buffer.gltf": (
        gltf_at("data:,"), r"buffers\[0\]: must be 72, as the file states \(got 0\)",
    ),
    "long buffers.gltf": (
        plain_gltf(buffers=5 * [{"uri": "zeros", "byteLength": 2**24}]),
        "unpacks to more than 64 MiB",
    ),
    "a view beyond its buffer.gltf": (
        plain_gltf(bufferViews=[{"buffer": 0, "byteLength": 99}]),
        r"Views\[0\]: is not within its buffer",
    ),
    "an array beyond its view.gltf": (
        plain_gltf().replace(b'"count": 4', b'"count": 5'),
        r"accessors\[0\]: is not within bufferViews\[0\]",
    ),
    "zeros without bytes.gltf": (
        plain_gltf().replace(b'"bufferView": 0, ', b""), "is compressed, sparse or normalized",
    ),
    "a node in itself.gltf": (plain_gltf(nodes=[{"mesh": 0, "children": [0]}]), "one place"),
    "a fan.gltf": (plain_gltf().replace(b'"indices": 1', b'"indices": 1, "mode": 6'), "a fan"),
    "no such mesh.gltf": (plain_gltf(nodes=[{"mesh": 1}]), r"nodes: is placed.*'meshes\[1\]'"),
    "nothing placed.gltf": (plain_gltf(nodes=[{}]), "places none of the triangles that it"),
    "an unknown extension.gltf": (
        plain_gltf(extensionsRequired=["ACME_bent"]),
        "extensionsRequired: is an extension that is not read.*ACME_bent",
    ),
    "instances.gltf": (
        plain_gltf(extensionsRequired=["EXT_mesh_gpu_instancing"]),
        "extensionsRequired: is an extension .*'EXT_mesh_gpu_instancing'",
    ),
    "meshopt.gltf": (
        plain_gltf(bufferViews=[MESHOPT]),
        r"bufferViews\[0\]: is compressed by EXT_meshopt_compression; export it without",
    ),
    "a buffer that only meshopt fills.gltf": (
        plain_gltf(buffers=[MESHOPT]), r"buffers\[0\]: is compressed by EXT_meshopt_compression",
    ),
    "weights of a mesh.gltf": (
        plain_gltf(meshes=[{"primitives": [], "weights": [0, 1.0]}]),
        r"meshes\[0\].weights: are of morph targets and not 0",
    ),
    "weights of a node.gltf": (
        plain_gltf(nodes=[{"mesh": 0, "weights": [0.5]}]),
        r"nodes\[0\].weights: are of morph targets and not 0",
    ),
    "cut off.glb": (exported("glb")[:-4], "bytes: must be"),
    "cut off.stl": (STL + STL[: STL.rindex(b"outer")], "is cut off or not in"),
    "no end.stl": (STL.replace(b"endsolid", b""), "is cut off or not in"),
    "bytes cut off.stl": (exported("stl")[:-1], "must begin with solid, or hold 50"),
    "a word of its own.stl": (STL.replace(b"endloop", b"color", 1), "line 7: must begin with"),
    "very many parts.dae": (
        COLLADA.replace(PLACED, 10_000 * PLACED), "places more than 5000000 vertices and triangles",
    ),
    "a skew.dae": (
        COLLADA.replace("<node>", '<node id="n"><skew>45 1 0 0 0 1 0</skew>'),
        r"node\[n\]: has a skew, which is not read",
    ),
    **{f"{name}.dae": (COLLADA.replace(*change), "") for name, change in MALFORMED.items()},
}  # fmt: skip


@pytest.fixture
def beside(tmp_path):
    """A folder with a pipe, 16 MiB of zeros and a glTF of another shape."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "zeros").touch()
    os.truncate(tmp_path / "zeros", 2**24)
    for other, part in trimesh.creation.box().export(file_type="gltf").items():
        (tmp_path / other).write_bytes(part)
    return tmp_path


@pytest.mark.parametrize("name", BAD)
def test_a_defect_is_one_sentence_that_names_the_file(beside, name):
    content, words = BAD[name]
    path = beside / name
    path.write_bytes(bytes_of(content))
    for read in readers(path):
        with pytest.raises(ModelError, match=f"^{re.escape(str(beside))}/.*{words}"):
            read()


MANY = XYZ.replace("vertex 2", "vertex 1000001").replace("double", "char")
BAD_CLOUDS = {
    "a mesh.stl": ("", "extension: is not a known kind of point cloud.*'.stl'"),
    "faces first.ply": (
        "ply\nformat ascii 1.0\nelement face 0\nend_header\n", "points: must contain at least one",
    ),
    "many points.ply": (
        f"ply\nformat binary_little_endian 1.0\n{MANY}end_header\n".encode() + bytes(3_000_003),
        "holds more than 1000000 points",
    ),
    "a long text.csv": (bytes(2**26 + 1), "is a text of more than"),
}  # fmt: skip
"""Files that a mesh may be, and one of a size."""


@pytest.mark.parametrize("name", BAD_CLOUDS)
def test_a_file_that_is_no_cloud_is_refused_as_one(tmp_path, name):
    content, words = BAD_CLOUDS[name]
    path = tmp_path / name
    path.write_bytes(bytes_of(content))
    with refusal(ModelError, f"{path}: ", words):
        point_cloud(path)


def test_coordinates_and_their_number_may_reach_their_limits(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("1e15,0,0\n0,-1e15,0\n")
    assert len(point_cloud(path).points) == 2
    path.write_text("x,y,z\n" + "0,0,1\n" * 1_000_000)  # and a header
    assert len(seen_points(path).points) == 1_000_000


def test_many_lines_of_numbers_are_read_as_line_by_line(tmp_path, rng):
    """To the last bit, with a header, other columns and comments; what is not seen is counted."""
    rows = [[repr(v) for v in row] for row in rng.normal(size=(50, 4)).tolist()]
    path = tmp_path / "a.csv"
    path.write_text("u,z,y,x\n" + "\n".join(map(",".join, rows)) + " # last\n1,nan,0,0\n")
    points, unseen, _ = seen_points(path)
    assert points.tolist() == [[float(row[c]) for c in (3, 2, 1)] for row in rows]
    assert unseen == 1
    path.write_text(path.read_text() + "1,2,3,x\n")
    with pytest.raises(ModelError, match="line 53"):
        seen_points(path)

"""Point clouds from files: every format gives the same points, every defect a sentence."""

import io
import os
import struct

import numpy as np
import pypcd4
import pytest

from quasistatic_ref import ModelError
from quasistatic_ref.files.clouds import point_cloud, seen_points
from quasistatic_ref.files.text import MOST_POINTS
from tests.cases import cases, refusal
from tests.oracles.shape_files import PCD_BODY, PCD_HEADER, pcd

POINTS = np.array([[0.1, -0.2, 0.3], [1.0, 2e-3, -0.5]])
PLY_ASCII = """ply
format ascii 1.0
comment made by hand
element vertex 2
property double x
property double y
property double z
property uchar red
element face 1
property list uchar int vertex_indices
end_header
0.1 -0.2 0.3 255
1.0 2e-3 -0.5 0
3 0 1 0
"""
BINARY_HEADER = """ply
format binary_little_endian 1.0
element vertex 2
property uchar red
property double x
property double y
property double z
element face 0
property list uchar int vertex_indices
end_header
"""


def binary_body(layout):
    return b"".join(struct.pack(layout, 7, *point) for point in POINTS)


def npy(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def npz(**arrays):
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


GOOD = {
    "xyz": (".xyz", b"# a comment\n0.1 -0.2 0.3\n\n1.0\t2e-3   -0.5 # end\n"),
    "xyz with CRLF and a mark": (".XYZ", b"\xef\xbb\xbf0.1 -0.2 0.3\r\n1 2e-3 -.5\r\n"),
    "csv with a header": (".csv", b"x,y,z\n0.1, -0.2, 0.3\n1.0,2e-3,-0.5\n"),
    "csv with columns moved": (".csv", b'id,"Z",X,y\n0,0.3,0.1,-0.2\n1,-0.5,1.0,2e-3\n'),
    "ascii ply": (".ply", PLY_ASCII.encode()),
    "binary ply in float64": (".ply", BINARY_HEADER.encode() + binary_body("<B3d")),
    "ascii pcd": (".pcd", pcd("ascii", PCD_BODY)),
    "pcd without COUNT": (
        ".pcd",
        pcd("ascii", PCD_BODY, PCD_HEADER.replace("COUNT 1 1 1 1\n", "")),
    ),
    "binary pcd": (".pcd", pcd("binary", binary_body("<B3d"))),
    "npy": (".npy", npy(POINTS)),
    "npy of Python 2": (".npy", npy(POINTS).replace(b"(2, 3), }  ", b"(2L, 3L), }")),
    "npz of one array": (".npz", npz(cloud=POINTS)),
    "npz of several": (".npz", npz(colours=np.ones((2, 4)), points=POINTS)),
    "obj": (".obj", b"o thing\nv 0.1 -0.2 0.3\nvn 0 0 1\nv 1.0 2e-3 -0.5 1.0\nf 1 2 1\n"),
}


@cases("suffix, content", GOOD)
def test_every_format_gives_the_points_bit_for_bit(tmp_path, suffix, content):
    path = tmp_path / f"cloud{suffix}"
    path.write_bytes(content)
    assert np.array_equal(point_cloud(path).points, POINTS)


BAD = {
    "pcd of other words": (
        ".pcd",
        b"solid thing\n",
        "header: lacks these lines; add them .*'FIELDS', 'SIZE'",
    ),
    "pcd without its body": (".pcd", pcd("binary", b""), "points: must be 2 .got 0"),
    "pcd of an odd type": (
        ".pcd",
        pcd("binary", binary_body("<Bxx3d"), PCD_HEADER.replace("SIZE 1", "SIZE 3")),
        "cannot be read as PCD",
    ),
    "npy of a pickle": (
        ".npy",
        npy(np.array([{}], dtype=object)),
        "is a pickle",
    ),
    "npy cut off": (".npy", npy(POINTS)[:-1], "does not have the size that it says"),
    "npy of pairs": (
        ".npy",
        npy(POINTS[:, :2]),
        "numbers of shape .N, 3. .got 'float64",
    ),
    "npz of two arrays": (
        ".npz",
        npz(a=POINTS, b=POINTS),
        "must contain one array, or one that is",
    ),
    "unknown extension": (".stl", b"", "extension: is not a known kind of point cloud.*'.stl'"),
    "empty xyz": (".xyz", b"\n# nothing\n", "points: must contain at least one point"),
    "nothing that was seen": (".xyz", b"nan nan nan\n", "must contain at least one point"),
    "infinity": (".xyz", b"0 0 0\n0 inf 0\n", "line 2: must be a finite decimal number"),
    "two numbers": (".xyz", b"0 0 0\n1 2\n", r"line 2: must be three numbers, x y z.*'1 2'"),
    "overflow": (".xyz", b"0 1e999 0\n", "line 1:.*overflows.*'1e999'"),
    "not text": (".xyz", b"0 0 0\n\xff\xfe 0 0\n", "line 2: is not UTF-8 text"),
    "no column z": (".csv", b"x,y,u\n1,2,3\n", "line 1: must name the column z once"),
    "obj without z": (".obj", b"v 1 2\n", "line 1: must be a point, x y z .got '1 2'"),
    "not ply": (".ply", b"hello\n", "must begin with ply"),
    "short ascii ply": (
        ".ply",
        PLY_ASCII.split("1.0 2e-3")[0].encode(),
        r"vertex: must be 2, as the file states \(got 1\)",
    ),
    "a count beyond 64 bits": (
        ".ply",
        PLY_ASCII.replace("vertex 2", "vertex 9999999999999999999").encode(),
        "vertex: must be 9999999999999999999",
    ),
    "another number than it begins with": (".pts", b"3\n0 0 0\n1 0 0\n", "points: must be 3"),
    "a pcd of other numbers": (
        ".pcd",
        pcd("ascii", PCD_BODY + b"1 2 3\n"),
        "numbers: must be 8, as the file states .got 11",
    ),
    "a pcd of no points": (".pcd", pcd("ascii", b"", PCD_HEADER.replace(" 2\n", " 0\n")), "not 0"),
    "faces first": (
        ".ply",
        b"ply\nformat ascii 1.0\nelement face 0\nend_header\n",
        "points: must contain at least one",
    ),
}


@cases("suffix, content, words", BAD)
def test_a_defect_is_one_sentence_that_names_the_file(tmp_path, suffix, content, words):
    path = tmp_path / f"cloud{suffix}"
    path.write_bytes(content)
    with refusal(ModelError, f"{path}: ", words):
        point_cloud(path)


POINTS_OF_BYTES = "element vertex 1000001\nproperty char x\nproperty char y\nproperty char z\n"


@pytest.mark.parametrize(
    ("name", "content"),
    [
        (
            "c.ply",
            f"ply\nformat binary_little_endian 1.0\n{POINTS_OF_BYTES}end_header\n".encode()
            + bytes(3_000_003),
        ),
        ("c.npy", npy(np.zeros((1_000_001, 3), np.int8))),
    ],
)
def test_more_points_than_a_cloud_may_have_are_refused(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(ModelError, match=f"{name}: holds more than 1000000 points"):
        point_cloud(path)


def test_coordinates_may_reach_their_limit(tmp_path):
    far = tmp_path / "far.xyz"
    far.write_text("1e15 0 0\n0 -1e15 0\n")
    assert len(point_cloud(far).points) == 2
    far.write_text("1e15 0 0\n0 -1.1e15 0\n")
    with pytest.raises(ModelError, match=r"must be at most 1e\+15 m"):
        point_cloud(far)


def test_a_text_of_points_has_at_most_so_many_letters_lines_and_points(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("# of a camera\nx,y,z\n" + "0,0,1\n" * 3)
    assert len(point_cloud(path).points) == 1  # the same point
    path.write_text("x,y,z\n" + "0,0,1\n" * MOST_POINTS)  # and a header
    assert len(seen_points(path)[0]) == MOST_POINTS
    for content, size, words in (
        ("x,y,z\n" + "0,0,1\n" * (MOST_POINTS + 1), 0, "holds more than 1000000 points"),
        ("0,0,1\n" + "\n" * 2 * MOST_POINTS, 0, "holds more than 2000000 lines"),
        ("", 2**26 + 1, "is a text of more than"),
    ):
        path.write_text(content)
        os.truncate(path, size or len(content))
        with pytest.raises(ModelError, match=words):
            point_cloud(path)


EIGHT = np.array(np.meshgrid([0, 0.05], [0, 0.04], [0, 0.03], indexing="ij")).reshape(3, 8).T
TEXT = "".join("{:g} {:g} {:g}\n".format(*point) for point in EIGHT)
XYZ = "property float x\nproperty float y\nproperty float z\n"
OTHERS = {
    "colours.xyz": TEXT.replace("\n", " 255 0 0\n"),
    "commas.xyz": TEXT.replace(" ", ","),
    "header.xyz": f"X Y Z\n{TEXT}",
    "normals.csv": TEXT.replace("\n", " 0 0 1\n").replace(" ", ","),
    "semicolons.csv": f"x y z\n{TEXT}".replace(" ", ";"),
    "tabs.txt": TEXT.replace(" ", "\t"),
    "intensity.pts": "8\n" + TEXT.replace("\n", " 0 255 0 0\n"),
    "points.off": f"OFF\n8 0 0\n{TEXT}",
    "list.ply": f"ply\nformat ascii 1.0\nelement vertex 8\n{XYZ}property list uchar float t\n"
    "end_header\n" + TEXT.replace("\n", " 1 0\n"),
    "camera.ply": "ply\nformat ascii 1.0\nelement camera 1\nproperty float f\n"
    f"element vertex 8\n{XYZ}end_header\n1\n{TEXT}",
    "big.ply": f"ply\nformat binary_big_endian 1.0\nelement vertex 8\n{XYZ}end_header\n".encode()
    + EIGHT.astype(">f4").tobytes(),
    "unseen.xyz": TEXT.replace("\n", "\nnan nan nan\n", 1) + "0 NaN 1\n",
}


@pytest.mark.parametrize("name", OTHERS)
def test_files_that_others_read_are_read(tmp_path, name):
    content = OTHERS[name]
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    points, unseen = seen_points(path)
    assert points == pytest.approx(EIGHT, abs=1e-8)
    assert unseen == (2 if name == "unseen.xyz" else 0)


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


@pytest.mark.parametrize("kind", ["ascii", "binary_little_endian"])
def test_elements_of_a_ply_that_are_no_vertex_and_no_face_are_passed_over(tmp_path, kind):
    points = f"ply\nformat {kind} 1.0\nobj_info num_cols 2\nelement vertex 8\n{XYZ}"
    if kind == "ascii":
        rows = "\n".join(" ".join(map(repr, row)) for row in EIGHT.tolist())
        body = f"{rows}\n1 0\n1 1\n0\n1 2\n4 0 1 2 -1\n0 1\n".encode()
    else:
        body = EIGHT.astype("<f4").tobytes() + struct.pack(
            "<BiBiBBi5i2i", 1, 0, 1, 1, 0, 1, 2, 4, 0, 1, 2, -1, 0, 1
        )
    path = tmp_path / "scan.ply"
    path.write_bytes(points.encode() + GRID.encode() + body)
    assert point_cloud(path).points == pytest.approx(EIGHT, abs=1e-8)
    path.write_bytes(points.encode() + GRID.encode() + body[:-5])
    with pytest.raises(ModelError, match=r"edge|lines"):
        point_cloud(path)


def test_a_compressed_pcd_is_read_and_one_that_is_cut_off_or_of_another_number_refused(tmp_path):
    path = tmp_path / "a.pcd"
    pypcd4.PointCloud.from_xyz_points(EIGHT).save(path, pypcd4.Encoding.BINARY_COMPRESSED)
    assert point_cloud(path).points == pytest.approx(EIGHT, abs=1e-8)
    whole = path.read_bytes()
    for content, words in (
        (whole[:-3], "points: must be"),
        (whole.replace(b"POINTS 8", b"POINTS 9"), "POINTS: must be WIDTH times HEIGHT"),
    ):
        path.write_bytes(content)
        with pytest.raises(ModelError, match=words):
            point_cloud(path)


def test_many_lines_of_numbers_are_read_as_line_by_line(tmp_path, rng):
    """To the last bit, with a header, other columns and comments."""
    rows = [[repr(v) for v in row] for row in rng.normal(size=(50, 4)).tolist()]
    path = tmp_path / "a.csv"
    path.write_text("u,z,y,x\n" + "\n".join(",".join(row) for row in rows) + " # last\n")
    expected = [[float(row[c]) for c in (3, 2, 1)] for row in rows]
    assert seen_points(path)[0].tolist() == expected
    path.write_text(path.read_text() + "1,2,3,x\n")
    with pytest.raises(ModelError, match="line 52"):
        seen_points(path)

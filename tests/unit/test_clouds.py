"""Point clouds from files: every format gives the same points, every defect a sentence."""

import struct
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.clouds import point_cloud
from tests.tolerances import FILE_FLOAT32

POINTS = np.array([[0.1, -0.2, 0.3], [1.0, 2e-3, -0.5]])
PLY_ASCII = """ply
format ascii 1.0
comment made by hand
element vertex 2
property float x
property float y
property float z
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
property {0} x
property {0} y
property {0} z
element face 0
property list uchar int vertex_indices
end_header
"""


def binary_ply(kind: str, code: str, points: np.ndarray = POINTS) -> bytes:
    body = b"".join(struct.pack(f"<B3{code}", 7, *point) for point in points)
    return BINARY_HEADER.format(kind).encode() + body


GOOD: dict[str, tuple[str, bytes]] = {
    "xyz": (".xyz", b"# a comment\n0.1 -0.2 0.3\n\n1.0\t2e-3   -0.5 # end\n"),
    "xyz with CRLF and a mark": (".XYZ", b"\xef\xbb\xbf0.1 -0.2 0.3\r\n1 2e-3 -.5\r\n"),
    "csv": (".csv", b"0.1,-0.2,0.3\n1.0,2e-3,-0.5\n"),
    "csv with a header": (".csv", b"x,y,z\n0.1, -0.2, 0.3\n1.0,2e-3,-0.5\n"),
    "csv with columns moved": (".csv", b'id,"Z",X,y\n0,0.3,0.1,-0.2\n1,-0.5,1.0,2e-3\n'),
    "ascii ply": (".ply", PLY_ASCII.encode()),
    "binary ply in float64": (".ply", binary_ply("double", "d")),
    "obj": (".obj", b"o thing\nv 0.1 -0.2 0.3\nvn 0 0 1\nv 1.0 2e-3 -0.5 1.0\nf 1 2 1\n"),
}


@pytest.mark.parametrize(("suffix", "content"), GOOD.values(), ids=GOOD)
def test_every_format_gives_the_points_bit_for_bit(
    tmp_path: Path, suffix: str, content: bytes
) -> None:
    path = tmp_path / f"cloud{suffix}"
    path.write_bytes(content)
    assert np.array_equal(point_cloud(path).points, POINTS)


def test_a_binary_ply_in_float32_gives_the_rounded_points(tmp_path: Path) -> None:
    path = tmp_path / "cloud.ply"
    path.write_bytes(binary_ply("float", "f"))
    points = point_cloud(path).points
    assert np.array_equal(points, POINTS.astype(np.float32).astype(np.float64))
    assert points == pytest.approx(POINTS, abs=FILE_FLOAT32)


NAN = np.array([[0.0, 0.0, 0.0], [1.0, np.nan, 2.0]])
BAD: dict[str, tuple[str, bytes, str]] = {
    "unknown extension": (".stl", b"", "extension: is not a known kind of point cloud.*'.stl'"),
    "no extension": ("", b"0 0 0", "extension: is not a known kind of point cloud"),
    "empty xyz": (".xyz", b"\n# nothing\n", "points: must hold at least one point"),
    "empty csv": (".csv", b"x,y,z\n", "points: must hold at least one point"),
    "empty obj": (".obj", b"f 1 2 3\n", "points: must hold at least one point"),
    "two numbers": (".xyz", b"0 0 0\n1 2\n", r"line 2: must be three numbers, x y z.*'1 2'"),
    "four numbers": (".xyz", b"0 0 0 1\n", "line 1: must be three numbers"),
    "nan": (".xyz", b"0 0 0\n\n0 nan 1\n", r"line 3: must be a finite decimal number \(got 'nan'"),
    "a word": (".xyz", b"0 zero 0\n", "line 1: must be a finite decimal number.*'zero'"),
    "underscore": (".xyz", b"0 1_0 0\n", "line 1: must be a finite decimal number.*'1_0'"),
    "overflow": (".xyz", b"0 1e999 0\n", "line 1:.*overflows.*'1e999'"),
    "not text": (".xyz", b"0 0 0\n\xff\xfe 0 0\n", "line 2: is not UTF-8 text"),
    "decimal comma": (".csv", b"0,1;0,2;0,3\n", "line 1: must have 3 columns"),
    "ragged csv": (".csv", b"x,y,z,i\n1,2,3\n", "line 2: must have 4 columns.*'1,2,3'"),
    "no column z": (".csv", b"x,y,u\n1,2,3\n", "line 1: must name the column z once"),
    "empty cell": (".csv", b"1,,3\n", r"line 1: must be a finite decimal number \(got ''"),
    "obj without z": (".obj", b"v 1 2\n", "line 1: must be v x y z"),
    "obj nan": (".obj", b"o a\nv 1 2 nan\n", "line 2: must be a finite decimal number"),
    "not ply": (".ply", b"hello\n", "line 1: must be the word ply.*'hello'"),
    "headless ply": (".ply", b"ply\nformat ascii 1.0\n", "header: must end with end_header"),
    "big endian": (
        ".ply",
        b"ply\nformat binary_big_endian 1.0\nend_header\n",
        "line 2: is not understood.*binary_big_endian",
    ),
    "no format": (".ply", PLY_ASCII.replace("format ascii 1.0\n", "").encode(), "name a format"),
    "short ascii ply": (
        ".ply",
        PLY_ASCII.split("1.0 2e-3")[0].encode(),
        r"body: must hold 2 vertices \(got 1\)",
    ),
    "bad ascii ply": (
        ".ply",
        PLY_ASCII.replace("2e-3", "nan").encode(),
        r"line 13: must be a finite decimal number \(got 'nan'\)",
    ),
    "ragged ascii ply": (
        ".ply",
        PLY_ASCII.replace("0.3 255", "0.3").encode(),
        "line 12: must be 4 numbers",
    ),
    "no property z": (
        ".ply",
        PLY_ASCII.replace("property float z\n", "").encode(),
        "element vertex: must have one property z",
    ),
    "a list in a vertex": (
        ".ply",
        PLY_ASCII.replace("property uchar red", "property list uchar int red").encode(),
        "line 8: is not understood",
    ),
    "faces first": (
        ".ply",
        b"ply\nformat ascii 1.0\nelement face 1\nend_header\n",
        "line 3: must be element vertex.*'face'",
    ),
    "short binary ply": (
        ".ply",
        binary_ply("double", "d")[:-1],
        r"body: must hold 2 vertices \(got 1\)",
    ),
    "nan binary ply": (".ply", binary_ply("double", "d", NAN), "vertex 1: must be finite numbers"),
    "no vertices": (
        ".ply",
        PLY_ASCII.replace("vertex 2", "vertex 0").encode(),
        "points: must hold at least one point",
    ),
    "impossible count": (
        ".ply",
        binary_ply("float", "f").replace(b"vertex 2", b"vertex 999999999999999999"),
        r"body: must hold 999999999999999999 vertices \(got 2\)",
    ),
}


@pytest.mark.parametrize(("suffix", "content", "words"), BAD.values(), ids=BAD)
def test_a_defect_is_one_sentence_that_names_the_file(
    tmp_path: Path, suffix: str, content: bytes, words: str
) -> None:
    path = tmp_path / f"cloud{suffix}"
    path.write_bytes(content)
    with pytest.raises(ModelError, match=words) as caught:
        point_cloud(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"nowhere\.xyz: no such file"):
        point_cloud(tmp_path / "nowhere.xyz")


def test_a_folder_is_no_cloud(tmp_path: Path) -> None:
    (tmp_path / "folder.xyz").mkdir()
    with pytest.raises(ModelError, match=r"folder\.xyz: cannot be read"):
        point_cloud(tmp_path / "folder.xyz")

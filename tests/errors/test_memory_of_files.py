"""A file of the largest size takes at most forty times its size in memory, read or refused."""

import struct
import tracemalloc
from contextlib import suppress

import pytest

from quasistatic_ref import Body, InputError, System, load_scenario, load_step
from tests.cases import cases, refusal
from tests.files.urdf.urdf_texts import loaded_urdf
from tests.made import loaded_mesh, point_cloud
from tests.oracles.shape_files import COLLADA, plain_gltf

TIMES = 40
"""Most bytes of memory for each byte of a file."""
SIZE = 2**18
"""Of each file, nearly [bytes]: far above what readers take of a file of any size."""
MANY = 2**19
"""Of one that holds more than is counted, and is refused for that [bytes]."""
SHORT = 2**16
"""Of a file each of whose few bytes takes a line of a reader written in Python [bytes]."""


def lines(one, count=SIZE):
    return one * (count // len(one))


def ply(elements, body, kind="binary_little_endian"):
    """A PLY of no vertices, and of lists that other elements hold."""
    lists = "".join(
        f"element {name} {count}\nproperty list uchar int {of}\n" for name, count, of in elements
    )
    points = "element vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
    return f"ply\nformat {kind} 1.0\n{points}{lists}end_header\n".encode() + body


FACES = SIZE // 13
TRIANGLES = struct.pack("<B3i", 3, 0, 0, 0) * FACES
PLACED_MESH = COLLADA.encode()
PLACED = b'<instance_geometry url="#g"/>'
URDF = b'<robot name="r"><link name="a">%s</link></robot>'
FILES = {
    "one line.csv": b"1," * (SIZE // 2) + b"1\n",
    "short lines.csv": lines(b"0 0 0\n"),
    "a header.csv": b"z,y,x\n" + lines(b"0,0,0\n") + b"0,0,nan\n",
    "one face.obj": b"v 0 0 0\nf" + b" 1" * (SIZE // 2),
    "faces.obj": b"v 0 0 0\n" + lines(b"f 1 1 1\n", SHORT),
    "points.obj": lines(b"v 1 2 3\n", SHORT),
    "short lines.off": b"OFF\n" + lines(b"0\n"),
    "short lines, well counted.off": (
        b"OFF\n1 %d 0\n0 0 0\n" % (SHORT // 8) + lines(b"3 0 0 0\n", SHORT)
    ),
    "empty faces.ply": ply([("face", SIZE, "vertex_indices")], bytes(SIZE)),
    "triangles.ply": ply([("face", FACES, "vertex_index")], TRIANGLES),
    "an empty grid.ply": ply([("range_grid", SHORT, "vertex_indices")], bytes(SHORT)),
    "in text with one line.ply": ply([("face", 1, "vertex_indices")], b"0 " * (SIZE // 2), "ascii"),
    "in text of short lines.ply": ply([("grid", SHORT // 2, "of")], b"0\n" * (SHORT // 2), "ascii"),
    "in text.stl": b"solid\n" + lines(b"vertex 0 0 0\n", SHORT),
    "objects.json": b'{"format": "quasistatic-ref/step", "x": [' + lines(b'{"a":0},') + b"0]}",
    "lists.json": b'{"format": "quasistatic-ref/step", "x": [' + lines(b"[],") + b"0]}",
    "one deep key.toml": lines(b"a.") + b"a = 1\n",
    "deep keys.toml": lines(b"[a.a.a.a.a.a.a.a.a.a]\n"),
    "deep tables.toml": b"a = " + lines(b"{a=") + b"1\n",
    "empty elements.urdf": URDF % lines(b"<b/>", MANY),
    "attributes.urdf": (
        URDF % b"".join(b'<b c="" d="" e="" f="%d"/>' % k for k in range(SIZE // 26))
    ),
    "empty elements.dae": PLACED_MESH.replace(b"</COLLADA>", lines(b"<b/>", MANY) + b"</COLLADA>"),
    "empty nodes.gltf": plain_gltf(nodes=[{}] * (MANY // 4)),
    "a part in many places.dae": PLACED_MESH.replace(PLACED, PLACED * (MANY // len(PLACED))),
    "numbers.dae": PLACED_MESH.replace(b"0 0 0 1 0 0 0", lines(b"0 ") + b"0 0 0 1 0 0 0"),
}  # fmt: skip
READERS = {
    ".csv": point_cloud,
    ".json": load_step,
    ".toml": load_scenario,
    ".urdf": lambda path: System([Body("r", path)]),
}


@pytest.mark.shared
@pytest.mark.parametrize("name", FILES)
def test_a_file_takes_at_most_forty_times_its_size(tmp_path, name):
    path, content = tmp_path / name, FILES[name]
    read = READERS.get(path.suffix, loaded_mesh)
    for size in (1000, len(content)):  # what the first call imports and keeps is not of the file
        path.write_bytes(content[:size])
        tracemalloc.start()
        with suppress(InputError):
            read(path)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert peak < TIMES * len(content) + 2**20


MOST = 100_000
"""Elements of a URDF, and attributes."""
MORE = {
    "elements": (f"<a>\n{'<b/>' * MOST}{'<' * 1000}", "line 2: has more than 100000 elements"),
    "attributes": (
        '<a b="">\n<c ' + " ".join(f'a{k}=""' for k in range(MOST)) + "/></a>",
        "line 2: has more than 100000 attributes",
    ),
    "a long name": (f"<{'x' * 4001}/>", "line 1: has a name of more than 4000 characters"),
    "a long attribute": (f'<a {"x" * 4001}=""/>', "line 1: has a name of more than 4000 char"),
}


@cases("text, words", MORE)
def test_elements_are_counted_while_a_urdf_is_read(text, words):
    with refusal(InputError, f"<robot>: {words}"):
        loaded_urdf(text)


def test_a_urdf_has_as_many_elements_as_are_allowed():
    elements = "<b/>" * (MOST - 2)  # and its robot and link
    assert loaded_urdf(f'<robot name="r"><link name="a">{elements}</link></robot>').tree.ignored

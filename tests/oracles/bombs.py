"""Small files that ask for much: time, memory, or what lies elsewhere."""

from __future__ import annotations

import io
import lzma
import os
import struct
import zipfile

import numpy as np

from tests.oracles.spoilt_files import zip_bytes

MANY = 3_000_000
ENTITIES = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 10))
LAUGHS = f'<!DOCTYPE r [<!ENTITY e0 "ha">{ENTITIES}]><r>&e9;</r>'
"""Entities that make 10^9 words."""


def mjcf(world, sections=""):
    """A model of MuJoCo's."""
    body = '<body name="b"><geom size="1"/></body>'
    return f"<mujoco>{sections}<worldbody>{body}{world}</worldbody></mujoco>".encode()


def urdf(inside):
    """A URDF with one link."""
    return f'<robot name="r"><link name="a">{inside}</link></robot>'.encode()


def hinges(count):
    """A URDF of links that hang on one."""
    hinge = '<joint name="j@" type="continuous"><parent link="a"/><child link="l@"/></joint>'
    return urdf("").replace(
        b"</robot>", copies(f'<link name="l@"/>{hinge}', count).encode() + b"</robot>"
    )


def npy_header(shape, kind="<f8"):
    """An array's file that promises more than it has."""
    head = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    head += b" " * (117 - len(head)) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head


def packed_zeros(name, size, kind="<f8"):
    """A ZIP file of a few hundred KiB with an array of zeros."""
    file = io.BytesIO()
    with (
        zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open(name, "w") as one,
    ):
        one.write(npy_header(f"({size // int(kind[-1])},)", kind))
        for _ in range(size >> 24):
            one.write(bytes(1 << 24))
    return file.getvalue()


def copies(text, count):
    """A text many times, each with its number in place of @."""
    return "".join(text.replace("@", str(i)) for i in range(count))


BOX = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
REPLICA = '<replicate count="{}" offset="1 0 0"><body><joint/><geom size=".1"/></body></replicate>'
ATTACHED = '<frame><attach model="m" body="b" prefix="p"/></frame>'
FLEX = '<body><flexcomp name="f" type="grid" count="99 99 99" dim="3" mass="1" radius=".1"/></body>'
CABLE = '<body><composite type="cable" count="9999 1 1" size="1" prefix="a"><geom size="1"/>'
SENSOR = '<sensor><user dim="2000000000"/></sensor>'
TEXTURE = '<texture name="t@" type="2d" builtin="checker" width="2000" height="2000"/>'
FIELD = '<hfield name="h@" nrow="2000" ncol="2000" size="1 1 1 1"/>'
NUMERIC = '<numeric name="n@" size="900000"/>'
PLY = "ply\nformat {} 1.0\nelement vertex {}\nproperty {}\nend_header\n"
PCD = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 {0}\n"
PCD += "WIDTH {1}\nHEIGHT 1\nPOINTS {1}\nDATA {2}\n"
FLOATS = "float x\nproperty float y\nproperty float z"
BYTES = FLOATS.replace("float", "char")
HALF_GB = 480 * 10**6
CORNERS = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
BALL = '[bodies.b@]\nurdf = "sphere.urdf"\nbase = "floating"\nactuated = []\n'
SCENE = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
STEP = '{"format": "quasistatic-ref/step", "version": 1, "h": 0.01, "n_a": 0, "n_u": 6, '

BOMBS = {
    "MJCF: an arena of 10 TB": ("MJCF", mjcf("", '<size memory="10T"/>')),
    "MJCF: 3 million keys": ("MJCF", mjcf("", '<size nkey="3000000"/>')),
    "MJCF: 10,000 bodies by a replica": ("MJCF", mjcf(REPLICA.format(10000))),
    "MJCF: 10^8 bodies by nested replicas": (
        "MJCF", mjcf('<replicate count="10000">' + REPLICA.format(10000) + "</replicate>"),
    ),
    "MJCF: 20,000 bodies that are written": (
        "MJCF", mjcf(copies('<body name="c@"><joint/><geom size=".1"/></body>', 20000)),
    ),
    "MJCF: 50,000 elements in each other": (
        "MJCF", mjcf("<body>" * 50000 + "</body>" * 50000),
    ),
    "MJCF: 300 textures of 4 million points": (
        "MJCF", mjcf("", f"<asset>{copies(TEXTURE, 300)}</asset>"),
    ),
    "MJCF: 100 height fields of 4 million numbers": (
        "MJCF", mjcf("", f"<asset>{copies(FIELD, 100)}</asset>"),
    ),
    "MJCF: 400 lists of 900,000 numbers": (
        "MJCF", mjcf("", f"<custom>{copies(NUMERIC, 400)}</custom>"),
    ),
    "MJCF: a sensor of 2 * 10^9 numbers": ("MJCF", mjcf("", SENSOR)),
    "MJCF: a flexible grid": ("MJCF", mjcf(FLEX)),
    "MJCF: a cable of 9999 bodies": ("MJCF", mjcf(f"{CABLE}</composite></body>")),
    "MJCF: it attaches itself": (
        "MJCF", mjcf(ATTACHED, '<asset><model name="m" file="m.xml"/></asset>'),
    ),
    "MJCF: it includes itself": ("MJCF", b'<mujoco><include file="m.xml"/></mujoco>'),
    "MJCF: entities of entities": ("MJCF", LAUGHS.encode()),
    "MJCF: a name of 10 MB": ("MJCF", mjcf(f'<body name="{"n" * 10**7}"/>')),
    "MJCF: 60 MB of a comment": ("MJCF", lambda: mjcf("", f"<!--{'x' * 60 * 10**6}-->")),
    "MJCF: a file elsewhere": ("MJCF", b'<mujoco><include file="../outside/m.xml"/></mujoco>'),
    "MJCF: a mesh elsewhere": (
        "MJCF", mjcf("", '<compiler meshdir=".."/><asset><mesh file="outside/m.obj"/></asset>'),
    ),
    "URDF: entities of entities": ("URDF", LAUGHS.encode()),
    "URDF: 20,000 boxes": ("URDF", urdf(BOX * 20000)),
    "URDF: 50,000 elements in each other": ("URDF", urdf("<x>" * 50000 + "</x>" * 50000)),
    "URDF: an attribute of 10 MB": ("URDF", urdf("").replace(b'"a"', b'"%b"' % (b"a" * 10**7))),
    "URDF: 100,000 links": (
        "URDF", urdf("").replace(b"</robot>", copies('<link name="l@"/>', 100000).encode()),
    ),
    "URDF: 900 hinges": ("URDF", lambda: hinges(900)),
    "URDF: 250 hinges": ("URDF", lambda: hinges(250)),
    "URDF: a mesh elsewhere": (
        "URDF",
        urdf('<collision><geometry><mesh filename="../outside/m.obj"/></geometry></collision>'),
    ),
    "STL: 4 * 10^9 triangles": ("mesh, STL", bytes(80) + b"\xff\xff\xff\xff" + bytes(500)),
    "OBJ: a corner of the number 2^31": (
        "mesh, OBJ", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 2147483647\n",
    ),
    "STL: 10 million triangles": ("mesh, STL", lambda: triangles(10**7)),
    "STL: 300,000 triangles": ("mesh, STL", lambda: triangles(300000)),
    "OBJ: 2 million triangles": ("mesh, OBJ", lambda: CORNERS + b"f 1 2 3\n" * (2 * 10**6)),
    "DAE: 4 million elements": ("mesh, DAE", lambda: b"<a>" + b"<b/>" * (4 * 10**6) + b"</a>"),
    "DAE: 100 million elements": ("mesh, DAE", lambda: b"<a>" + b"<b/>" * (100 * 10**6) + b"</a>"),
    "OBJ: 3 million corners": ("mesh, OBJ", lambda: b"v 0 0 1\n" * MANY + b"f 1 2 3\n"),
    "DAE: entities of entities": ("mesh, DAE", LAUGHS.encode()),
    "XYZ: one line of 60 MB": ("cloud, xyz", lambda: b"1 " * (30 * 10**6)),
    "XYZ: 10 million points": ("cloud, xyz", lambda: b"1 2 3\n" * 10**7),
    "XYZ: 500 million lines": ("cloud, xyz", lambda: b"\n" * (500 * 10**6)),
    "CSV: 10^6 columns": ("cloud, csv", lambda: b"x,y,z" + b",a" * 10**6 + b"\n1,2,3\n"),
    "PLY: 4 * 10^9 points": (
        "cloud, ply", PLY.format("binary_little_endian", 2**32, "float x").encode() + bytes(99),
    ),
    "PLY: lists of 4 * 10^9 numbers": (
        "cloud, ply",
        PLY.format("binary_little_endian", 3, "list uint float x").encode() + b"\xff" * 99,
    ),
    "PLY: 10 million points": (
        "cloud, ply", lambda: PLY.format("ascii", 10**7, FLOATS).encode() + b"1 2 3\n" * 10**7,
    ),
    "PLY: a header of 60 MB": ("cloud, ply", lambda: b"ply\n" + b"\n" * (60 * 10**6)),
    "PLY: 160 million points of three bytes": (
        "cloud, ply",
        lambda: PLY.format("binary_little_endian", 160 * 10**6, BYTES).encode() + bytes(HALF_GB),
    ),
    "PCD: 10 million points": (
        "cloud, pcd", lambda: PCD.format(1, 10**7, "ascii").encode() + b"1 2 3\n" * 10**7,
    ),
    "PCD: 10^18 points": ("cloud, pcd", PCD.format(1, 10**18, "binary").encode()),
    "PCD: columns of 10^9 numbers": ("cloud, pcd", PCD.format(10**9, 3, "ascii").encode()),
    "NPY: an array of 10^18 numbers": ("cloud, npy", npy_header("(1000000000000000000, 3)")),
    "NPY: 160 million points of three bytes": (
        "cloud, npy", lambda: npy_header("(160000000, 3)", "|i1") + bytes(HALF_GB),
    ),
    "NPY: an array of objects": ("cloud, npy", npy_header("(3,)", "|O") + b"cos\nsystem\n"),
    "NPZ: 1 GiB of zeros": ("cloud, npz", lambda: packed_zeros("points.npy", 1 << 30)),
    "NPZ: 60,000 arrays": (
        "trajectory", lambda: zip_bytes([(f"{i}.npy", npy_header("(0,)")) for i in range(60000)]),
    ),
    "NPZ: a trajectory of 1 GiB": ("trajectory", lambda: packed_zeros("header.npy", 1 << 30)),
    "NPZ: a header of 1 GB": (
        "trajectory", lambda: packed_zeros("header.npy", 1000 << 20, "|u1"),
    ),
    "JSON: 20 million objects": (
        "step", lambda: f'{STEP}"M_u": [{"{}," * (20 * 10**6)}1]}}'.encode(),
    ),
    "JSON: a million brackets": ("step", b"[" * 10**6),
    "JSON: a number of a million digits": ("step", f'{STEP}"M_u": {"9" * 10**6}}}'.encode()),
    "JSON: 10 million coordinates": (
        "step", lambda: f'{STEP}"tau_u": [{"0," * 10**7}0]}}'.encode(),
    ),
    "JSON: n_u of 10^18": ("step", STEP.replace('"n_u": 6', '"n_u": 1000000000000000000').encode()),
    "JSON: a solution of brackets": ("solution", b'{"format":' * 10**5),
    "TOML: a key of 100,000 parts": ("scenario", f"{SCENE}{'a.' * 10**5}a = 1".encode()),
    "TOML: 100,000 brackets": ("scenario", f"{SCENE}gravity = {'[' * 10**5}".encode()),
    "TOML: a cloud elsewhere": (
        "scenario",
        f'{SCENE}[bodies.b]\nurdf = "sphere.urdf"\ncloud = "../outside/c.xyz"\n'.encode(),
    ),
    "TOML: roots elsewhere": (
        "scenario", f'{SCENE}roots = ["/"]\n[bodies.b]\nurdf = "sphere.urdf"\n'.encode(),
    ),
    "TOML: 9,000 bodies": ("scenario", lambda: _scene(9000).encode()),
    "TOML: 900 bodies": ("scenario", lambda: _scene(900).encode()),
    "TOML: 250,000 pairs": ("scenario", lambda: _pairs(500).encode()),
    "TOML: 40,000 pairs": ("scenario", lambda: _pairs(200).encode()),
    "XZ: 20 million lists": (
        "study, study.json.xz",
        lambda: lzma.compress(b'{"tables":{"rows":[' + b"[]," * (20 * 10**6) + b"0]}}", preset=0),
    ),
    "XZ: 8 GiB of zeros": ("study, study.json.xz", lambda: _packed(8 << 30)),
}  # fmt: skip
"""Name -> reader, and content of its file."""


def _packed(size):
    """Zeros, packed by XZ."""
    packer = lzma.LZMACompressor(preset=0)
    chunk = bytes(1 << 24)
    parts = [packer.compress(chunk) for _ in range(size >> 24)]
    return b"".join([*parts, packer.flush()])


def triangles(count):
    """A file of STL, of triangles with corners all over."""
    corners = np.random.default_rng(0).normal(size=(count, 3, 3)).astype("<f4")
    kind = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]
    every = np.zeros(count, kind)
    every["corners"] = corners
    return bytes(80) + struct.pack("<I", count) + every.tobytes()


def _scene(count):
    """A scenario of so many bodies, which is loaded and not run."""
    return SCENE.replace("steps = 1", "steps = 3") + copies(BALL, count)


def _pairs(count):
    """A scenario of so many bodies on so many floors, each on each."""
    floors = copies("[shapes.f@]\nhalfspace = { normal = [0, 0, 1] }\n", count)
    names = [f"f{i}" for i in range(count)], [f"b{i}" for i in range(count)]
    sides = f"alpha = {names[0]}\nbeta = {names[1]}\n"
    return f"{_scene(count)}{floors}[contacts.c]\n{sides}mu_v = 0.5\nrows = 4\n"


def outside(folder):
    """Files next to the folder of a reader's, which nothing may open."""
    folder.mkdir()
    (folder / "m.xml").write_bytes(mjcf(""))
    (folder / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    (folder / "c.xyz").write_text("0 0 0\n1 0 0\n")


PLACES = {
    "a pipe": lambda path: os.mkfifo(path),
    "a link to a device": lambda path: path.symlink_to("/dev/zero"),
    "a link to itself": lambda path: path.symlink_to(path),
    "a folder": lambda path: path.mkdir(),
}
"""What stands in the place of each reader's file."""

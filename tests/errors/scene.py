"""A good scenario, step and solution as plain dictionaries, to be spoilt one field at a time."""

import tomllib

from tests.files.urdf.urdf_texts import urdf_of_text
from tests.oracles.records import toml_text, with_value
from tests.scenes import BALL, RAIL

CLOUD = "0 0 0.05\n0.05 0 0\n0 0.05 0\n"

SCENE = tomllib.loads("""
format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 3
gravity = [0.0, 0.0, -9.81]
solver = { accuracy = 1e-12 }
limits = { penetration = 0.05, reach = 100.0 }
[bodies.rail]
urdf = "rail.urdf"
actuated = ["slide"]
K_q = { slide = 500.0 }
positions = { slide = 0.0 }
targets = [{ t = 0.0, slide = 0.0 }, { t = 0.1, slide = 0.02 }]
[bodies.ball]
urdf = "ball.urdf"
base = "floating"
pose = { xyz = [0.065, 0.0, 0.05], rpy = [0.0, 0.0, 0.0] }
wrenches = [{ t = 0.0, force = [0.0, 0.1, 0.0], torque = [0.0, 0.0, 0.001] }]
[shapes.floor]
halfspace = { normal = [0.0, 0.0, 1.0], offset = 0.0 }
pose = { xyz = [0.0, 0.0, 0.0], rpy = [0.0, 0.0, 0.0] }
[shapes.wall]
box = { size = [0.1, 1.0, 1.0] }
pose = { xyz = [9.0, 0.0, 0.0] }
[shapes.post]
capsule = { radius = 0.1, length = 1.0 }
pose = { xyz = [0.0, 9.0, 0.0] }
[contacts.floor]
alpha = "floor"
beta = "ball"
mu_v = 0.5
mu_omega = 0.01
rows = 6
k = 1
[contacts.push]
alpha = "rail/plate"
beta = "ball"
mu_v = 0.3
rows = 4
""")
"""A plate pushes a ball over the floor: n_a = 1, n_u = 7, 10 rows."""
SUNK = ("bodies/ball/pose/xyz", [0.065, 0.0, -0.03])
"""A change that makes the first step fail: 0.08 m deep, where 0.05 m is the limit."""


def changed(record, *changes):
    """A deep copy with fields replaced (or removed, by `...`), each given as ``a/b/0``."""
    for path, value in changes:
        place = tuple(int(key) if key.isdigit() else key for key in path.split("/"))
        record = with_value(record, place, value)
    return record


def numeric_fields(value, above=""):
    """The path, as ``a/b/0``, of every number in a record; of a list of numbers its last."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from numeric_fields(inner, f"{above}/{key}")
    elif isinstance(value, list) and value and not isinstance(value[0], int | float):
        for i, inner in enumerate(value):
            yield from numeric_fields(inner, f"{above}/{i}")
    elif isinstance(value, list) and value:
        yield f"{above}/{len(value) - 1}".lstrip("/")
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield above.lstrip("/")


def dotted(record, path):
    """The name that messages give to a path: ``a.b[0].c``, without indices into numbers."""
    name = ""
    at = record
    for part in path.split("/"):
        if isinstance(at, dict):
            name = f"{name}.{part}"
            at = at[part]
        else:
            name = name if isinstance(at[0], int | float | list) else f"{name}[{part}]"
            at = at[int(part)]
    return name.lstrip(".")


def scene_written(folder, scene=SCENE):
    """A scenario file with its URDFs and a cloud next to it."""
    urdf_of_text(folder, BALL, "ball.urdf")
    urdf_of_text(folder, RAIL, "rail.urdf")
    urdf_of_text(folder, CLOUD, "cloud.xyz")
    return urdf_of_text(folder, toml_text(scene).decode(), "scene.toml")


def contents(folder):
    """Every file of a folder."""
    return {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}

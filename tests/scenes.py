"""Scenes that several tests share: bodies that move in every way, and small scenario files."""

from quasistatic_ref import Body, System, load_scenario
from tests.files.urdf.urdf_texts import (
    BOX,
    CHAIN,
    collision,
    inertial,
    joint,
    link,
    robot,
    urdf_of_text,
)


def chain_scene(folder):
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    chain = urdf_of_text(folder, CHAIN, "chain.urdf")
    box = urdf_of_text(folder, BOX, "box.urdf")
    return System(
        [
            Body("box", box, "floating", xyz=(0.5, 0.6, 0.7), rpy=(0.1, 0.2, 0.3)),
            Body("arm", chain, "floating", ("spin", "base"), positions={"spin": 2.0}),
            Body("desk", chain, "fixed", ("slide",), xyz=(1, 2, 3), rpy=(0.4, -0.5, 0.6)),
        ]
    )


BALL = robot(link("ball", collision('<sphere radius="0.05"/>'), inertial("0.3", ("3e-4",) * 3)))
"""A solid ball."""

RAIL = robot(
    link("rail"),
    link("plate", collision('<box size="0.02 0.2 0.2"/>')),
    joint("slide", "rail", "plate", "prismatic", "1 0 0", '<origin xyz="0 0 0.05"/>'),
    link("wheel"),
    joint("turn", "rail", "wheel", "continuous", "0 0 1"),
)
"""A plate that slides along x, and a wheel that turns for ever."""

CLUB = robot(
    link("post"),
    link("club", collision('<sphere radius="0.01"/>', '<origin xyz="0.2 0 0"/>')),
    joint("swing", "post", "club", "revolute", "0 1 0", '<origin xyz="0 0 0.1"/>'),
)
"""A club of 0.2 m that swings about y, 0.1 m above the floor."""

PUSH = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 5
gravity = [0, 0, -9.81]

[bodies.rail]
urdf = "rail.urdf"
actuated = ["slide", "turn"]
K_q = { slide = 500, turn = 2.5 }

[[bodies.rail.targets]]
t = 0.0
slide = 0.0
turn = 0.0

[[bodies.rail.targets]]
t = 0.1
slide = 0.02
turn = 7.0

[bodies.ball]
urdf = "ball.urdf"
base = "floating"
pose = { xyz = [0.065, 0, 0.05] }

[[bodies.ball.wrenches]]
t = 0.0
force = [0, 0, 0]

[[bodies.ball.wrenches]]
t = 0.1
force = [0, 0.1, 0]
torque = [0, 0, 0.001]

[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }

[contacts.floor]
alpha = "floor"
beta = "ball"
mu_v = 0.5
mu_omega = 0.01
rows = 6

[contacts.push]
alpha = "rail/plate"
beta = "ball"
mu_v = 0.3
rows = 4
"""
"""A plate pushes a ball over the floor: n_a = 2, n_u = 6, 10 rows."""

SWING = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 6

[bodies.post]
urdf = "club.urdf"
actuated = "all"
K_q = { swing = 10 }

[[bodies.post.targets]]
t = 0.02
swing = 0.0

[[bodies.post.targets]]
t = 0.03
swing = -4.71238898038469

[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }

[contacts.floor]
alpha = "floor"
beta = "post/club"
mu_v = 0.5
rows = 4
"""
"""Steps 0 and 1 stand still, step 2 throws the club over the top and through the floor, straight
down: there it can only move sideways, which friction forbids both ways, and step 3 has no
solution."""


def written_scenario(folder, text=PUSH, name="scene.toml"):
    """A scenario file with its URDFs next to it."""
    for urdf, file in ((RAIL, "rail.urdf"), (BALL, "ball.urdf"), (CLUB, "club.urdf")):
        urdf_of_text(folder, urdf, file)
    path = folder / name
    path.write_text(text)
    return path


FLOOR = {"halfspace": {"normal": [0, 0, 1], "offset": 0}}


def scene(bodies, contacts, steps, h=0.01, shapes=None, fast=False, **more):
    """A scenario with a floor; of each contact (alpha, beta, mu_v, k), and mu_omega if any."""
    tables = {}
    for name, (alpha, beta, mu_v, k, *mu_omega) in contacts.items():
        tables[name] = {"alpha": alpha, "beta": beta, "mu_v": mu_v, "k": k, "rows": 4}
        if any(mu_omega):
            tables[name] |= {"mu_omega": mu_omega[0], "rows": 6}
    shapes = {"floor": FLOOR} | (shapes or {})
    scene = {"h": h, "steps": steps, "bodies": bodies, "shapes": shapes, "contacts": tables}
    return load_scenario(scene | more, fast=fast)

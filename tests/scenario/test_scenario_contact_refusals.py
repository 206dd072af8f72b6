"""Targets, wrenches, shapes and contacts that no scenario may have, each refused by its field."""

import pytest

from quasistatic_ref.errors import InputError

K_Q = "K_q = { slide = 500, turn = 2.5 }"
FLOOR = "halfspace = { normal = [0, 0, 1], offset = 0 }"


PLATE = 'alpha = "rail/plate"'


REFUSALS = {
    # targets and wrenches
    "a target of an unknown joint": (
        "slide = 0.02",
        "slid = 0.02",
        "bodies.rail.targets[1].slid: is not an actuated joint of this body; did you mean 'slide'?",
    ),
    "a target of what is not actuated": (
        '"turn"]\nK_q = { slide = 500, turn = 2.5 }',
        "]\nK_q = { slide = 500 }",
        "bodies.rail.targets[0].turn: is not an actuated joint",
    ),
    "a target without t": ("t = 0.1\nslide", "slide", "bodies.rail.targets[1].t: is missing"),
    "a target NaN": (
        "slide = 0.02",
        "slide = nan",
        "bodies.rail.targets[1].slide: must be a finite number (got nan)",
    ),
    "targets at one time": (
        "t = 0.1\nslide",
        "t = 0.0\nslide",
        "targets of rail/slide: waypoint times must increase",
    ),
    "targets a table": (
        "[[bodies.rail.targets]]\nt = 0.0\nslide = 0.0\nturn = 0.0\n\n[[bodies.rail.targets]]",
        "[bodies.rail.targets]",
        "bodies.rail.targets: must be a list",
    ),
    "a force of two numbers": (
        "force = [0, 0.1, 0]",
        "force = [0, 0.1]",
        "bodies.ball.wrenches[1].force: must be 3 numbers (got [0, 0.1])",
    ),
    "an unknown field of a wrench": (
        "torque =",
        "moment =",
        "bodies.ball.wrenches[1].moment: is unknown",
    ),
    "wrenches at one time": (
        "t = 0.1\nforce",
        "t = 0.0\nforce",
        "bodies.ball.wrenches: must have increasing times t (got [0.0, 0.0])",
    ),
    # shapes
    "no shape": (
        FLOOR,
        "",
        "shapes.floor.shape: must be exactly one of halfspace, box, sphere, cylinder, capsule",
    ),
    "an unknown shape": (
        FLOOR,
        "pyramid = { radius = 1 }",
        "shapes.floor.shape: must be exactly one of",
    ),
    "two shapes": (
        FLOOR,
        FLOOR + "\nsphere = { radius = 1 }",
        "shapes.floor.shape: must be exactly one of",
    ),
    "a half-space without normal": (
        FLOOR,
        "halfspace = { offset = 0 }",
        "shapes.floor.halfspace.normal: is missing",
    ),
    "a normal of zero": (
        "normal = [0, 0, 1]",
        "normal = [0, 0, 0]",
        "shapes.floor.halfspace: must not be zero (got [0.0, 0.0, 0.0])",
    ),
    "a negative radius": (
        FLOOR,
        "sphere = { radius = -1 }",
        "shapes.floor.sphere.radius: must be greater than 0 (got -1)",
    ),
    "a flat box": (
        FLOOR,
        "box = { size = [1, 0, 1] }",
        "shapes.floor.box: must be three positive lengths",
    ),
    "an unknown size": (
        FLOOR,
        "sphere = { radius = 1, length = 2 }",
        "shapes.floor.sphere.length: is unknown",
    ),
    "a shape named as a body": (
        "[shapes.floor]",
        "[shapes.ball]\nsphere = { radius = 1 }\n[shapes.floor]",
        "shapes.ball: is the name of a body as well",
    ),
    # contacts
    "an unknown name": (
        'alpha = "floor"',
        'alpha = "flor"',
        "contacts.floor.alpha: names nothing here; did you mean 'floor'?",
    ),
    "an unknown name in a list": (
        PLATE,
        'alpha = ["rail/plat"]',
        "contacts.push.alpha: names nothing here; did you mean 'rail/plate'?",
    ),
    "a name that is a number": (
        PLATE,
        "alpha = 3",
        "contacts.push.alpha: must be a name or a list of names (got 3)",
    ),
    "no names": (PLATE, "alpha = []", "contacts.push.alpha: must name at least one shape (got [])"),
    "a link without shape": (
        PLATE,
        'alpha = "rail/wheel"',
        "contacts.push.alpha: has no collision shape; add one, or give a cloud (got 'rail/wheel')",
    ),
    "alpha missing": (PLATE + "\n", "", "contacts.push.alpha: is missing"),
    "mu_v missing": ("mu_v = 0.3\n", "", "contacts.push.mu_v: is missing"),
    "mu_v negative": (
        "mu_v = 0.3",
        "mu_v = -0.3",
        "contacts.push.mu_v: must be at least 0 (got -0.3)",
    ),
    "mu_v NaN": (
        "mu_v = 0.3",
        "mu_v = nan",
        "contacts.push.mu_v: must be a finite number (got nan)",
    ),
    "mu_omega missing with torsion": (
        "mu_omega = 0.01\n",
        "",
        "contacts.floor.mu_omega: is missing",
    ),
    "mu_omega negative": (
        "mu_omega = 0.01",
        "mu_omega = -1",
        "contacts.floor.mu_omega: must be at least 0 (got -1)",
    ),
    "five rows": ("rows = 4", "rows = 5", "contacts.push.rows: must be 4 or 6 (got 5)"),
    "no points": ("rows = 4", "rows = 4\nk = 0", "contacts.push.k: must be at least 1 (got 0)"),
    "a body on itself": (
        PLATE,
        'alpha = "ball"',
        "contacts.push: both shapes are fixed to the same link",
    ),
    "an unknown field of a contact": (
        "mu_v = 0.3",
        "mu = 0.3",
        "contacts.push.mu: is unknown; did you mean 'mu_v'?",
    ),
    "a field too many": (
        "mu_v = 0.3",
        "mu_v = 0.3\nmu = 1",
        "contacts.push.mu: is unknown; did you mean 'mu_v'?",
    ),
}


@pytest.mark.parametrize(("old", "new", "says"), REFUSALS.values(), ids=REFUSALS)
def test_what_moves_and_meets_is_refused_with_its_file_field_and_value(
    load, tmp_path, old, new, says
):
    with pytest.raises(InputError) as caught:
        load((old, new))
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'scene.toml'}: {says}")
    assert "\n" not in message

"""What a scenario may not say is refused in one sentence with its file, field and value."""

import tomllib

import pytest

from quasistatic_ref.errors import InputError, ScenarioError
from quasistatic_ref.scenario.scenario import load_scenario
from tests.model.urdf.urdf_texts import collision, joint, link, mimic, robot, written
from tests.scenes import PUSH

K_Q = "K_q = { slide = 500, turn = 2.5 }"


SETTING_REFUSALS = {
    "no value": ("h", "--set: must read dotted.key=value (got 'h')"),
    "no key": ("=1", "--set: must read dotted.key=value (got '=1')"),
    "an empty part": ("a..b=1", "--set: must read dotted.key=value (got 'a..b=1')"),
    "through a number": ("h.x=1", "--set: does not lead to a table (got 'h.x=1')"),
    "an unknown field": (
        "contacts.floor.mu=1",
        "contacts.floor.mu: is unknown; did you mean 'mu_v'",
    ),
    "an unknown contact": (
        "contacts.flor.mu_v=1",
        "contacts.flor: is no table of this file; did you mean 'floor'?",
    ),
    "NaN": ("h=nan", "h: must be a finite number (got nan)"),
    "a word for a number": ("h=fast", "h: must be a number (got 'fast')"),
}


@pytest.mark.parametrize(("setting", "says"), SETTING_REFUSALS.values(), ids=SETTING_REFUSALS)
def test_a_setting_that_does_not_fit_is_refused(load, tmp_path, setting, says):
    with pytest.raises(ScenarioError) as caught:
        load(settings=[setting])
    assert str(caught.value).startswith(f"{tmp_path / 'scene.toml'}: {says}")


PLATE = 'alpha = "rail/plate"'


REFUSALS = {
    # top
    "broken TOML": ("h = 0.01", "h = = 0.01", "is not TOML: "),
    "another format": ("ref/scenario", "ref/step", "format: must be 'quasistatic-ref/scenario'"),
    "a later version": (
        "version = 1",
        "version = 2",
        "version: is not known here; this program reads 1 (got 2)",
    ),
    "an unknown field": (
        "steps = 5",
        "steps = 5\nstep = 6",
        "step: is unknown; did you mean 'steps'?",
    ),
    "an unknown table": (
        "[shapes.floor]",
        "[shape.x]\n[shapes.floor]",
        "shape: is unknown; did you mean 'shapes'?",
    ),
    "h NaN": ("h = 0.01", "h = nan", "h: must be a finite number (got nan)"),
    "h zero": ("h = 0.01", "h = 0.0", "h: must be greater than 0 (got 0.0)"),
    "h infinite": ("h = 0.01", "h = inf", "h: must be a finite number (got inf)"),
    "h missing": ("h = 0.01\n", "", "h: is missing"),
    "half a step": ("steps = 5", "steps = 5.5", "steps: must be a whole number (got 5.5)"),
    "negative steps": ("steps = 5", "steps = -1", "steps: must be at least 0 (got -1)"),
    "gravity a number": (
        "gravity = [0, 0, -9.81]",
        "gravity = -9.81",
        "gravity: must be 3 numbers (got -9.81)",
    ),
    "gravity NaN": ("-9.81", "nan", "gravity: must hold finite numbers only (got [0, 0, nan])"),
    "an unknown cone": (
        "steps = 5",
        'steps = 5\ncone = "cube"',
        "cone: must be one of pyramid, ellipsoid, product, facets-K, frictionless, "
        "with K even and 4 to 1024 (got 'cube')",
    ),
    "an unknown record": (
        "steps = 5",
        'steps = 5\nrecord = "ful"',
        "record: is not a choice; did you mean 'full'?",
    ),
    "an unknown certificate": (
        "[shapes.floor]",
        '[solver]\ncertify = "ful"\n[shapes.floor]',
        "solver.certify: is not a choice",
    ),
    "a solver's own option": (
        "[shapes.floor]",
        "[solver]\neps = 1\n[shapes.floor]",
        "solver.eps: is unknown",
    ),
    # bodies
    "no URDF": ('urdf = "ball.urdf"\n', "", "bodies.ball.urdf: is missing"),
    "an unknown base": (
        'base = "floating"',
        'base = "flying"',
        "bodies.ball.base: is not a choice",
    ),
    "an unknown joint": (
        '"slide", "turn"]',
        '"slid", "turn"]',
        "rail.actuated: has no such joint; did you mean 'slide'?",
    ),
    "actuated a word": (
        '["slide", "turn"]',
        '"slide"',
        "bodies.rail.actuated: must be a list of joint names, or \"all\" (got 'slide')",
    ),
    "an unknown field of a body": (
        'base = "floating"',
        'bass = "floating"',
        "bodies.ball.bass: is unknown; did you mean 'base'?",
    ),
    "an unknown field of a pose": (
        "pose = { xyz",
        "pose = { xzy",
        "bodies.ball.pose.xzy: is unknown; did you mean 'xyz'?",
    ),
    "a pose of two numbers": (
        "[0.065, 0, 0.05]",
        "[0.065, 0]",
        "bodies.ball.pose.xyz: must be 3 numbers (got [0.065, 0])",
    ),
    "a position of a mimic or none": (
        K_Q,
        K_Q + "\npositions = { slid = 1 }",
        "rail.positions: has no such joint; did you mean 'slide'?",
    ),
    "a position NaN": (
        K_Q,
        K_Q + "\npositions = { slide = nan }",
        "bodies.rail.positions.slide: must be a finite number",
    ),
    "a body called world": (
        "[bodies.rail]",
        "[bodies.world]\nurdf = 'rail.urdf'\n[bodies.rail]",
        "body.name: must be a name other than 'world'",
    ),
    # K_q
    "K_q missing": (K_Q + "\n", "", "bodies.rail.K_q: is missing for slide, turn"),
    "K_q of one joint missing": (K_Q, "K_q = { slide = 500 }", "bodies.rail.K_q.turn: is missing"),
    "K_q of an unknown joint": (
        K_Q,
        "K_q = { slide = 5, turn = 2, spin = 1 }",
        "bodies.rail.K_q.spin: is unknown",
    ),
    "K_q zero": (
        K_Q,
        "K_q = { slide = 0, turn = 2.5 }",
        "bodies.rail.K_q.slide: must be greater than 0 (got 0)",
    ),
    "K_q zero in a list": (
        K_Q,
        "K_q = { slide = [0], turn = 2.5 }",
        "bodies.rail.K_q.slide: must be greater than 0 in every",
    ),
    "K_q too long": (
        K_Q,
        "K_q = { slide = [5, 5], turn = 2.5 }",
        "bodies.rail.K_q.slide: must be 1 numbers (got [5, 5])",
    ),
    "K_q a word": (
        K_Q,
        'K_q = { slide = "stiff", turn = 2.5 }',
        "bodies.rail.K_q.slide: must be a number (got 'stiff')",
    ),
    "K_q a matrix too small": (
        K_Q,
        "K_q = [[500]]",
        "bodies.rail.K_q: must be 2 x 2 numbers (got [[500]])",
    ),
    "K_q of what is not actuated": (
        'base = "floating"',
        'base = "floating"\nK_q = { base = 1 }',
        "bodies.ball.K_q.base: is unknown",
    ),
}


@pytest.mark.parametrize(("old", "new", "says"), REFUSALS.values(), ids=REFUSALS)
def test_a_scenario_is_refused_with_its_file_field_and_value(load, tmp_path, old, new, says):
    with pytest.raises(InputError) as caught:
        load((old, new))
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'scene.toml'}: {says}")
    assert "\n" not in message


def test_two_clouds_cannot_touch(load, tmp_path):
    (tmp_path / "c.csv").write_text("x,y,z\n0,0,0.1\n")
    with pytest.raises(InputError, match=r"contacts\.push: two clouds cannot touch"):
        load(
            ('base = "floating"', 'base = "floating"\ncloud = "c.csv"'),
            (K_Q, K_Q + '\ncloud = "c.csv"'),
            (PLATE, 'alpha = "rail"'),
        )


def test_a_mimic_has_no_target(tmp_path):
    text = robot(
        link("a"), link("b", collision('<sphere radius="1"/>')), link("c"), joint("j", "a", "b"),
        joint("m", "a", "c", more=mimic("j")),
    )  # fmt: skip
    written(tmp_path, text, "m.urdf")
    path = tmp_path / "s.toml"
    path.write_text(
        'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n[bodies.m]\n'
        'urdf = "m.urdf"\nactuated = "all"\nK_q = { j = 1 }\n[[bodies.m.targets]]\nt = 0\nm = 1\n'
    )
    with pytest.raises(InputError, match=r"bodies.m.targets\[0\].m: is not an actuated joint"):
        load_scenario(path)


MISSING_FILES = {
    "the URDF": ('urdf = "ball.urdf"', 'urdf = "none.urdf"', "none.urdf"),
    "the cloud": ('base = "floating"', 'base = "floating"\ncloud = "none.csv"', "none.csv"),
}


@pytest.mark.parametrize(("old", "new", "file"), MISSING_FILES.values(), ids=MISSING_FILES)
def test_a_missing_file_is_named_where_it_was_looked_for(load, tmp_path, old, new, file):
    with pytest.raises(InputError) as caught:
        load((old, new))
    assert str(caught.value) == f"{tmp_path / file}: no such file"


def test_a_scenario_without_bodies_is_refused(tmp_path):
    path = tmp_path / "s.toml"
    head = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
    path.write_text(head + "[bodies]\n")
    with pytest.raises(ScenarioError, match="bodies: holds no body"):
        load_scenario(path)
    path.write_text(head)
    with pytest.raises(ScenarioError, match="bodies: is missing"):
        load_scenario(path)


CONTENTS = {
    "empty": (b"", "format: is missing"),
    "not text": (b"\xff\xfe", "line 1: is not UTF-8 text"),
    "nested too deeply": (b"a = " + b"[" * 100_000, "is nested too deeply"),
    "a number of too many digits": (b"h = " + b"1" * 5000, "is nested too deeply, or holds an"),
}


@pytest.mark.parametrize(("content", "says"), CONTENTS.values(), ids=CONTENTS)
def test_what_is_no_scenario_is_refused_in_words(tmp_path, content, says):
    path = tmp_path / "s.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    assert str(caught.value).startswith(f"{path}: {says}")


HOSTILE = (
    '"x"', '""', '"../x"', "nan", "-1", "0", "true", "[]", "{}", "[[1]]", "[nan, 0, 0]", "[{}]",
    '["x"]', "1979-05-27", "1" + "0" * 400, "{ a = { b = 1 } }", "[{ t = 1 }, { t = 0 }]",
)  # fmt: skip


def fields(table, above=()):
    """The dotted name of every field of a table and of the tables in it."""
    for key, value in table.items():
        yield ".".join((*above, key))
        if isinstance(value, dict):
            yield from fields(value, (*above, key))


@pytest.mark.parametrize("field", list(fields(tomllib.loads(PUSH))))
def test_no_value_of_any_field_is_more_than_refused(load, field):
    refusals = []
    for value in HOSTILE:
        try:
            load(settings=[f"{field}={value}"])
        except InputError as refused:
            refusals.append(str(refused))
    assert not [words for words in refusals if "\n" in words]
    loaded = len(HOSTILE) - len(refusals)
    assert loaded <= 6, "nearly any value is accepted"

"""Errors are sentences that carry the data behind them."""

import pickle

import pytest

from quasistatic_ref import (
    InputError,
    QuasistaticError,
    Sphere,
    StepNotSolved,
    errors,
    load_scenario,
)
from quasistatic_ref.formats.quoting import LONGEST, MOST_NAMES, suggestion
from tests.helpers import point_on_floor


def own_errors():
    return [e for e in vars(errors).values() if isinstance(e, type) and issubclass(e, Exception)]


def test_there_is_one_root():
    assert len(own_errors()) > 5
    assert all(issubclass(error, QuasistaticError) for error in own_errors())


def test_bad_input_and_an_unsolved_step_are_two_families():
    assert not issubclass(StepNotSolved, InputError)
    for name in ("StepDataError", "ModelError", "ContactError", "ScenarioError", "BackendError"):
        assert issubclass(getattr(errors, name), InputError)


@pytest.mark.parametrize(
    ("kind", "wrong"),
    [
        (ValueError, lambda run: Sphere(-1)),
        (ValueError, lambda run: load_scenario("no_such_scene")),
        (KeyError, lambda run: run["phy"]),
        (KeyError, lambda run: run.pair_forces()["roof"]),
    ],
)
def test_bad_input_is_an_error_of_python_s_too_and_says_its_plain_sentence(kind, wrong):
    run = load_scenario("sphere_spin", steps=1).run(progress=False)
    with pytest.raises(kind) as caught:
        wrong(run)
    assert isinstance(caught.value, InputError)
    assert str(caught.value) == str(InputError(caught.value.problem, **fields(caught.value)))
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def fields(error):
    return {name: getattr(error, name) for name in ("field", "value", "file")}


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (InputError("is missing"), "is missing"),
        (InputError("is missing", field="a.b"), "a.b: is missing"),
        (InputError("must be > 0", field="h", value=-1.0), "h: must be > 0 (got -1.0)"),
        (InputError("is bad", file="x.toml"), "x.toml: is bad"),
        (InputError("is bad", field="h", value=0, file="x.toml"), "x.toml: h: is bad (got 0)"),
    ],
)
def test_an_input_error_says_where_what_and_what_it_got(error, says):
    assert str(error) == says


def test_a_long_value_is_cut_to_a_line():
    text = str(InputError("is too long", value=list(range(1000))))
    assert len(text) < 110
    assert text.endswith("...)")
    assert "\n" not in str(InputError("is odd", value="a\nb"))


LONG = "a" * 10_000
LONG_NAMES = "a." * 40_000


@pytest.mark.parametrize(
    "error",
    [
        InputError("is bad", field=LONG_NAMES),
        InputError("is bad", file=f"/{LONG}"),
        InputError(f"names {LONG} twice"),
        InputError(f"is unknown{suggestion(LONG, ['x', LONG + 'b'])}", field=LONG, value=LONG),
        InputError(f"is unknown{suggestion('abc', [f'name_{i:0200d}' for i in range(9999)])}"),
        QuasistaticError(f"{LONG} is bad"),
    ],
)
def test_a_sentence_repeats_no_more_than_200_characters_of_anything(error):
    assert max(len(word) for word in str(error).split()) <= LONGEST + len("mean '?:,")
    assert len(str(error)) <= (MOST_NAMES + 5) * LONGEST


def test_the_file_is_added_once():
    error = InputError("is bad").in_file("inner.toml").in_file("outer.toml")
    assert str(error) == "inner.toml: is bad"


def test_an_unsolved_step_carries_what_replays_it():
    step = point_on_floor()
    error = StepNotSolved("osqp", "user_limit", step, 1e-9)
    assert (error.backend, error.status, error.accuracy) == ("osqp", "user_limit", 1e-9)
    assert error.step is step
    assert error.residuals is None
    assert "osqp did not solve the step (user_limit; accuracy 1e-09)" in str(error)


def test_the_nearest_name_is_suggested_and_the_known_ones_are_listed():
    assert suggestion("clarable", ["osqp", "clarabel"]) == (
        "; did you mean 'clarabel'? known: clarabel, osqp"
    )
    assert suggestion("zzz", ["osqp"]) == "; known: osqp"
    assert suggestion("zzz", []) == "; known: none"

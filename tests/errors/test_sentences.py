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
from quasistatic_ref.quoting import LONGEST, MOST_NAMES, suggestion


def test_there_is_one_root():
    own = [e for e in vars(errors).values() if isinstance(e, type) and issubclass(e, Exception)]
    assert len(own) > 5
    assert all(issubclass(error, QuasistaticError) for error in own)


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
    run = load_scenario("sphere_spin", steps=1).run()
    with pytest.raises(kind) as caught:
        wrong(run)
    assert isinstance(caught.value, InputError)
    error = caught.value
    plain = InputError(error.problem, field=error.field, value=error.value, file=error.file)
    assert str(error) == str(plain) == str(pickle.loads(pickle.dumps(error)))


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

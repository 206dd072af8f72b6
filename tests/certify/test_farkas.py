"""Contradictory steps: the proof, its words, and rows that are nearly contradictory."""

from fractions import Fraction as F

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    StepIllPosed,
    StepInfeasible,
    StepNotSolved,
    solve_step,
    verify_answer,
)
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.norm import relative_length
from tests.helpers import EAST, NORTH, WEST, point_between_walls, sphere_on_floor
from tests.made import free_step, no_contacts


def test_walls_that_overlap_are_infeasible_and_named():
    """X >= 1 mm and -x >= 3 mm add up to 0 >= 4 mm."""
    step = point_between_walls([NORTH, EAST, WEST], [1.0, -1e-3, -3e-3])
    with pytest.raises(StepInfeasible) as failure:
        solve_step(step)
    error = failure.value
    assert isinstance(error, StepNotSolved)
    assert error.step is step
    assert error.status == "infeasible"
    assert set(error.farkas.owners) == {"c1", "c2"}
    assert all(word in str(error) for word in ("c1", "c2", "contradict"))
    y = [F(text) for text in error.farkas.exact]
    assert max(y) == 1
    assert error.farkas.y.tolist() == [*map(float, y)]
    assert error.farkas.contradiction == float(F(1e-3) + F(3e-3))
    assert farkas_refutation(step, error.farkas.exact) is None


def test_false_proofs_are_refused_with_a_reason():
    step = point_between_walls([EAST, WEST], [-1e-3, -3e-3])
    right = ["1", "0", "0", "0", "1", "0", "0", "0"]
    assert farkas_refutation(step, right) is None
    assert farkas_refutation(step, ["1/3", "0", "0", "0", "1/6", "1/6", "0", "0"]) is None
    for wrong, reason in (
        (right[:-1], "entries"),
        (["1", "0", "0", "0", "2", "0", "0", "0"], "A'y"),
        (["1", "0", "0", "0", "1", "0", "-1", "1"], "negative"),
        (["0"] * 8, "b'y"),
        (["x", *right[1:]], "fractions"),
        (["1/0", *right[1:]], "fractions"),
        (["1e999999999", *right[1:]], "fractions"),
    ):
        assert reason in farkas_refutation(step, wrong)
    apart = point_between_walls([EAST, WEST], [1e-3, -1e-3])  # x >= -1 mm, -x >= 1 mm: x = -1 mm
    assert "b'y" in farkas_refutation(apart, right)
    assert solve_step(apart).delta_q.tolist() == [-1e-3, 0.0, 0.0]


@pytest.mark.parametrize(("k", "is_refused"), [(19, False), (21, True)])
def test_length_counts_from_the_push_that_the_step_wants(k, is_refused):
    """X + e y >= b and -x + e y >= b with e = 2^-k: x = 0, y = b / e, M = 1.

    Each row alone is satisfied at the distance b, nearly, and the force f = b / h^2 along z moves
    by b: y is 2^k times longer. 2^19 < 1e6 < 2^21 < 4e6.
    """
    b = 2.0**-10
    e = 2.0**-k
    pair = Extra(("one", "two"), [[1.0, e, 0], [-1.0, e, 0]], np.full(2, b))
    step = free_step(np.eye(3), [0.0, 0.0, 4 * b], no_contacts(3), 0.5).replace(extra=pair)
    if is_refused:
        with pytest.raises(StepIllPosed, match="contradict") as failure:
            solve_step(step)
        assert failure.value.length == pytest.approx(2.0**k, rel=1e-9)
    else:
        assert solve_step(step).delta_q.tolist() == [0.0, b / e, b]


@pytest.mark.parametrize("tau", [5e-324, 1e-322, 1e-300])
def test_a_free_body_is_not_ill_posed_however_small_its_load(tau):
    """M = 2^-20, h = 2^-10: delta_q = h^2 tau / M = tau, the whole of the unconstrained step.

    Of the first two loads the impulse h tau rounds to zero.
    """
    step = free_step(2.0**-20 * np.eye(1), [tau], no_contacts(1), 2.0**-10)
    delta_q = solve_step(step).delta_q
    assert delta_q.tolist() == [tau]
    assert relative_length(step, delta_q) == pytest.approx(1, rel=1e-12)


def test_a_row_of_zeros_is_to_be_left_out():
    step = sphere_on_floor()
    nothing = Extra(("nothing",), np.zeros((1, 6)), [1e-3])
    with pytest.raises(StepInfeasible, match=r"\(nothing\) .* are all zero, .*: leave it out$"):
        solve_step(step.replace(extra=nothing))
    walls = Extra(("up", "down"), np.eye(6)[2] * [[1], [-1]], [1e-3, 1e-3])
    with pytest.raises(StepInfeasible, match="widen these gaps"):
        solve_step(step.replace(extra=walls))


@pytest.mark.parametrize("active", [(), ((0, 0),)])
def test_an_answer_of_another_length_is_called_that(active):
    step = sphere_on_floor()
    solution = solve_step(step)
    short = verify_answer(step, solution.delta_q[:-1], active)
    assert short.reason == "delta_q has shape (5,); the step wants (6,)"
    long = verify_answer(step, solution.delta_q, active, np.zeros(step.m + 1))
    assert long.reason == f"lam has shape ({step.m + 1},); the step wants ({step.m},)"

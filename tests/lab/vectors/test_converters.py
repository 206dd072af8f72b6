"""Other conventions: declared in the answers, or converted by hand, there and back."""

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.converters import tangent_map, xyzw
from tests.lab.vectors.committed_cases import report_on, right_answers, small_cases


@pytest.mark.parametrize("tangent", ["world", "mujoco"])
@pytest.mark.parametrize("layer", ["jacobian", "step"])
def test_answers_in_another_tangent_space_are_converted_if_they_say_so(layer, tangent):
    turned = {}
    for case in small_cases(layer):
        B = tangent_map(case.input["mechanism"], case.input["q"], tangent)
        turned[case.id] = in_tangent(right_answers(layer)[case.id], B)
    declared = report_on(layer, turned, tangent=tangent)
    assert declared.ok, declared.trouble
    assert report_on(layer, turned).count("failed") > 0


@pytest.mark.parametrize(("layer", "field"), [("integrate", "q"), ("step", "q_next")])
def test_quaternions_in_the_declared_order_are_converted(layer, field):
    answers = {}
    for case in small_cases(layer):
        answer = right_answers(layer)[case.id]
        if field in answer:
            q = answer[field]
            for _ in range(3):  # of four entries: the other way once
                q = xyzw(case.input["mechanism"], q)
            answers[case.id] = {**answer, field: q}
    assert report_on(layer, answers, quaternion="wxyz").ok
    assert report_on(layer, answers).count("failed") > 0


def in_tangent(output, B):
    """An output whose delta_q is B' delta_q: J B, A B, B'HB, B'g; B is orthogonal."""
    rules = {
        "J": lambda v: v @ B,
        "A": lambda v: v @ B,
        "H": lambda v: B.T @ v @ B,
        "g": lambda v: B.T @ v,
        "delta_q": lambda v: B.T @ v,
        "A_lam": lambda v: B.T @ v,
    }
    turned = {}
    for name, value in output.items():
        if name == "contacts":
            turned[name] = [in_tangent(contact, B) for contact in value]
        elif name in rules and len(value):
            turned[name] = rules[name](np.array(value)).tolist()
        else:
            turned[name] = value
    return turned

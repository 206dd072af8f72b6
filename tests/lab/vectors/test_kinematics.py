"""Layers `jacobian` and `integrate`: closed forms, exact differences, and the package's answers."""

import numpy as np
import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.integration import integrate as integrated
from quasistatic_ref.lab.program.integration import way
from quasistatic_ref.lab.program.mechanism import slices
from quasistatic_ref.lab.vectors.exact.entered import entered
from quasistatic_ref.lab.vectors.exact.precision import rounded
from quasistatic_ref.lab.vectors.families.mechanisms import (
    free_body,
    link,
    random_q,
    random_step,
)
from quasistatic_ref.lab.vectors.layers import LAYERS, layer
from quasistatic_ref.lab.vectors.own.system import own_system
from tests.lab.vectors.material import cases, report_on
from tests.tolerances import ROUNDING

FREE = {"bodies": [free_body()]}
PLANAR = {"bodies": [link("body", None, "planar")]}
A = 1.5
"""Angle of a turn about z, of which a unit step along x makes the circle (sin a, 1 - cos a) / a."""
X, Y = np.sin(A) / A, (1 - np.cos(A)) / A
STEPS = {
    # Half a turn about z: a body's own x is the world's -x.
    "along its own axes": (
        FREE,
        [1, 2, 3, 0, 0, 1, 0],
        [0.5, 0, 0, 0, 0, 0],
        [0.5, 2, 3, 0, 0, 1, 0],
    ),
    "screw": (
        FREE,
        [0, 0, 0, 0, 0, 0, 1],
        [1, 0, 0, 0, 0, A],
        [X, Y, 0, 0, 0, np.sin(A / 2), np.cos(A / 2)],
    ),
    "planar": (PLANAR, [0, 0, 1, 0], [1, 0, A], [X, Y, np.cos(A), np.sin(A)]),
    # |(1, 2, 2, 4)| = 5.
    "normalised": (FREE, [0, 0, 0, 1, 2, 2, 4], [0] * 6, [0, 0, 0, 0.2, 0.4, 0.4, 0.8]),
}


@pytest.mark.parametrize("name", ["distance", *LAYERS[1:4], "wrench", "integrate"])
def test_the_package_meets_every_case(name):
    report = report_on(name, {case.id: layer(name).own(case.input) for case in cases(name)})
    assert report.ok, report.trouble


@pytest.mark.parametrize(("mechanism", "q", "delta_q", "wanted"), STEPS.values(), ids=STEPS)
def test_a_joint_steps_as_its_closed_form(mechanism, q, delta_q, wanted):
    case = {"mechanism": mechanism, "q": q, "delta_q": delta_q}
    found = layer("integrate").expected(case).output["q"]
    np.testing.assert_allclose(found, wanted, rtol=0, atol=ROUNDING)


def test_the_jacobian_of_a_free_body_is_that_of_its_twist():
    # At the identity: velocity e_k, and e_k x r = e_k x (0, 0, 1) for a turn; spin n_k.
    contact = {"alpha_body": None, "beta_body": "object", "alpha": [0, 0, 0], "beta": [0, 0, 1]}
    contact |= {"n": [0.0, 0.6, 0.8], "d1": [1, 0, 0], "d2": [0, 0.8, -0.6]}
    case = {"mechanism": FREE, "q": [0, 0, 0, 0, 0, 0, 1], "contacts": [contact]}
    assert layer("jacobian").expected(case).output["J"] == [
        [[1, 0, 0, 0, 1, 0], [0, 1, 0, -1, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0.6, 0.8]]
    ]


def test_the_order_is_actuated_first_whatever_the_file_says():
    places, n_a, n_v = slices({"bodies": [free_body("a"), free_body("b", actuated=True)]})
    assert places == {"b": (slice(0, 7), slice(0, 6)), "a": (slice(7, 14), slice(6, 12))}
    assert (n_a, n_v) == (6, 12)


def test_a_difference_undoes_an_integration(rng):
    kinds = ("revolute", "continuous", "prismatic", "planar", "floating")
    bodies = [link(f"{kind}{a}", None, kind, actuated=a) for a in (True, False) for kind in kinds]
    tree = {"bodies": bodies}
    q, delta_q = random_q(rng, tree), random_step(rng, tree, 0.5)
    case = entered({"mechanism": tree, "q": q, "delta_q": delta_q})
    back = rounded(lambda: way(case["mechanism"], case["q"], integrated(case)["q"]))[0]
    np.testing.assert_allclose(back, delta_q, rtol=0, atol=ROUNDING)


def test_no_motion_is_exactly_zero():
    bodies = [link(kind, None, kind) for kind in ("continuous", "planar", "floating")]
    q = [0.6, 0.8, 1.0, 2.0, 0.6, 0.8, *[0.1] * 3, *[0.5] * 4]
    case = entered({"mechanism": {"bodies": bodies}, "q": q})
    assert rounded(lambda: way(case["mechanism"], case["q"], case["q"]))[0] == [0.0] * 10


def test_the_package_undoes_its_own_step_to_the_last_digits():
    # pinocchio alone loses 4e-4 of the translation at 1e-13 rad, and the angle below 1e-8.
    random = np.random.default_rng(6)
    table = {"bodies": [link("base", None, "planar"), link("wheel", "base", "continuous")]}
    system = own_system(table).system
    for angle in (1e-15, 1e-13, 1e-9, 1e-5, 1e-3, 1.0, 3.0):
        q = np.array([*random.normal(size=2), np.cos(0.3), np.sin(0.3), np.cos(2), np.sin(2)])
        step = np.array([*random.normal(size=2), angle, -angle])
        back = system.difference(q, system.integrate(q, step))
        np.testing.assert_allclose(back, step, rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    ("body", "field"),
    [({"joint": "screw"}, r"bodies\[0\].joint"), ({"parent": "nobody"}, r"bodies\[0\].parent")],
)
def test_a_mechanism_that_cannot_be_is_refused(body, field):
    with pytest.raises(InputError, match=field):
        entered({"mechanism": {"bodies": [free_body() | body]}})


def test_a_q_of_another_length_is_refused():
    with pytest.raises(InputError, match="q: must contain 7 numbers"):
        entered({"mechanism": FREE, "q": [0.0] * 6})

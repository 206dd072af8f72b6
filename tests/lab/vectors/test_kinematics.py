"""Layers `jacobian` and `integrate`: closed forms, exact differences, and the package's answers."""

import numpy as np
import pytest
from flint import ctx

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.integration import integrate as integrated
from quasistatic_ref.lab.program.integration import way
from quasistatic_ref.lab.program.mechanism import kinematics, slices
from quasistatic_ref.lab.program.step import loads
from quasistatic_ref.lab.vectors.exact.entered import entered
from quasistatic_ref.lab.vectors.exact.precision import rounded
from quasistatic_ref.lab.vectors.families.mechanisms import (
    free_body,
    link,
    random_q,
    random_step,
    random_tree,
)
from quasistatic_ref.lab.vectors.layers import LAYERS, layer
from quasistatic_ref.lab.vectors.own.system import own_system
from tests.lab.vectors.material import cases, report_on
from tests.tolerances import ROUNDING

FREE = {"bodies": [free_body()]}


@pytest.mark.parametrize("name", ["distance", *LAYERS[1:4], "wrench", "integrate"])
def test_the_package_meets_every_case(name):
    report = report_on(name, {case.id: layer(name).own(case.input) for case in cases(name)})
    assert report.ok, report.trouble


def test_a_free_body_steps_along_its_own_axes():
    # Half a turn about z: its x is the world's -x.
    case = {"mechanism": FREE, "q": [1, 2, 3, 0, 0, 1, 0], "delta_q": [0.5, 0, 0, 0, 0, 0]}
    assert layer("integrate").expected(case).output["q"] == [0.5, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0]


def test_a_screw_ends_where_its_circle_does():
    # About z by the float a with v along x: t = (sin a, 1 - cos a) / a.
    a = 1.5
    case = {"mechanism": FREE, "q": [0, 0, 0, 0, 0, 0, 1], "delta_q": [1, 0, 0, 0, 0, a]}
    q = layer("integrate").expected(case).output["q"]
    wanted = [np.sin(a) / a, (1 - np.cos(a)) / a, 0, 0, 0, np.sin(a / 2), np.cos(a / 2)]
    np.testing.assert_allclose(q, wanted, rtol=0, atol=ROUNDING)


def test_a_planar_base_goes_round_the_same_circle():
    a, tree = 0.5, {"bodies": [link("body", None, "planar")]}
    case = {"mechanism": tree, "q": [0, 0, 1, 0], "delta_q": [1, 0, a]}
    wanted = [np.sin(a) / a, (1 - np.cos(a)) / a, np.cos(a), np.sin(a)]
    np.testing.assert_allclose(
        layer("integrate").expected(case).output["q"], wanted, rtol=0, atol=ROUNDING
    )


def test_a_quaternion_of_any_length_is_normalised_exactly():
    # |(1, 2, 2, 4)| = 5.
    case = {"mechanism": FREE, "q": [0, 0, 0, 1, 2, 2, 4], "delta_q": [0] * 6}
    assert layer("integrate").expected(case).output["q"][3:] == [0.2, 0.4, 0.4, 0.8]


def test_the_tie_of_a_sum_goes_to_even():
    tree = {"bodies": [link("body", None, "prismatic")]}
    case = {"mechanism": tree, "q": [1.0], "delta_q": [2.0**-53]}
    assert layer("integrate").expected(case).output["q"] == [1.0]


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


@pytest.mark.parametrize("base", ["fixed", "floating", "planar"])
def test_body_jacobians_are_those_of_exact_differences(base):
    # (t(q (+) s e) - t(q)) / s = J e + O(s), s = 2^-60: what is left is 1e-18.
    random = np.random.default_rng(3)
    tree = random_tree(random, 4, base)
    case = entered({"mechanism": tree, "q": random_q(random, tree)})
    n_v = slices(tree)[2]

    def moved(step):
        return integrated(case | entered({"delta_q": step.tolist()}))["q"]

    def at(q):
        return [place for name, place in kinematics(case["mechanism"], q).items() if name]

    with ctx.workprec(320):
        here = at(moved(np.zeros(n_v)))
        for v in range(n_v):
            there = at(moved(np.eye(n_v)[v] / 2**60))
            for (_, t, J), (_, after, _) in zip(here, there, strict=True):
                slope = (after - t) * 2**60
                np.testing.assert_allclose(
                    slope.astype(float), J[:3, v].astype(float), rtol=0, atol=1e-15
                )


@pytest.mark.parametrize("base", ["fixed", "floating", "planar"])
def test_masses_and_gravity_are_those_of_the_package(base):
    random = np.random.default_rng(4)
    table = random_tree(random, 5, base, masses=True)
    q, gravity, n_a = random_q(random, table), [0.1, -0.2, -9.81], slices(table)[1]
    case = entered({"mechanism": table, "q": q, "gravity": gravity})
    M, force = rounded(lambda: loads(case, kinematics(case["mechanism"], np.array(case["q"]))))[0]
    mine = own_system(table)
    at_q = mine.model_q(q)
    own_force = mine.system.gravity_force(at_q, gravity)[mine.v]
    u = mine.v[n_a:] - mine.system.n_a
    own_M = mine.system.M_u(at_q)[np.ix_(u, u)]
    np.testing.assert_allclose(np.array(M)[n_a:, n_a:], own_M, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(force[n_a:], own_force[n_a:], rtol=0, atol=ROUNDING)
    assert not np.any(force[:n_a])  # that of what is actuated is compensated


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
    with pytest.raises(InputError, match="q: must hold 7 numbers"):
        entered({"mechanism": FREE, "q": [0.0] * 6})

"""Layers jacobian and integrate: formulas by hand, differences, and the package's answers."""

from itertools import islice

import numpy as np
import pytest
from flint import ctx

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.exact.integration import integrated
from quasistatic_ref.lab.vectors.exact.masses import gravity_force, mass_matrix_u
from quasistatic_ref.lab.vectors.exact.mechanism import mechanism, poses
from quasistatic_ref.lab.vectors.exact.precision import rounded
from quasistatic_ref.lab.vectors.families.integrate import integrate_cases
from quasistatic_ref.lab.vectors.families.jacobian import jacobian_cases
from quasistatic_ref.lab.vectors.families.mechanisms import (
    free_body,
    link,
    random_q,
    random_step,
    random_tree,
)
from quasistatic_ref.lab.vectors.layers import integrate, jacobian
from quasistatic_ref.lab.vectors.own.system import own_system
from tests.tolerances import ROUNDING

FREE = {"bodies": [free_body()]}
JACOBIANS = {id_: case for id_, _, case in jacobian_cases()}
INTEGRATIONS = {id_: case for id_, _, case in integrate_cases()}


def within(layer, case):
    """Largest distance of the package's answer from the expected, in tolerances."""
    expected, own = layer.expected(case), layer.own(case)
    assert expected.output.keys() == own.keys()
    ratios = [0.0]
    for key, value in expected.output.items():
        a, b = np.array(value), np.array(own[key])
        assert a.shape == b.shape
        if layer is integrate:
            b = same_sign(case["mechanism"], a, b)
        ratios.append(np.abs(a - b).max(initial=0.0) / expected.tolerance[key].absolute)
    return max(ratios)


def same_sign(table, a, b):
    """B with quaternions of a's sign: q and -q are one rotation."""
    b = b.copy()
    for body in mechanism(table).bodies:
        if body.kind == "floating":
            part = slice(body.q.start + 3, body.q.stop)
            b[part] *= np.sign(a[part] @ b[part])
    return b


def test_a_free_body_steps_along_its_own_axes():
    # Half a turn about z: its x is the world's -x.
    case = {"mechanism": FREE, "q": [1, 2, 3, 0, 0, 1, 0], "delta_q": [0.5, 0, 0, 0, 0, 0]}
    assert integrate.expected(case).output["q"] == [0.5, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0]


def test_a_screw_ends_where_its_circle_does():
    # About z by the float a with v along x: t = (sin a, 1 - cos a) / a.
    a = 1.5
    case = {"mechanism": FREE, "q": [0, 0, 0, 0, 0, 0, 1], "delta_q": [1, 0, 0, 0, 0, a]}
    q = integrate.expected(case).output["q"]
    wanted = [np.sin(a) / a, (1 - np.cos(a)) / a, 0, 0, 0, np.sin(a / 2), np.cos(a / 2)]
    np.testing.assert_allclose(q, wanted, rtol=0, atol=ROUNDING)


def test_a_planar_base_goes_round_the_same_circle():
    a, tree = 0.5, {"bodies": [link("body", None, "planar")]}
    case = {"mechanism": tree, "q": [0, 0, 1, 0], "delta_q": [1, 0, a]}
    wanted = [np.sin(a) / a, (1 - np.cos(a)) / a, np.cos(a), np.sin(a)]
    np.testing.assert_allclose(integrate.expected(case).output["q"], wanted, rtol=0, atol=ROUNDING)


def test_a_quaternion_of_any_length_is_normalised_exactly():
    # |(1, 2, 2, 4)| = 5.
    case = {"mechanism": FREE, "q": [0, 0, 0, 1, 2, 2, 4], "delta_q": [0] * 6}
    assert integrate.expected(case).output["q"][3:] == [0.2, 0.4, 0.4, 0.8]


def test_the_tie_of_a_sum_goes_to_even():
    tree = {"bodies": [link("body", None, "prismatic")]}
    case = {"mechanism": tree, "q": [1.0], "delta_q": [2.0**-53]}
    assert integrate.expected(case).output["q"] == [1.0]


def test_the_jacobian_of_a_free_body_is_that_of_its_twist():
    # At the identity: velocity e_k, and e_k x r = e_k x (0, 0, 1) for a turn; spin n_k.
    contact = {"alpha_body": None, "beta_body": "object", "alpha": [0, 0, 0], "beta": [0, 0, 1]}
    contact |= {"n": [0.0, 0.6, 0.8], "d1": [1, 0, 0], "d2": [0, 0.8, -0.6]}
    case = {"mechanism": FREE, "q": [0, 0, 0, 0, 0, 0, 1], "contacts": [contact]}
    assert jacobian.expected(case).output["J"] == [
        [[1, 0, 0, 0, 1, 0], [0, 1, 0, -1, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0.6, 0.8]]
    ]


def test_the_order_is_actuated_first_whatever_the_file_says():
    tree = mechanism({"bodies": [free_body("a"), free_body("b", actuated=True)]})
    assert [(body.name, body.v.start) for body in tree.bodies] == [("a", 6), ("b", 0)]
    assert (tree.n_a, tree.n_v, tree.n_q) == (6, 12, 14)


@pytest.mark.parametrize("base", ["fixed", "floating", "planar"])
def test_body_jacobians_are_those_of_exact_differences(base):
    # (t(q (+) s e) - t(q)) / s = J e + O(s), s = 2^-60: what is left is 1e-18.
    random = np.random.default_rng(3)
    table = random_tree(random, 4, base)
    tree, q = mechanism(table), random_q(random, table)

    def origins(at):
        return [x for t in poses(tree, at).t for x in t]

    with ctx.workprec(320):
        here = origins(integrated(tree, q, [0.0] * tree.n_v))
        at = poses(tree, q)
        for v in range(tree.n_v):
            step = [0.0] * tree.n_v
            step[v] = 2.0**-60
            there = origins(integrated(tree, q, step))
            slopes = [float((y - x) * 2**60) for x, y in zip(here, there, strict=True)]
            zero = ([0] * 3, [0] * 3)
            J = [float(x) for columns in at.columns for x in columns.get(v, zero)[0]]
            np.testing.assert_allclose(slopes, J, rtol=0, atol=1e-15)


@pytest.mark.parametrize("base", ["fixed", "floating", "planar"])
def test_masses_and_gravity_are_those_of_the_package(base):
    random = np.random.default_rng(4)
    table = random_tree(random, 5, base, masses=True)
    tree, q = mechanism(table), random_q(random, table)
    gravity = [0.1, -0.2, -9.81]
    (M, force), _ = rounded(
        lambda: [mass_matrix_u(tree, at := poses(tree, q)), gravity_force(tree, at, gravity)]
    )
    mine = own_system(table)
    at_q = mine.model_q(q)
    own_force = mine.system.gravity_force(at_q, gravity)[mine.v]
    u = mine.v[tree.n_a :] - mine.system.n_a
    own_M = mine.system.M_u(at_q)[np.ix_(u, u)]
    np.testing.assert_allclose(np.reshape(M, own_M.shape), own_M, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(force, own_force, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("id_", JACOBIANS)
def test_the_package_meets_every_jacobian(id_):
    assert within(jacobian, JACOBIANS[id_]) <= 1


@pytest.mark.parametrize("id_", INTEGRATIONS)
def test_the_package_meets_every_integration(id_):
    assert within(integrate, INTEGRATIONS[id_]) <= 1


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


def test_families_do_not_depend_on_when_they_are_made():
    assert list(islice(jacobian_cases(), 20)) == list(islice(jacobian_cases(), 20))
    assert len(JACOBIANS) == 49
    one, other = (random_step(np.random.default_rng(0), FREE, 0.5) for _ in range(2))
    assert one == other


@pytest.mark.parametrize(
    ("body", "field"),
    [({"joint": "screw"}, r"bodies\[0\].joint"), ({"parent": "nobody"}, r"bodies\[0\].parent")],
)
def test_a_mechanism_that_cannot_be_is_refused(body, field):
    with pytest.raises(InputError, match=field):
        mechanism({"bodies": [free_body() | body]})


def test_a_q_of_another_length_is_refused():
    with pytest.raises(InputError, match="q: must hold 7 numbers"):
        poses(mechanism(FREE), [0.0] * 6)

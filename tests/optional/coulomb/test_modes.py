"""How many solutions a step under Coulomb's law has: closed forms, and an enumeration.

A point of mass matrix m [[1, c], [c, 1]], along a tangent and the normal of a contact, would move
freely to (X, Z), with X, Z > 0. Its displacement under the impulses p is

    x = X + (p_t - c p_n) h / (m (1 - c^2)),    z = Z + (p_n - c p_t) h / (m (1 - c^2)).

It is open at (X, Z). It slides, p_t = -mu p_n, at z = 0 to x = X - w Z with w = -(mu + c) / (1 + mu
c), if 1 + mu c < 0 and X >= w Z. It sticks at (0, 0) if |p_t| <= mu p_n, where p_n = -(c X + Z) m /
h and p_t = -(X + c Z) m / h: again X >= w Z. So there are three solutions, or, at X = w Z, two.
"""

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    NoCoulombSolution,
    StepInfeasible,
    coulomb_solutions,
    coulomb_step,
    solve_step,
)
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.tolerances import CLOSED_FORM
from tests.closeness import assert_within
from tests.helpers import in_blocks, random_step, sphere_on_floor
from tests.optional.coulomb.test_fixed_point import guide
from tests.oracles.planar_steps import planar_contacts, planar_step
from validation.make.coulomb_modes import iteration_ends, step_verdict

C = -0.75
MU = 2.0
W = 2.5
"""-(mu + c) / (1 + mu c)."""
Z = 2.0**-14
M = 0.5
H = 2.0**-7


def leaning_point(X):
    """The point above, that would move by X and Z; all numbers are sums of few powers of two."""
    mass = M * np.array([[1.0, C], [C, 1.0]])
    J = [[[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [0.0, 0.0]]]
    return free_step(mass, mass @ [X, Z] / H**2, contacts_of(0.0, [np.eye(3)], J, MU), H)


@pytest.mark.parametrize(
    ("X", "count", "modes"),
    [
        (2 * Z, "one", {"open": (2 * Z, Z)}),
        (W * Z, "several", {"open": (W * Z, Z), "stick": (0.0, 0.0)}),
        (3 * Z, "several", {"open": (3 * Z, Z), "slide -d1": (0.5 * Z, 0.0), "stick": (0.0, 0.0)}),
    ],
)
def test_a_leaning_point_has_one_two_or_three_solutions(X, count, modes):
    step = leaning_point(X)
    found = coulomb_solutions(step)
    assert found.count == count
    ((*listed,),) = found.modes
    assert {mode.modes[0]: tuple(mode.delta_q) for mode in listed} == modes
    assert all(mode.isolated for mode in listed)
    taken = coulomb_step(step, "none")
    assert taken.found
    assert tuple(taken.delta_q) in modes.values()
    assert taken.solutions == found  # whoever has one of several is told


@pytest.mark.parametrize("seed", range(16))
def test_counts_and_solutions_are_those_of_an_enumeration(seed):
    kinds = ("floor", "anywhere", "wedge", "deep")
    step = planar_step(np.random.default_rng([7, seed]), kinds[seed % 4])
    count, wrong = step_verdict(step)
    assert not wrong, count


@pytest.mark.parametrize("seed", [0])
def test_steps_that_the_iteration_alone_does_not_find(seed):
    step = planar_step(np.random.default_rng([8, seed]), "floor")
    assert not iteration_ends(step)
    assert coulomb_step(step).found


@pytest.mark.parametrize("seed", range(12))
def test_where_the_convex_step_has_a_solution_coulombs_law_has_one(seed):
    """In every polyhedral cone, however deep contacts are: tried on planar steps in penetration."""
    step = planar_step(np.random.default_rng([9, seed]), "deep")
    try:
        solve_step(step, "none")
    except StepInfeasible:
        return
    assert coulomb_solutions(step).count in ("one", "several")
    assert coulomb_step(step, "none").found


def notch(F, angle=1.0, mu=1.0, depth=1e-4):
    """A point in a notch, so deep in both sides that it leaves them by z = depth / cos(angle).

    In the convex model z cos(angle) - depth >= mu z sin(angle), which no z > 0 satisfies where mu
    tan(angle) > 1.
    """
    sides = np.pi / 2 + np.array([angle, -angle])
    contacts = planar_contacts([-depth] * 2, sides, np.zeros((2, 2)), mu)
    return free_step(np.eye(3), [0.0, F, 0.0], contacts, 0.01)


def test_a_step_without_convex_solution_may_obey_coulombs_law():
    """It moves freely by h^2 F / m = 1e-3 m, or is held by both sides at depth / cos(angle)."""
    step = notch(10.0)
    with pytest.raises(StepInfeasible):
        solve_step(step)
    assert coulomb_step(step).found
    modes, _ = coulomb_solutions(step).modes  # the turn is a group of its own
    rises = {mode.modes: mode.delta_q[1] for mode in modes}
    assert rises["open", "open"] == pytest.approx(1e-3, rel=CLOSED_FORM)
    assert rises["slide -d1", "slide +d1"] == pytest.approx(1e-4 / np.cos(1.0), rel=CLOSED_FORM)
    assert step_verdict(step) == ("several", "")


def test_that_there_is_no_solution_is_proved_and_said():
    step = notch(-10.0)
    assert step_verdict(step) == ("none", "")
    with pytest.raises(NoCoulombSolution, match=r"^the step has no solution under Coulomb's law"):
        coulomb_step(step)


def test_a_guide_has_a_set_of_solutions_and_one_without_a_push():
    """Two walls bear any pressure: x is anything from 0 to h^2 F / m."""
    found = coulomb_solutions(guide(6.0))
    ((mode,),) = found.modes
    assert found.count == "several"
    assert not mode.isolated
    assert mode.modes == ("slide -d1", "slide -d1")
    assert "a set of solutions" in str(found)
    assert coulomb_solutions(guide(0.0)).count == "one"


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-8", "frictionless"])
def test_every_polyhedral_cone_has_its_modes(cone):
    step = random_step(np.random.default_rng(4), n_a=2, rows=(6, 4)).replace(cone=cone)
    found = coulomb_solutions(step)
    ((mode,),) = found.modes
    assert found.count == "one"
    assert_within(mode.delta_q, coulomb_step(step).delta_q, 1e-15)
    assert coulomb_solutions(in_blocks(step)) == found


def test_a_spinning_sphere_slides_about_its_normal_and_each_group_has_its_modes():
    step = sphere_on_floor(
        m=0.3, inertia=2e-4, mu_omega=0.02, wrench=(0, 0, -0.3 * 9.81, 0, 0, 0.2), h=0.01
    )
    for_x = Extra(("stop", "beam"), np.eye(2, 6), [-1.0, 0.0])  # neither is coupled to the spin
    ((mode,),) = coulomb_solutions(step).modes
    assert mode.modes == ("slide -spin",)
    stopped = coulomb_solutions(step.replace(extra=for_x))
    words = {
        name: m for (one,) in stopped.modes for name, m in zip(one.contacts, one.modes, strict=True)
    }
    assert words == {"c0": "slide -spin", "stop": "open", "beam": "closed"}


def test_what_is_not_known_is_unknown():
    step = leaning_point(3 * Z)
    assert coulomb_solutions(step, most=2).count == "unknown"
    assert coulomb_solutions(step.replace(cone="facets-18")).count == "unknown"
    curved = coulomb_solutions(step.replace(cone="ellipsoid"))
    assert (curved.count, curved.modes) == ("unknown", ())

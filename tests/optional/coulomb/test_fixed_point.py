"""The step under Coulomb's law: closed forms of what is found, and the law itself there.

A contact that slides by x from rest, with X = h^2 (F - mu m g) / m Coulomb's slip, is in the convex
model with phi + s

    z = mu x - s,   x + mu z = X,   hence   mu x = (1 - r) mu X + r s,   r = mu^2 / (1 + mu^2):

the iteration alone leads from s = 0 to x_k = (1 - r^k) X, and extrapolation from two iterates to X.
Of a sphere that spins, x is the angle, mu_omega stands for mu_v, and the rise has m where the spin
has I: r = m mu_omega^2 / (I + m mu_omega^2).
"""

import numpy as np
import pytest

from quasistatic_ref import (
    InputError,
    StepInfeasible,
    coulomb_step,
    solve_step,
    verify,
)
from quasistatic_ref.optional.friction import slip_norm
from tests.helpers import point_on_floor, random_step, sphere_on_floor
from tests.made import GRAVITY, free_step
from tests.oracles.printed_rows import along
from tests.oracles.random_steps import drawn, planar_contacts

M = 0.3
H = 0.01
WEIGHT = M * GRAVITY


def point(mu):
    """A point under twice the force that Coulomb's friction bears; x, its X and r."""
    step = point_on_floor(m=M, mu_v=mu, force=(2 * mu * WEIGHT, 0.0, -WEIGHT), h=H)
    return step, 0, H**2 * mu * GRAVITY, mu**2 / (1 + mu**2)


def sphere(mu):
    """A sphere under twice the torque that Coulomb's friction bears; its angle, X and r."""
    inertia = 2e-4
    load = (0.0, 0.0, -WEIGHT, 0.0, 0.0, 2 * mu * WEIGHT)
    step = sphere_on_floor(m=M, inertia=inertia, mu_omega=mu, wrench=load, h=H)
    return step, 5, H**2 * mu * WEIGHT / inertia, M * mu**2 / (inertia + M * mu**2)


@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
@pytest.mark.parametrize(
    ("scene", "mu"),
    [(point, 0.5), (point, 50.0), (sphere, 0.01), (sphere, 0.5)],
)
def test_point_and_sphere_slip_by_coulombs_law_however_slowly_s_converges(scene, mu, cone):
    """The iteration alone needs -27.6 / log(r) steps for 1e-12: 700 at mu_v = 5."""
    step, sliding, X, r = scene(mu)
    at_end = coulomb_step(step.replace(cone=cone), "daqp" if cone == "pyramid" else None)
    assert at_end.converged
    assert at_end.s_iterations <= 5
    assert at_end.delta_q[sliding] == pytest.approx(X, rel=1e-11 / (1 - r))
    assert at_end.delta_q[2] == pytest.approx(0.0, abs=1e-11 * mu * X)
    first = solve_step(step.replace(cone=cone))
    assert first.delta_q[sliding] == pytest.approx((1 - r) * X, rel=1e-10)


PLANAR = ("floor", "anywhere", "wedge")
"""One to four contacts, friction up to 5, exact ties and normals that face each other."""


def steps_of(kind):
    """Some random steps of a cone, or planar ones."""
    if kind in PLANAR:
        return [drawn(seed, kind) for seed in range(5)]
    rng = np.random.default_rng(3)
    return [random_step(rng).replace(cone=kind) for _ in range(1 if kind == "ellipsoid" else 4)]


@pytest.mark.parametrize(
    "kind", ["pyramid", "ellipsoid", "product", "facets-8", "frictionless", *PLANAR]
)
def test_a_solution_has_coulombs_law_and_nothing_that_bears_lifts_off(kind):
    """0 <= gap _|_ f_n >= 0, and friction does all the work that its cone allows against slip."""
    bearing = 0
    for step in steps_of(kind):
        at_end = coulomb_step(step, None if kind == "ellipsoid" else "daqp")
        assert at_end.converged
        assert verify(at_end)
        c = step.contacts
        motion = c.J @ at_end.delta_q
        gap = c.phi + along(c.n, motion)
        slips = np.stack([along(c.d1, motion), along(c.d2, motion), motion[:, 3]], axis=1)
        f_n = at_end.wrench[:, 2]
        longest = np.abs(at_end.delta_q).max()
        s = slip_norm(c.mu * slips, step.cone)
        np.testing.assert_allclose(at_end.s, s, atol=1e-10 * longest)
        assert gap.min() >= -1e-10 * longest
        assert np.abs(f_n * gap).max() <= 1e-10 * longest * f_n.max()
        work = (at_end.wrench[:, [0, 1, 3]] * slips).sum(axis=1)
        assert np.abs(work + f_n * s).max() <= 1e-10 * longest * f_n.max()
        bearing += int(((f_n > 0) & (s > 1e-3 * longest)).sum())
    assert bearing or kind == "frictionless"  # some contact slides under load


def test_a_step_whose_convex_step_has_no_solution_needs_a_start():
    """A point so deep in a notch that it leaves it freely, by h^2 F / m = 1 mm.

    In the convex model z cos(1) - depth >= mu z sin(1), which no z > 0 satisfies. It does where phi
    is raised by the slip of 1 mm, mu sin(1) mm.
    """
    contacts = planar_contacts(
        [-1e-4] * 2, np.pi / 2 + np.array([1.0, -1.0]), np.zeros((2, 2)), 1.0
    )
    step = free_step(np.eye(3), [0.0, 10.0, 0.0], contacts, H)
    with pytest.raises(StepInfeasible):
        coulomb_step(step)
    at_end = coulomb_step(step, start=[1e-3 * np.sin(1.0)] * 2)
    assert at_end.converged
    assert at_end.delta_q == pytest.approx([0.0, 1e-3, 0.0], abs=1e-12)


def test_a_start_that_is_not_usable_is_refused_in_a_sentence():
    step = point(0.5)[0]
    for start in ([-1.0], [np.nan], [0.0, 0.0]):
        with pytest.raises(InputError, match=r"^start: must have one length >= 0 for each contact"):
            coulomb_step(step, start=start)
    with pytest.raises(InputError, match=r"^most: must be at least 1 \(got 0\)$"):
        coulomb_step(step, most=0)

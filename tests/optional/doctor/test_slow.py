"""Slow steps of many groups at once: those that the certified step by Coulomb's law has."""

import numpy as np
import pytest

from quasistatic_ref import Sphere, coulomb_step
from quasistatic_ref.optional.doctor import slow
from quasistatic_ref.optional.doctor.scenes import Scene
from quasistatic_ref.optional.doctor.stopped import missing
from tests.optional.doctor.drawn_scenes import finger
from tests.optional.doctor.words import block, free, scene, solid


def run_of(cone="pyramid", seed=3, count=6):
    """Boxes and balls, some on each other, under drawn loads; a finger presses the first one."""
    rng = np.random.default_rng(seed)
    box = block(1.0, (0.1, 0.08, 0.06))
    ball = solid(0.3, Sphere(0.03))
    bodies = {}
    tables = {}
    for i in range(count):
        force = rng.normal(size=3) * (4.0, 4.0, 1.0)
        urdf, z = (ball, 0.03) if i % 3 == 2 else (box, 0.03)
        bodies[f"b{i}"] = free(urdf, (0.5 * i, 0, z), force, rng.normal(size=3) * 0.05)
        tables[f"c{i}"] = ("floor", f"b{i}", 0.4, 1 if i % 3 == 2 else 4, 0.01)
    bodies["top"] = free(box, (0.5, 0, 0.09), rng.normal(size=3))
    tables["on"] = ("b1", "top", 0.6, 4, 0.02)
    targets = [{"t": 0, "x": 0.0}, {"t": 1, "x": 0.05}]
    bodies["f"] = finger((-0.06, 0, 0.03), {"x": 500.0}, targets)
    tables["press"] = ("f/tip", "b0", 0.5, 1)
    unproved = {"certify": "off"}
    run = scene(bodies, tables, 4, cone=cone, solver=unproved).run(progress=False, findings=False)
    return run.header.at


def rungs_of(run, T, k=2):
    """All groups of a step of a run, and their steps at T [s]."""
    for part in Scene(run, k, run["q"][k], run["phi"][k], run.points_of(k)).parts:
        every = part.every
        rung = part.rung(np.full(len(every), T), part.level(every), every)
        assert rung.found.all()
        yield part.groups, rung


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-8"])
def test_a_rung_of_all_groups_is_the_certified_step(cone):
    """Two boxes alone, two balls, a pile, and a box with its finger: at h = T."""
    run = run_of(cone)
    for T in (0.01, 0.3):
        whole = coulomb_step(run.at(2).step.replace(h=T))
        assert whole.converged
        every = [*rungs_of(run, T)]
        assert sorted(len(rung.T) for _, rung in every) == [1, 1, 2, 2]
        for groups, rung in every:
            exact = whole.delta_q[groups.coordinates]
            np.testing.assert_allclose(rung.delta_q, exact, atol=1e-9 * np.abs(exact).max())


def test_forces_of_the_ellipsoid_obey_coulombs_law():
    """They and the loads make the motion, lie in their cones, and oppose slips on its surface."""
    T = 0.3
    for groups, rung in rungs_of(run_of("ellipsoid"), T):
        n_a = groups.n_a
        pushes = np.einsum("bci,bciv->bv", rung.forces, groups.frames) + groups.load
        spring = np.einsum("bij,bj->bi", groups.K_q, rung.delta_q[:, :n_a])
        inertia = np.einsum("bij,bj->bi", groups.M_u, rung.delta_q[:, n_a:]) / T**2
        borne = np.hstack([spring, inertia])
        np.testing.assert_allclose(borne, pushes, atol=1e-8 * np.abs(groups.load).max())
        motion = groups.motion(rung.delta_q)
        gap = groups.phi + motion[..., 2]
        f_n = rung.forces[..., 2]
        assert gap.min() > -1e-6
        assert f_n.min() > -1e-6
        assert (f_n * gap).max() < 1e-5 * f_n.max()
        slip = groups.mu * motion[..., [0, 1, 3]]
        rubs = rung.forces[..., [0, 1, 3]] / np.where(groups.mu > 0, groups.mu, 1.0)
        assert (np.linalg.norm(rubs, axis=-1) < f_n + 1e-5 * f_n.max()).all()
        work = np.vecdot(rubs, slip) + f_n * np.linalg.norm(slip, axis=-1)
        assert np.abs(work).max() < 1e-5 * f_n.max() * np.abs(slip).max()


@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_what_is_missing_depends_on_no_ladder_and_on_no_other_group(cone, monkeypatch):
    """With T that climb by factors of four, but of what a soft spring stops; and alone."""
    run = run_of(cone, seed=11)
    lacks = missing(run, 3, run.bodies_of)
    known = {body: lack for body, lack in lacks.items() if not isinstance(lack, str)}
    assert len(known) >= 2
    for body, lack in known.items():
        alone = missing(run, 3, [body])[body]
        np.testing.assert_allclose(alone.r, lack.r, rtol=1e-12)
    monkeypatch.setattr(slow, "FACTOR", 4.0)
    others = missing(run, 3, run.bodies_of)
    assert lacks.keys() == others.keys()
    free = [body for body in known if body.name != "b0"]
    assert len(free) >= 2
    for body in free:
        r = known[body].r
        np.testing.assert_allclose(r, others[body].r, atol=2e-3 * np.abs(r).max())

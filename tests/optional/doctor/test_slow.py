"""Slow steps of many groups at once: those that the certified step by Coulomb's law has."""

import numpy as np
import pytest

from quasistatic_ref import Sphere, coulomb_step
from quasistatic_ref.optional.doctor import slow
from quasistatic_ref.optional.doctor.scenes import Scene
from quasistatic_ref.optional.doctor.stopped import missing
from tests.files.urdf.urdf_texts import collision, inertial, link, robot
from tests.optional.doctor.drawn_scenes import G, finger
from tests.optional.doctor.words import (
    TIP,
    block,
    driven,
    free,
    joint,
    placed,
    scene,
    slides,
    solid,
)


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


@pytest.mark.parametrize(
    ("cone", "most"), [("pyramid", 1e-9), ("product", 1e-9), ("facets-8", 1e-6)]
)
def test_a_rung_of_all_groups_is_the_certified_step(cone, most):
    """Two boxes alone, two balls, a pile, and a box with its finger: at h = T.

    With eight facets the box at its finger differs by 3.3e-7 of the largest displacement.
    """
    run = run_of(cone)
    for T in (0.01, 0.3):
        whole = coulomb_step(run.at(2).step.replace(h=T))
        assert whole.converged
        every = [*rungs_of(run, T)]
        assert sorted(len(rung.found) for _, rung in every) == [1, 1, 2, 2]
        for groups, rung in every:
            exact = whole.delta_q[groups.coordinates]
            np.testing.assert_allclose(rung.delta_q, exact, atol=most * np.abs(exact).max())


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


@pytest.mark.parametrize("seed", [5, 8])
@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_what_is_missing_depends_on_no_ladder_and_on_no_other_group(cone, seed, monkeypatch):
    """With other T in the place of those that are a third of each other; and alone.

    In the ellipsoid the first box turns against its finger on four corners, which share its weight
    in many ways: no long step of it is found, and what it lacks at first is that of its T.
    """
    run = run_of(cone, seed)
    lacks = missing(run, 3, run.bodies_of)
    first = "b0" if cone == "ellipsoid" else ""
    known = {body: lack for body, lack in lacks.items() if body.name != first}
    assert {body.name for body in known} >= {"b2", "b5"}
    for body, lack in known.items():
        alone = missing(run, 3, [body])[body]
        np.testing.assert_allclose(alone.r, lack.r, rtol=1e-12)
    for factor in (2.0, 4.0):
        monkeypatch.setattr(slow, "FACTOR", factor)
        others = missing(run, 3, run.bodies_of)
        assert {body for body in others if body.name != first} == {*known}
        for body, lack in known.items():
            np.testing.assert_allclose(lack.r, others[body].r, atol=2e-3 * np.abs(lack.r).max())


def pulled(force, fingers):
    """A box of 1 kg and 0.1 m on a floor with mu_v = 0.4, pulled by a force; fingers touch it.

    Of each finger side, stiffness along x and depth of its target; across they are stiff.
    """
    box = block(1.0, (0.1, 0.1, 0.1))
    bodies = {"b": free(box, (0, 0, 0.05), force)}
    tables = {"floor": ("floor", "b", 0.4, 4)}
    for i, (side, K, e) in enumerate(fingers):
        to = [{"t": 0.0, "x": -side * e}]
        bodies[f"f{i}"] = finger((side * 0.06, 0, 0.05), {"x": K}, to)
        tables[f"f{i}"] = (f"f{i}/tip", "b", 0.5, 1)
    run = scene(bodies, tables, 1, h=1e-3, fast=True).run(progress=False, findings=False)
    (lack,) = missing(run.header.at, 0, run.header.at.bodies_of).values()
    return lack.force


FRICTION = 0.4 * G


@pytest.mark.parametrize("K", [5.0, 20.0, 50.0, 500.0])
def test_a_spring_that_is_left_behind_is_no_part_of_what_is_missing(K):
    """It pushes with 1 N along the pull, until it is at its target; then the pull goes on alone."""
    assert pulled((6.0, 0, 0), [(-1, K, 1 / K)]) == pytest.approx(6.0 - FRICTION, rel=2e-3)


@pytest.mark.parametrize("K", [(100.0, 300.0), (200.0, 200.0), (2000.0, 100.0)])
def test_two_springs_share_what_they_press_with_before_a_box_slips_between_them(K):
    """One presses with 3 N, the other with 1 N: the box moves by 2 N / (K_1 + K_2) at first.

    Then both press with N. The pull across them is along an axis of the pyramid.
    """
    N = 3.0 - K[0] * 2.0 / sum(K)
    springs = [(-1, K[0], 3.0 / K[0]), (1, K[1], 1.0 / K[1])]
    lack = pulled((0, 12.0, 0), springs)
    assert lack == pytest.approx(12.0 - FRICTION - 2 * 0.5 * N, rel=2e-3)


@pytest.mark.parametrize("kind", ["revolute", "ball"])
@pytest.mark.parametrize("K", [20.0, 1000.0])
def test_a_spring_leaves_a_bar_that_falls_from_its_joint(K, kind):
    """It presses with 1 N on the far end of a bar of 1 kg and 0.2 m, until it is at its target."""
    shape = '<origin xyz="0.1 0 0"/>'
    bar = link(
        "bar",
        collision("<box size='0.2 0.02 0.02'/>", shape),
        inertial(1.0, (1e-3, 4e-3, 4e-3), shape),
    )
    urdf = robot(link("post", inertial=""), bar, joint("j", "post", "bar", "0 1 0", kind))
    bodies = {"d": placed(urdf, (0, 0, 0.5))}
    at, to = (0.2, 0, 0.52), [{"t": 0.0, "z": -1.0 / K}]
    bodies["f"] = driven(slides("xyz", TIP), at, {"x": 1e6, "y": 1e6, "z": K}, to)
    tables = {"f": ("f/tip", "d/bar", 0.0, 1)}
    run = scene(bodies, tables, 1, h=1e-3, fast=True).run(progress=False, findings=False)
    (lack,) = missing(run.header.at, 0, run.header.at.bodies_of).values()
    assert lack.torque == pytest.approx(0.1 * G, rel=2e-3)

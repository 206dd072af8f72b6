"""Of each drawn scene the findings are those that are right by hand.

The hand values themselves are checked by other means than those of the findings.
"""

import numpy as np
import pytest
from scipy.optimize import linprog

from quasistatic_ref import coulomb_step, standard_form
from tests.optional.doctor.mistake_scenes import GRAVE
from tests.optional.doctor.drawn_scenes import (
    BOTH,
    BROKEN,
    HEALTHY,
    SEEDS,
    Draw,
    G,
    bar,
    gripped,
    pile,
    pressed_on_a_wall,
    slope,
)

TOUCHES = 1e-6
"""[m]"""


def drawn(kinds):
    """Each kind with its seeds; README's line takes one of every other kind."""
    for i, kind in enumerate(kinds):
        for seed in range(SEEDS * i, SEEDS * (i + 1)):
            marks = () if seed % (2 * SEEDS) == 0 else pytest.mark.long
            yield pytest.param(kind, seed, id=f"{kind.__name__}-{seed}", marks=marks)


def bears(run, k, pressed):
    """Whether forces in the cones of a step's contacts bear its loads: a linear program.

    A pair behind springs presses with what is `pressed`; all others as they must.
    """
    step = run.step_data(k)
    touching = np.flatnonzero(step.contacts.phi <= TOUCHES)
    step = step.replace(contacts=step.contacts.some(touching, np.arange(step.n_v)))
    _, _, A, _ = standard_form(step)
    rows = np.where(step.contacts.torsion, 6, 4)
    of = np.repeat([run.pair_names[i].partition("(")[0] for i in touching], rows)
    springs = np.array([of == name for name in pressed]).reshape(len(pressed), len(of))
    size = np.abs(step.tau_u).max()
    found = linprog(
        np.zeros(len(of)),
        A_eq=np.vstack([A[:, step.n_a :].T, springs]),
        b_eq=np.concatenate([-step.tau_u, [*pressed.values()]]) / size,
    )
    assert found.status in (0, 2), found.message
    return found.status == 0


def check_what_is_said(run, hand, also):
    """No finding is missing or undeserved, no look is open, and numbers are right to 1 %.

    That forces of single contacts are uncertain is true where several share a load.
    """
    said = {found.name: found.numbers for found in run.findings}
    said.pop("uncertain forces", None)
    assert "fixed point" not in run.header.not_looked_at
    assert all(found.grave is GRAVE[found.name] for found in run.findings)
    assert hand.keys() <= said.keys() <= hand.keys() | also
    for name, numbers in hand.items():
        seen = {key: said[name][key] for key in numbers}
        assert seen == pytest.approx(numbers, rel=0.01, abs=1e-9)


@pytest.mark.parametrize(("kind", "seed"), [*drawn(HEALTHY)])
def test_what_is_healthy_is_borne_at_its_end_and_has_no_finding(kind, seed):
    scenario, hand, pressed, also = kind(Draw(seed))
    run = scenario.run(progress=False)
    check_what_is_said(run, hand, also)
    assert hand == {}
    assert not run.scene.system.n_u or bears(run, run.steps - 1, pressed)


@pytest.mark.parametrize(("kind", "seed"), [*drawn(BROKEN), (pressed_on_a_wall, 64)])
def test_hand_values_are_said_and_hold_in_the_run_or_in_a_step_that_converges(kind, seed):
    """Of drag and layer in the run; of what is missing by Coulomb's law at 0.1 s, from the start.

    Springs that give way add m g / (K h^2) <= 1e-3 m, over the 0.1 to 1 g with which it starts.
    """
    scenario, hand, pressed, also = kind(Draw(seed))
    run = scenario.run(progress=False)
    check_what_is_said(run, hand, also)
    if "not in equilibrium" not in hand:
        (numbers,) = hand.values()
        of_pair = [name.startswith("c(") for name in run.pair_names]
        assert run["wrench"][-1, of_pair, 2].sum() == pytest.approx(numbers["normal_N"], rel=1e-3)
        return
    lacks = hand["not in equilibrium"]
    step = run.step_data(0).replace(h=0.1)
    answer = coulomb_step(step, fast=True)
    assert answer.converged
    n_u = run.scene.system.n_u
    r = -step.M_u[:n_u, :n_u] @ answer.delta_q[step.n_a :][:n_u] / step.h**2
    if n_u % 6:  # a joint, which comes first, and bystanders
        assert abs(r[0]) == pytest.approx(max(lacks.values()), rel=1e-3)
        return
    force, torque = np.linalg.norm(r.reshape(-1, 2, 3), axis=(0, 2))
    assert force == pytest.approx(lacks["missing_N"], rel=1e-3)
    assert torque == pytest.approx(lacks["missing_Nm"], rel=1e-3, abs=1e-9)
    assert not bears(run, 0, pressed)


def near_its_threshold(d, kind):
    """A slope, a grip, a bar off its centre or a pile with up to a third more or less of a load."""
    near = d.between(0.75, 1.33)
    if kind == "slope":
        _, bodies, shapes = slope(d, near * d.mu)
        return d.scene(bodies, {"c": ("slope", "b", d.mu, 4)}, 1, shapes=shapes)
    if kind == "pile":
        return d.scene(*pile(d, near), 1)
    if kind == "bar":
        *_, N, _, bodies, contacts = bar(d, 1 / near)
        return d.scene(bodies, contacts, 1, pressed={"c": 2 * N})
    N = d.m * G / (2 * d.mu * near)
    bodies = gripped(d, N, d.edge) | {"b": d.cube(0, 0, 0)}
    return d.scene(bodies, {"c": (BOTH, "b", d.mu, 1, 0.01)}, 1, pressed={"c": 2 * N})


@pytest.mark.parametrize("kind", ["slope", "grip", "bar", "pile"])
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(i, marks=pytest.mark.long) for i in range(1, 12))]
)
def test_r49_r_falls_with_t_squared_where_forces_bear_the_loads_and_else_stays(kind, seed):
    """Whether they do is asked of a linear program over the cones; springs press as they are."""
    scenario, _, pressed, _ = near_its_threshold(Draw(seed), kind)
    run = scenario.run(progress=False)
    step = run.step_data(0)
    lacks = []
    for T in (0.1, 0.3):
        slow = coulomb_step(step.replace(h=T), fast=True)
        assert slow.converged
        lacks.append(step.M_u @ slow.delta_q[step.n_a :] / T**2)
    before, after = np.linalg.norm(lacks, axis=1)
    falls = 1 / 9 if bears(run, 0, pressed) else 1.0
    assert after == pytest.approx(falls * before, rel=0.05, abs=1e-12)

"""The exact optimum where its value is known in closed form."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import load_scenario, solve_step
from quasistatic_ref.certify import optimum, step_program
from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.exact.working_set import WholeSystem
from tests.helpers import boxes_step, point_on_floor
from tests.made import bits
from tests.solvers import solver_for


def test_a_coordinate_that_does_not_move_needs_no_fractions(monkeypatch):
    """A box that slides askew does not turn: three entries are zero, which no ball shows."""
    step = boxes_step(1)

    def refused(system):
        pytest.fail("solved in fractions")

    working = optimum.step_optimum(step).working_set
    monkeypatch.setattr(WholeSystem, "solution", refused)
    delta_q = optimum.step_optimum(step, working).delta_q
    assert delta_q.astype(bool).tolist() == [True, True, True, False, False, False]


@pytest.fixture
def proofs_made(monkeypatch):
    """Of each proof that is made, the number of rows of its program."""
    made = []
    form_optimum = optimum.form_optimum

    def counted(form, *arguments):
        made.append(form.m)
        return form_optimum(form, *arguments)

    monkeypatch.setattr(optimum, "form_optimum", counted)
    return made


@pytest.mark.parametrize("fast", [False, True])
def test_a_stack_at_rest_is_proved_at_its_first_steps_alone(proofs_made, fast):
    run = load_scenario("stack", ["record=full"], steps=12, fast=fast).run(progress=False)
    assert 1 <= len(proofs_made) <= 3
    for k in range(12):
        assert bits(solve_step(run.step_data(k), "none").delta_q) == bits(run["delta_q"][k])


def test_a_group_that_rests_is_kept_beside_one_that_moves(proofs_made):
    step = boxes_step(3)
    first, *others = [group.coordinates for group, _ in group_steps(step)]
    solver = solver_for(step, "none")
    solve_step(step, solver)
    assert len(proofs_made) == len(others) + 1
    tau_u = step.tau_u.copy()
    tau_u[first] *= 1.5
    moved = step.replace(tau_u=tau_u)
    again = solve_step(moved, solver)
    assert len(proofs_made) == len(others) + 2
    fresh = solve_step(moved, "none")
    assert bits(again.delta_q) == bits(fresh.delta_q)
    assert bits(again.lam) == bits(fresh.lam)


def test_a_step_that_differs_in_one_bit_or_starts_elsewhere_is_proved(proofs_made):
    step = point_on_floor(force=(0.1, 0.0, -1.0))
    (part,) = group_steps(step)
    kept = optimum.ProofCache()
    for one, start in [(step, [0]), (step.replace(), [0]), (step.replace(), [1])]:
        optimum.optimum_by_groups(one, [(part[0], one)], [start], kept)
    assert len(proofs_made) == 2
    for name, value in {
        "h": np.nextafter(step.h, 1),
        "tau_u": np.nextafter(step.tau_u, 1),
        "contacts": step.contacts.raised(np.array([1e-300])),
        "cone": "product",
    }.items():
        other = step.replace(**{name: value})
        assert not other.same_as(step)
        optimum.optimum_by_groups(other, [(part[0], other)], [[0]], kept)
    assert len(proofs_made) == 6


ARM = """<robot name="arm"><link name="wall"/>
  <link name="upper"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="wall"/><child link="upper"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 -2"/><axis xyz="0 1 0"/></joint>
</robot>"""


@pytest.mark.parametrize("swings", [False, True])
def test_the_mass_of_each_of_40_unlike_bodies_is_inverted_once(monkeypatch, swings):
    """Also beside an arm, whose masses change from step to step."""
    inverted = []
    inverse = step_program.inverse
    monkeypatch.setattr(step_program, "inverse", lambda H: inverted.append(H) or inverse(H))
    ball = qr.Sphere(0.02)
    masses = np.linspace(0.2, 0.3, 40)
    bodies = [qr.Body.of_shape(f"{m}", ball, m, xyz=(10 * m, 0, 0.02)) for m in masses]
    arm = qr.Body("arm", ARM, base="fixed", actuated=())
    system = qr.System([*bodies, arm] if swings else bodies)
    floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
    pairs = [qr.ContactPair(one.name, floor, one, 0.5, 0.01) for one in system.shapes]
    simulator = qr.Simulator(system, pairs, h=0.02, backend="none")
    q = system.q_start
    for k in range(1, 4):
        q = simulator.step(q, [], np.full(system.n_v, 0.1 * k)).q
        assert len(inverted) == 40 + k * swings

"""M_u and H of many bodies, kept in diagonal blocks: the same bits as whole, and never whole."""

import numpy as np
import pytest

from quasistatic_ref import ModelError, StepData, StepDataError, rollout, solve_step
from quasistatic_ref.lab.scenes.piles import BOX, pile
from quasistatic_ref.lab.scenes.systems import body_text, system_of
from quasistatic_ref.model import system as of_system
from quasistatic_ref.optional.fast import posed
from quasistatic_ref.optional.fast.posed import constants
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.arrays import whole
from tests.helpers import always_in_blocks

BOXES = (2, 1, 2)


@pytest.fixture(autouse=True)
def always_sparse(monkeypatch):
    always_in_blocks(monkeypatch)


def scene():
    """A simulator of four boxes, and their force."""
    some = pile(BOXES, backend="piqp", certify="residual")
    return some.simulator, some.force


@pytest.mark.extra("fast")
def test_a_light_record_of_a_sparse_run_never_forms_M_u_or_H(monkeypatch):
    formed = []
    for module in (posed, of_system):
        monkeypatch.setattr(module, "whole", lambda M: formed.append(M) or whole(M))
    simulator, force = scene()
    q = simulator.system.q_start
    target = np.zeros(0)
    rollout(simulator, q, target, 3, force=lambda t, q: force, record="light", progress=False)
    step = simulator.step(q, target, force).step
    assert not formed
    held = {**vars(simulator.system), **simulator.constant._asdict(), **vars(step)}
    shapes = {np.shape(value) for value in held.values() if isinstance(value, np.ndarray)}
    assert (24, 24) not in shapes
    assert step.M_u.shape == step.H.shape == (24, 24)
    assert len(formed) == 2  # read, they are
    assert step.M_u is not step.M_u


@pytest.mark.extra("fast")
def test_a_checked_copy_fits_the_solver_and_a_heavier_one_does_not():
    simulator, force = scene()
    step = simulator.step(simulator.system.q_start, np.zeros(0), force).step
    solver = solver_for(step, "piqp", fast=True)
    checked = step.replace()
    assert type(checked) is StepData
    assert checked == step
    assert solver.fits(checked)
    assert not solver.fits(step.replace(M_u=2 * step.M_u))
    one, two = (solve_step(some, "clarabel", certify="full") for some in (step, checked))
    assert one == two


def spoiled_blocks(change):
    blocks = np.tile(np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0]), (3, 1, 1))
    change(blocks[-1])
    return blocks


BAD = {
    "symmetric": lambda M: M.__setitem__((0, 1), 0.1),
    "positive definite": lambda M: M.__setitem__((5, 5), 0.0),
    "finite numbers": lambda M: M.__setitem__((2, 2), np.nan),
    "out of the range": lambda M: M.__setitem__((0, 0), 1e308),
}


@pytest.mark.parametrize(("words", "change"), BAD.items(), ids=BAD)
def test_a_mass_in_the_last_block_is_refused_as_all_of_M_u_is(words, change):
    rows = np.array([4])
    said = []
    blocks = spoiled_blocks(change)
    for M_u in (blocks, whole(blocks)):
        with pytest.raises(StepDataError, match=words) as caught:
            constants(0.01, np.zeros((0, 0)), 0, M_u, rows)
        said.append(caught.value)
    assert str(said[0]) == str(said[1])
    assert said[0] == said[1]


def test_the_last_of_several_bodies_is_refused_if_its_mass_is_singular():
    # Its moment about the base, 1e18 + 1, has no room for the 1.
    mote = body_text(1.0, (1.0, 1.0, 1.0), com=(1e9, 0.0, 0.0))
    with pytest.raises(ModelError, match=r"^mote: its mass matrix M_u is singular") as caught:
        system_of({"a": BOX, "b": BOX, "mote": mote})
    assert len(caught.value.value) == 6
    assert all(name.startswith("mote/") for name in caught.value.value)

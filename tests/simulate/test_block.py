"""Arrays of a record are formed of many steps at once, with the bits of each step by itself."""

from dataclasses import replace

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.simulate.record.block import Block
from quasistatic_ref.step.contacts import stacked

FIRST = 12
"""Steps of each scene that are looked at."""


def results_of(name, **fields):
    """Results of the first steps of a scenario, none of them proved."""
    scenario = qr.load_scenario(name, {"solver.certify": "off"}, backend="daqp", **fields)
    simulator = scenario.simulator()
    here = scenario.system.q_start
    results = []
    for target in scenario.targets.over(np.arange(1.0, FIRST + 1) * scenario.h):
        results.append(simulator.step(here, target))
        here = results[-1].end
    return results, scenario.system.n_v


def with_own(result, rng, cost):
    """A result whose step has two rows and a cost of a user, which it was not solved with."""
    n_v = result.step.n_v
    rows = rng.standard_normal((2, n_v)), rng.standard_normal(2)
    of_cost = (np.eye(n_v), rng.standard_normal(n_v)) if cost else ()
    extra = qr.Extra(("one", "two"), *rows, *of_cost)
    return replace(result, step=result.step.replace(extra=extra))


@pytest.mark.parametrize("own", ["no own rows", "own rows", "own rows and a cost"])
@pytest.mark.parametrize("name", ["bunny_grasp", "stack", "door", "sphere_spin"])
@pytest.mark.parametrize("cone", ["pyramid", "product", "frictionless"])
def test_a_block_has_the_bits_of_each_step(name, cone, own):
    rng = np.random.default_rng(0)
    results, n_v = results_of(name, cone=cone)
    if own != "no own rows":
        results = [with_own(one, rng, "cost" in own) for one in results]
    block = Block(results, n_v)
    forms = [qr.standard_form(one.step) for one in results]
    for letter in "gAb":
        right = np.array([getattr(form, letter) for form in forms])
        assert (getattr(block, letter) + 0.0).tobytes() == (right + 0.0).tobytes()
    each = [(one.step.contacts, one.solution) for one in results]
    assert block.J.tobytes() == np.array([contacts.J for contacts, _ in each]).tobytes()
    motion = np.array([contacts.motion(solution.delta_q) for contacts, solution in each])
    assert block.motion.tobytes() == motion.tobytes()
    assert block.wrench.tobytes() == np.array([solution.wrench for _, solution in each]).tobytes()


def test_contacts_of_which_some_keep_all_columns_stack():
    results, n_v = results_of("stack")
    right = Block(results, n_v)
    whole = [
        replace(one, step=one.step.replace(contacts=qr.Contacts(**fields_of(one.step.contacts))))
        for one in results[::2]
    ]
    mixed = [each for pair in zip(whole, results[1::2], strict=True) for each in pair]
    assert len({one.step.contacts.own.shape for one in mixed}) == 2
    assert stacked([one.step.contacts for one in mixed]).n_c == len(right.contacts.name)
    block = Block(mixed, n_v)
    for name in ("A", "b", "J", "motion"):
        assert (getattr(block, name) == getattr(right, name)).all()


def fields_of(contacts):
    """The fields of contacts by their names, with J in the place of own columns."""
    names = ("name", "phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")
    return {name: getattr(contacts, name) for name in names}

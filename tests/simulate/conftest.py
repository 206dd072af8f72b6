"""A scenario, and rollouts of it."""

import pytest

from quasistatic_ref import rollout


@pytest.fixture
def scenario(load):
    """A plate pushes a ball over the floor, for 5 steps."""
    return load()


@pytest.fixture
def run(scenario):
    """A rollout of the scenario with other targets, forces or steps."""

    def done(target, steps=4, **options):
        q = scenario.system.q_start
        return rollout(scenario.simulator(), q, target, steps, **options)

    return done

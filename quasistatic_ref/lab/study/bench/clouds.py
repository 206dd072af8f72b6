"""What the number of points costs: the bunny's surface with more points, grasped as before."""

import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from quasistatic_ref.formats.resources import models_folder
from quasistatic_ref.lab.study.bench.grasp import Places, brute_force, by_numpy
from quasistatic_ref.lab.study.bench.timing import in_turn, microseconds, seconds
from quasistatic_ref.optional.fast.tracker.tracker import ContactTracker
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array

BRUTE = 100_000
"""The most points that are measured all at once, for comparison, more than a few times."""


def sampled(count: int) -> Array:
    """Points (count, 3) [m] spread evenly over the bunny, at random but the same each time."""
    lines = (models_folder() / "bunny_grasp" / "bunny.obj").read_text().splitlines()
    words = [line.split() for line in lines]
    points = np.array([[float(x) for x in w[1:4]] for w in words if w[:1] == ["v"]])
    corners = [[int(x.partition("/")[0]) - 1 for x in w[1:4]] for w in words if w[:1] == ["f"]]
    a, b, c = points[np.array(corners)].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    rng = np.random.default_rng(7)
    which = rng.choice(len(area), size=count, p=area / area.sum())
    u, v = np.sort(rng.random((2, count, 1)), axis=0)
    return np.asarray(a[which] * u + b[which] * (v - u) + c[which] * (1 - v))


def with_cloud(scenario: Scenario, points: Array) -> Scenario:
    """The same scenario with another cloud in place of the bunny's."""
    cloud = PointCloud(points)
    pairs = tuple(replace(p, beta=replace(p.beta, shape=cloud)) for p in scenario.pairs)
    return replace(scenario, pairs=pairs)


def clouds(at: Places, sizes: Sequence[int]) -> list[dict[str, Any]]:
    """Steps along one run with clouds of several sizes, which take turns, and their trees.

    Processor time of the thread, since means are given: a step that waits for its turn costs
    nothing. The first steps, which make the first short lists, and every later list are counted:
    `mean` is the whole run over its steps. The tree is built before, once, and listed by itself.
    """
    scenarios = {992: at.scenario} | {n: with_cloud(at.scenario, sampled(n)) for n in sizes}
    trees = {}
    for n, scenario in scenarios.items():
        trees[n] = seconds(partial(ContactTracker, scenario.pairs), time.thread_time)
    simulators = {n: by_numpy(scenario) for n, scenario in scenarios.items()}
    rounds = [
        {str(n): partial(simulator.step, q, g) for n, simulator in simulators.items()}
        for q, g in zip(at.q, at.goals, strict=True)
    ]
    times = in_turn(rounds, clock=time.thread_time)
    whole = {n: float(times[str(n)].mean()) for n in scenarios}
    rows = []
    for n, scenario in scenarios.items():
        few = at.q[:: max(1, len(at.q) // (20 if n <= BRUTE else 2))]
        brute = [{"": partial(brute_force, scenario, q)} for q in few]
        rows.append(
            {
                "points": n,
                "mean": 1e6 * whole[n],
                "median": microseconds(times[str(n)]),
                "brute_force_distances": microseconds(in_turn(brute)[""]),
                "tree_seconds": trees[n],
                "over_992": whole[n] / whole[992],
            }
        )
    return rows

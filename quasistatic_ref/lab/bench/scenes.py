"""The scenes whose steps are measured, each for this package and for MuJoCo."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.files.scenario.scenario import load_scenario
from quasistatic_ref.lab.made_steps.systems import on_link
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, PlacedShape
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import DAQP, Certify

GRAVITY = 9.81
"""[m/s^2]"""
MU_V = 0.5
"""[-]"""
MU_OMEGA = 0.01
"""[m]"""
H = 0.02
"""Time step of boxes [s]."""
SIDE = 0.04
"""Of a box [m]."""
MASS = 0.2
"""Of a box [kg]."""
APART = 0.1
"""From the middle of a box to that of the next [m]."""
PUSH = (0.56, 0.42)
"""Of each box along x and y, as a share of its weight; friction holds half of that."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A scene for both engines.

    Parameters
    ----------
    simulator : callable
        Makes a simulator: of `certify` and `fast`.
    q : ndarray, shape (n_q,)
        Where its steps begin.
    target : callable
        The target of a step that ends at a time [s], shape (n_q_a,) [m, rad].
    force : ndarray, shape (n_v,)
        [N, N m].
    model : callable
        Makes MuJoCo's model, and its data, in which q and the loads are set.
    """

    simulator: Callable[[Certify, bool], Simulator]
    q: Array
    target: Callable[[float, Array], Array]
    force: Array
    model: Callable[[], tuple[Any, Any]]


def grasp() -> Scene:
    """``bunny_grasp``; MuJoCo's is a box of the bunny's mass between two fingers."""
    scenario = load_scenario("bunny_grasp")

    def simulator(certify: Certify, fast: bool) -> Simulator:
        settings = [f"solver.certify={certify}", "record=light"]
        return load_scenario("bunny_grasp", settings, fast=fast).simulator()

    system = scenario.system
    mass = system.mass("bunny")
    return Scene(
        simulator,
        system.q_start,
        lambda t, q: scenario.targets(t),
        np.zeros(system.n_v),
        partial(held_box, scenario.h, mass),
    )


def held_box(h: float, mass: float) -> tuple[Any, Any]:
    """MuJoCo's: a box on a floor, which two fingers hold by 20 N.

    Each of the three pairs has four contacts, of which those of the fingers have torsion.

    Parameters
    ----------
    h : float
        Time step [s].
    mass : float
        Of the box [kg].
    """
    friction = "0.6 0.003 0.001"
    fingers = "".join(
        f'<body pos="{0.0499 * side} 0 0.05"><joint name="{name}" type="slide" axis="{-side} 0 0"/>'
        f'<geom type="box" size="0.01 0.03 0.03" mass="0.1" condim="4" friction="{friction}"/>'
        "</body>"
        for name, side in (("left", -1), ("right", 1))
    )
    motors = "".join(f'<motor joint="{name}" ctrlrange="0 20"/>' for name in ("left", "right"))
    return _model(
        f'<mujoco><option timestep="{h}" cone="pyramidal"/><worldbody>'
        '<geom type="plane" size="0 0 1" condim="3"/>'
        f'{fingers}<body pos="0 0 0.05"><freejoint/>'
        f'<geom type="box" size="0.04 0.05 0.05" mass="{mass!r}" friction="{friction}"/></body>'
        f"</worldbody><actuator>{motors}</actuator></mujoco>",
        lambda data: data.ctrl.fill(20.0),
    )


def boxes(count: int) -> Scene:
    """Boxes that slide on a floor, each pushed askew to its axes, and cannot touch each other."""
    solid = Box((SIDE / 2,) * 3)
    at = [(APART * i, 0.0, SIDE / 2) for i in range(count)]
    system = System([Body.of_shape(f"box{i}", solid, MASS, xyz=xyz) for i, xyz in enumerate(at)])
    floor = PlacedShape.in_world("floor", HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0))
    shapes = [on_link(system, f"box{i}/solid", solid) for i in range(count)]
    pairs = [ContactPair(f"floor-{one.name}", floor, one, MU_V, MU_OMEGA, 6, 4) for one in shapes]
    push = np.array([*PUSH, 0.0, 0.0, 0.0, 0.0]) * MASS * GRAVITY
    force = np.tile(push, count)

    def simulator(certify: Certify, fast: bool) -> Simulator:
        backend = DAQP if fast else None
        return Simulator(system, pairs, h=H, certify=certify, backend=backend)

    def model() -> tuple[Any, Any]:
        bodies = "".join(
            f'<body pos="{x} {y} {z}"><freejoint/><geom type="box" mass="{MASS}" '
            f'size="{SIDE / 2} {SIDE / 2} {SIDE / 2}"/></body>'
            for x, y, z in at
        )
        return _model(
            f'<mujoco><option timestep="{H}" cone="pyramidal"/>'
            f'<default><geom condim="4" friction="{MU_V} {MU_OMEGA} 0.001"/></default>'
            f'<worldbody><geom type="plane" size="0 0 1"/>{bodies}</worldbody></mujoco>',
            lambda data: data.xfrc_applied[1:].__setitem__(..., push),
        )

    return Scene(simulator, system.q_start, lambda t, q: np.zeros(0), force, model)


def _model(text: str, load: Callable[[Any], object]) -> tuple[Any, Any]:
    """MuJoCo's model of a text, and its data under a load."""
    mujoco: Any = import_module("mujoco")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    load(data)
    return model, data

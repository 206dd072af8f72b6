"""A block on one soft contact, pushed off its centre by a round finger: steps of six variables."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref import ContactPair, Simulator, StepResult
from quasistatic_ref.lab.made_steps.systems import (
    cloud_on,
    joint_text,
    link_text,
    robot_text,
    system_of,
    world_plane,
)
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import ELLIPSOID
from tests.made import GRAVITY

SIDE, HEIGHT, RADIUS = 0.1, 0.04, 0.01
"""Of the block and of the finger [m]."""

H, STIFFNESS, MU_V, MU_OMEGA, MU_FINGER = 0.01, 2000.0, 0.35, 0.012, 0.5
"""Time step [s], of the finger [N/m]; friction of the support [-], [m] and of the finger [-]."""

ASIDE, SPEED = 0.02, 0.02
"""The finger's distance from the line through the centre of mass [m]; its speed [m/s]."""

OFFSET = np.array([-(SIDE / 2 + RADIUS), ASIDE])
"""Where the finger is at q = 0, from the block there, shape (2,) [m]."""

SMALL = (1e-4, 1e-4, 1e-4)
BLOCK = robot_text(
    link_text("ground", 1.0, SMALL), link_text("at_x", 1e-3, SMALL), link_text("at_y", 1e-3, SMALL),
    link_text("at_z", 1e-3, SMALL),
    link_text("block", 0.8, (1e-3, 1e-3, 1.3e-3), f'<box size="{SIDE} {SIDE} {HEIGHT}"/>'),
    joint_text("x", "prismatic", "ground", "at_x"),
    joint_text("y", "prismatic", "at_x", "at_y", "0 1 0"),
    joint_text("z", "prismatic", "at_y", "at_z", "0 0 1"),
    joint_text("turn", "continuous", "at_z", "block", "0 0 1"),
)  # fmt: skip
"""It stays level: x, y, z and a turn about z."""

FINGER = robot_text(
    link_text("rail", 1.0, SMALL), link_text("carriage", 0.1, SMALL),
    link_text("finger", 0.1, SMALL, f'<sphere radius="{RADIUS}"/>'),
    joint_text("along", "prismatic", "rail", "carriage"),
    joint_text("across", "prismatic", "carriage", "finger", "0 1 0"),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class PushedBlock:
    """The simulator, and where the finger goes.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
        Where it starts.
    """

    simulator: Simulator
    q: Array

    def q_at(self, x: float, y: float, turn: float, gap: float) -> Array:
        """The block at x, y [m] and a turn [rad], the finger behind it at a gap [m], (n_q,)."""
        axes = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        finger = np.array([x, y]) - axes @ [SIDE / 2 + RADIUS + gap, 0.0] - OFFSET
        return np.array([*finger, x, y, 0.0, np.cos(turn), np.sin(turn)])

    def goal(self, k: int) -> Array:
        """Target of the finger at the end of step k, from 0, shape (2,) [m]."""
        goal: Array = self.q[:2] + np.array([SPEED * H * (k + 1), 0.0])
        return goal

    def run(self, steps: int) -> list[StepResult]:
        """So many steps from the start."""
        q = self.q
        results = []
        for k in range(steps):
            results.append(self.simulator.step(q, self.goal(k)))
            q = results[-1].q
        return results


def pushed_block(cone: str = ELLIPSOID) -> PushedBlock:
    """The scene at rest in a cone, the finger at the block's face."""
    system = system_of(
        {"hand": FINGER, "block": BLOCK},
        hand={"base": "fixed", "actuated": ["along", "across"], "xyz": (*OFFSET, HEIGHT / 2)},
        block={"base": "fixed", "actuated": [], "xyz": (0.0, 0.0, HEIGHT / 2)},
    )
    shapes = {shape.link: shape for shape in system.shapes}
    finger, block = (shapes[system.link(name)] for name in ("hand/finger", "block/block"))
    foot = cloud_on(system, "block/block", [[0.0, 0.0, -HEIGHT / 2]])
    pairs = [
        ContactPair("support", world_plane(), foot, MU_V, MU_OMEGA, 6, 1),
        ContactPair("push", finger, block, MU_FINGER, 0.0, 4, 1),
    ]
    simulator = Simulator(
        system, pairs, h=H, K_q=STIFFNESS * np.eye(2), gravity=(0.0, 0.0, -GRAVITY),
        cone=cone, backend="daqp" if cone == "pyramid" else None,
    )  # fmt: skip
    return PushedBlock(simulator, system.q_start)

"""Waypoints of joints from poses of a link, by inverse kinematics.

They are numbers of a scenario file: a run calls nothing of this.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.formats.given import arguments_checked
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.model.body import FIXED
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.parts import needed_package
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.step.arrays import Array, checked_array

LONGEST_WAY = 0.01
"""Default distance between waypoints on a line [m]."""
LARGEST_TURN = 0.1
"""Largest turn of the link between two waypoints [rad]."""
MOST_ITERATIONS = 200
REACHED = 1e-6
"""Largest distance that counts as reached, of way [m] and turn [rad] together."""
AT_LIMIT = 1e-6
"""How near to its limit a joint is at it [m, rad]."""
SINGULAR = 1e-3
"""Least of the largest singular value of the link's Jacobian, of unlike units, below which it is
said to be stretched or folded."""
DIGITS = 9
"""Digits after the point of a joint's position [m, rad]."""


@dataclass(frozen=True)
class Goal:
    """A pose that a link is to have.

    Parameters
    ----------
    name : str
        What it is called in messages.
    t : float
        [s].
    pose : pinocchio.SE3
        In the world [m].
    turned : bool
        Whether its rotation counts.
    """

    name: str
    t: float
    pose: pin.SE3
    turned: bool = True


@arguments_checked
def joint_targets(
    scenario: Scenario,
    link: str,
    poses: Sequence[Mapping[str, Any]],
    *,
    spacing: float = LONGEST_WAY,
) -> list[dict[str, float]]:
    """Waypoints of the joints that move a link along straight lines between poses.

    Parameters
    ----------
    scenario : Scenario
        Where its bodies start.
    link : str
        ``panda/panda_hand``.
    poses : sequence of mapping
        Each with a time ``t`` [s], and ``xyz`` [m], ``rpy`` [rad] or both, in the world. With
        ``relative = True`` they are a way and a turn along the world's axes from where the link
        starts. What is left out stays as it was in the pose before; ``rpy = "free"`` leaves the
        rotation to the arm, which may have fewer than six joints.
    spacing : float
        Longest way between two waypoints [m].

    Returns
    -------
    list of dict
        ``{"t": 0.0, "panda_joint1": 0.1, ...}``, the targets of the link's body.

    Raises
    ------
    InputError
        If a pose is not reached: the sentence names it, the millimetres left, and the joints at
        their limits, or that the arm is stretched; if no actuated joint moves the link, a mimic
        joint does, or its body has a base or a ball joint; if the extra ``targets`` is not
        installed.

    Examples
    --------
    >>> scenario = qr.load_scenario("arm_push")
    >>> way = [{"t": 1.0, "xyz": (0, 0.05, 0), "relative": True}]
    >>> waypoints = qr.joint_targets(scenario, "arm/tip", way)
    >>> len(waypoints), sorted(waypoints[0])
    (6, ['elbow', 'shoulder', 't', 'wrist'])
    """
    arm = _Arm(scenario, link)
    goals = list(_goals(arm, poses))
    return [arm.waypoint(goal) for goal in _on_lines(goals, spacing)]


def _goals(arm: "_Arm", poses: Sequence[Mapping[str, Any]]) -> Iterator[Goal]:
    """The poses as they are given; before them where the link starts, unless t = 0 is given."""
    start = before = arm.pose()
    if not poses:
        raise ScenarioError("must have at least one pose", field="poses")
    last = -1.0
    for i, given in enumerate(poses):
        table = TableReader(dict(given), f"poses[{i}]", ScenarioError)
        table.only(("t", "xyz", "rpy", "relative"))
        t = table.number("t", least=0.0)
        if t <= last:
            raise table.error_about("t", "must be later than in the pose before", t)
        if i == 0 and t > 0:
            yield Goal("the start", 0.0, start)
        last = t
        relative = table.boolean("relative", False)
        origin = start if relative else pin.SE3.Identity()
        p, R = before.translation, before.rotation
        if "xyz" in table:
            p = _three(table, "xyz") + origin.translation
        turned = not isinstance(table.peek("rpy"), str)
        if not turned:
            table.text("rpy", choices=("free",))
        elif "rpy" in table:
            R = rotation(_three(table, "rpy")) @ origin.rotation
        table.close()
        before = pin.SE3(np.array(R), np.array(p))
        yield Goal(f"poses[{i}] (t = {t:g} s)", t, before, turned)


def _three(table: TableReader, name: str) -> Array:
    return checked_array(table.take(name), table.name(name), (3,), ScenarioError)


def _on_lines(goals: list[Goal], spacing: float) -> Iterator[Goal]:
    """The goals, and between them poses on straight lines, about one axis each."""
    if not spacing > 0:
        raise ScenarioError("must be greater than 0", field="spacing", value=spacing)
    yield goals[0]
    for a, b in pairwise(goals):
        way = b.pose.translation - a.pose.translation
        turn = pin.log3(a.pose.rotation.T @ b.pose.rotation)
        of_way = float(np.linalg.norm(way)) / spacing
        of_turn = float(np.linalg.norm(turn)) / LARGEST_TURN
        n = max(1, int(np.ceil(max(of_way, of_turn) - 1e-9)))
        for k in range(1, n + 1):
            s = k / n
            R = b.pose.rotation if k == n else a.pose.rotation @ pin.exp3(s * turn)
            pose = pin.SE3(R, a.pose.translation + s * way)
            name = b.name if k == n else f"{b.name}, {100 * s:.0f} % of the way there"
            yield Goal(name, (1 - s) * a.t + s * b.t, pose, b.turned)


class _Arm:
    """The actuated joints that move one link, every other joint of its body where it starts.

    Parameters
    ----------
    scenario : Scenario
    link : str
    """

    def __init__(self, scenario: Scenario, link: str) -> None:
        pink = needed_package("pink", "targets", "joint_targets")
        self.pink = pink
        system = scenario.system
        name, _, short = system.links[system.link(link)].partition("/")
        number = [body.name for body in system.bodies].index(name)
        body = system.bodies[number]
        if body.base != FIXED:
            problem = f"is of {name}, whose base is {body.base}; a link of a fixed base is meant"
            raise ScenarioError(problem, field="link", value=link)
        own = [joint for joint in system.joints if joint.name.startswith(f"{name}/")]
        for joint in own:
            if len(joint.coordinates) > 1:
                problem = f"is of {name}, whose joint {joint.name} is no joint of one coordinate"
                raise ScenarioError(problem, field="link", value=link)
        model = pin.buildModelFromXML(system.texts[number])
        of_link = model.frames[model.getFrameId(short)].parentJoint
        moving = {model.names[joint] for joint in [*model.supports[of_link]]}
        for mimic in system.mimics:
            if mimic.name in {f"{name}/{joint}" for joint in moving}:
                problem = (
                    f"is moved by {mimic.name}, which mimics {mimic.of}; no such link is meant"
                )
                raise ScenarioError(problem, field="link", value=link)
        actuated = scenario.bodies[name].actuated(system)
        self.joints = [joint for joint in actuated if joint.name.partition("/")[2] in moving]
        if not self.joints:
            problem = f"is moved by no actuated joint of {name}"
            raise ScenarioError(problem, field="link", value=link)
        self.names = [joint.name.partition("/")[2] for joint in self.joints]
        locked = [i for i in range(1, model.njoints) if model.names[i] not in self.names]
        q = pin.neutral(model)
        for i in range(1, model.njoints):
            value = body.positions.get(model.names[i], 0.0)
            q[model.idx_qs[i]] = value
            if model.nqs[i] == 2:
                q[model.idx_qs[i]] = np.cos(value)
                q[model.idx_qs[i] + 1] = np.sin(value)
        reduced = pin.buildReducedModel(model, locked, q)
        order = [reduced.names[i] for i in range(1, reduced.njoints)]
        self.joints = [self.joints[self.names.index(one)] for one in order]
        self.names = order
        self.positions = np.array([body.positions.get(one, 0.0) for one in order])
        kept = [i for i in range(1, model.njoints) if i not in locked]
        start = [q[model.idx_qs[i] + k] for i in kept for k in range(model.nqs[i])]
        self.configuration = pink.Configuration(reduced, reduced.createData(), np.array(start))
        self.root = pin.SE3(rotation(np.asarray(body.rpy)), np.asarray(body.xyz))
        self.frame = short
        self.task = pink.tasks.FrameTask(short, position_cost=1.0, orientation_cost=1.0)
        self.limits = [pink.limits.ConfigurationLimit(reduced)]

    def pose(self) -> pin.SE3:
        """Pose of the link in the world [m]."""
        return self.root * self.configuration.get_transform_frame_to_world(self.frame)

    def waypoint(self, goal: Goal) -> dict[str, float]:
        """Positions of the joints at a goal, from those at the goal before it.

        Raises
        ------
        ScenarioError
            If it is not reached.
        """
        self.task.set_target(self.root.inverse() * goal.pose)
        self.task.set_orientation_cost(float(goal.turned))
        counted = slice(None) if goal.turned else slice(3)
        error = np.inf
        for _ in range(MOST_ITERATIONS):
            before = error
            error = float(np.linalg.norm(self.task.compute_error(self.configuration)[counted]))
            if error < REACHED / 100 or not error < before:
                break
            change = self.pink.solve_ik(
                self.configuration, [self.task], 1.0, "daqp", limits=self.limits
            )
            self.configuration.integrate_inplace(change, 1.0)
            self.positions = self.positions + change
        if error > REACHED:
            raise self._failure(goal)
        numbers = np.round(self.positions, DIGITS) + 0.0
        values = dict(zip(self.names, numbers.tolist(), strict=True))
        return {"t": round(goal.t, DIGITS), **values}

    def _failure(self, goal: Goal) -> ScenarioError:
        left = goal.pose.actInv(self.pose())
        way = 1e3 * float(np.linalg.norm(left.translation))
        turn = float(np.linalg.norm(pin.log3(left.rotation)))
        causes = []
        for name, joint, value in zip(self.names, self.joints, self.positions, strict=True):
            if joint.limits is not None and min(abs(np.subtract(joint.limits, value))) < AT_LIMIT:
                causes.append(f"{name} is at its limit, {value:.4g}")
        J = self.configuration.get_frame_jacobian(self.frame)[: 6 if goal.turned else 3]
        sizes = np.linalg.svd(J, compute_uv=False)
        if sizes[-1] < SINGULAR * sizes[0]:
            causes.append("the link cannot move in every direction there (a singular place)")
        if len(self.names) < len(J):
            problem = f"{len(self.names)} joints are fewer than the {len(J)} numbers of the pose"
            causes.append(problem)
        why = listed(causes) if causes else "it is out of reach"
        problem = f"is missed by {way:.3g} mm and {turn:.3g} rad: {why}"
        return ScenarioError(problem, field=goal.name)

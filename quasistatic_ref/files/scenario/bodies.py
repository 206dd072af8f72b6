"""The ``[bodies.NAME]`` tables of a scenario: URDF, base, stiffness, targets, wrenches."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from quasistatic_ref.errors import ModelError, ScenarioError
from quasistatic_ref.files.scenario.checks import checked_fields
from quasistatic_ref.files.scenario.paths import folders_in, inline_urdf, path_in, shared_folders
from quasistatic_ref.files.scenario.scenario_table import (
    BODY,
    ORIGIN,
    WAYPOINT,
    WRENCH,
    fields_of,
    pose,
)
from quasistatic_ref.model.coordinates import no_coordinate
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.model.tree import BASE
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.simulate.target import JointTrack, Wrenches
from quasistatic_ref.step.extension import ExtensionOfQ, StepExtension
from quasistatic_ref.text.plain import Plain
from quasistatic_ref.text.table_reader import TableReader


@dataclass(frozen=True, eq=False)
class BodyEntry(Plain):
    """What one ``[bodies.NAME]`` table says, before the system is known.

    Parameters
    ----------
    body : Body
    table : TableReader
        For messages.
    K_q : object
        As parsed: a table of joints, or a matrix.
    targets : list
        As parsed: waypoints.
    cloud : Path or None
    gravity_compensated : bool
        Whether the robot compensates gravity on its actuated coordinates (default), so that the
        model leaves it out.
    wrenches : Wrenches or None
    joint_friction : object
        As parsed: a table of joints, or ``"urdf"``.
    support : TableReader or None
        The table of that name.
    joint_limits : object
        As parsed: a table of joints, or ``"urdf"``.
    """

    body: Body
    table: TableReader = field(compare=False)
    K_q: Any
    targets: list[Any]
    cloud: Path | None
    gravity_compensated: bool
    wrenches: Wrenches | None
    joint_friction: Any
    support: TableReader | None = field(compare=False)
    joint_limits: Any

    @property
    def extends(self) -> bool:
        """Whether the body has joint friction, a support or joint limits, which extend the step."""
        return any(x is not None for x in (self.joint_friction, self.support, self.joint_limits))

    def joints(self, system: System) -> dict[str, Joint]:
        """The joints of this body in the order of q, by their names without the body's."""
        prefix = f"{self.body.name}/"
        of_body = [joint for joint in system.joints if joint.name.startswith(prefix)]
        return {joint.name.removeprefix(prefix): joint for joint in of_body}

    def actuated(self, system: System) -> dict[str, Joint]:
        """The body's actuated joints, by name."""
        return {name: joint for name, joint in self.joints(system).items() if joint.actuated}


class OfBodies(Protocol):
    """The extension by the tables of a scenario's bodies, at each q."""

    @property
    def of_urdf(self) -> tuple[Sequence[str], Sequence[str]]:
        """Names of the bodies with joint friction, and of those with limits, from their URDF."""

    def __call__(self, q: Array) -> StepExtension:
        """The extension at q, shape (n_q,)."""

    def beside(self, users: ExtensionOfQ | None) -> ExtensionOfQ:
        """The extension of the tables, joined with an extension of the user's own."""


def body_entry(
    name: str, table: TableReader, folder: Path, roots: Sequence[Path] = ()
) -> BodyEntry:
    """Read one ``[bodies.NAME]`` table; paths are relative to the scenario's folder.

    Robots are read from `roots`, too.
    """
    read = checked_fields(table, BODY)
    inline = inline_urdf(table, "urdf")
    path = path_in(folder, table, "urdf", roots) if inline is None else None
    urdf = inline or path
    if urdf is None:
        raise table.error_about("urdf", "is missing; name the URDF file of the body")
    base = read("base")
    actuated = read("actuated")
    xyz, rpy = pose(read("pose"))
    positions = table.table("positions", {})
    start = {joint: positions.number(joint) for joint in positions.names_left()}
    package_dirs = read("package_dirs")
    folders = [*folders_in(folder, table, "package_dirs", package_dirs), *roots]
    if "gravity_compensated" in table and not actuated:
        raise table.error_about(
            "gravity_compensated", "needs an actuated joint, and this body has none"
        )
    if path is not None:
        folders += [folder, *shared_folders(path)]
    try:
        body = Body(name, urdf, base, actuated, xyz, rpy, start, folders)
    except ModelError as error:
        places = {f"{name}.rpy": "pose.rpy", f"{name}.actuated": "actuated"}
        if error.field in places:
            error.field = table.name(places[error.field])
        raise
    entry = BodyEntry(
        body=body,
        table=table,
        K_q=read("K_q"),
        targets=read("targets"),
        cloud=path_in(folder, table, "cloud", roots),
        gravity_compensated=read("gravity_compensated"),
        wrenches=_wrenches(name, table, read("wrenches")),
        joint_friction=read("joint_friction"),
        support=table.table("support") if "support" in table else None,
        joint_limits=read("joint_limits"),
    )
    if entry.wrenches is not None and base == "fixed":
        raise table.error_about(
            "wrenches", 'have no effect on a body with base = "fixed"; remove them'
        )
    return entry


def stiffnesses(system: System, entry: BodyEntry) -> Iterator[tuple[str, Indices, Any]]:
    """The blocks of K_q that a body's table states: field, coordinates and numbers of each.

    They are those of its joints, or one of the whole body.

    Raises
    ------
    ScenarioError
        If a joint is left out or unknown.
    """
    joints = entry.actuated(system)
    table = entry.table
    if entry.K_q is None and joints:
        raise table.error_about("K_q", f"is missing for {', '.join(joints)}; add it")
    if isinstance(entry.K_q, list | int | float):
        every = [i for joint in joints.values() for i in range(joint.v.start, joint.v.stop)]
        yield table.name("K_q"), np.array(every, dtype=np.int64), entry.K_q
        return
    of_joints = TableReader(
        {} if entry.K_q is None else entry.K_q, table.name("K_q"), ScenarioError
    )
    for name, problem in _followers(system, entry).items():
        if name in of_joints:
            raise of_joints.error_about(name, problem)
    of_joints.only(joints)
    for name, joint in joints.items():
        numbers = of_joints.take(name)
        yield of_joints.name(name), np.arange(joint.v.start, joint.v.stop), numbers


def joint_tracks(system: System, entry: BodyEntry) -> list[JointTrack]:
    """The waypoints of a body's joints as functions of time.

    Raises
    ------
    ScenarioError
        If a waypoint names what has no target, or asks for more than half a turn at once.
    """
    joints = entry.actuated(system)
    followers = _followers(system, entry)
    times: dict[str, list[float]] = {}
    values: dict[str, list[Any]] = {}
    angles = {name: _start_angles(entry.body, name, joint) for name, joint in joints.items()}
    for i, record in enumerate(entry.targets):
        waypoint = TableReader(record, entry.table.name(f"targets[{i}]"), ScenarioError)
        for name in waypoint.names_left():
            if name in followers:
                raise waypoint.error_about(name, followers[name])
            if name != "t" and name not in joints:
                hint = suggestion(name, joints if "t" in waypoint else ["t", *joints])
                raise waypoint.error_about(name, f"is not an actuated joint of this body{hint}")
        t = fields_of(waypoint, WAYPOINT)("t")
        if not waypoint.names_left():
            problem = "sets no joint; give the position of at least one"
            raise entry.table.error_about(f"targets[{i}]", problem, record)
        for name in waypoint.names_left():
            joint = joints[name]
            if isinstance(joint, TwistJoint):
                target, turned = _placed(waypoint, name, joint, entry.body)
            else:
                target = turned = np.array([waypoint.number(name)])
            # Between waypoints a continuous joint turns as often as they say.
            if joint.unit_vector and (isinstance(joint, TwistJoint) or name not in times):
                _check_turn(waypoint, name, angles[name], turned)
                angles[name] = turned
            times.setdefault(name, []).append(t)
            values.setdefault(name, []).append(target)
    return [
        JointTrack(joints[name], np.array(times[name]), np.array(values[name])) for name in times
    ]


def _followers(system: System, entry: BodyEntry) -> dict[str, str]:
    """A sentence for each joint that mimics another: it has no coordinate of its own."""
    body = f"{entry.body.name}/"
    return {
        one.name.removeprefix(body): no_coordinate(one.of.removeprefix(body))
        for one in system.mimics
        if one.name.startswith(body)
    }


def _start_angles(body: Body, name: str, joint: Joint) -> Array:
    """Roll, pitch and yaw of a base or ball at the start, or the position of a joint [rad, m]."""
    if isinstance(joint, TwistJoint):
        return np.asarray(body.rpy) if name == BASE else np.zeros(3)
    return np.array([body.positions.get(name, 0.0)])


def _check_turn(waypoint: TableReader, name: str, before: Array, after: Array) -> None:
    """Refuse angles [rad] of which one differs by more than pi: q holds no number of turns."""
    most = int(np.abs(after - before).argmax())
    turn = float(after[most] - before[most])
    if abs(turn) > np.pi:
        problem = (
            f"turns by {turn:.4g} rad from the pose before, but a spring takes the shorter way: "
            "add waypoints less than half a turn apart, or subtract whole turns"
        )
        raise waypoint.error_about(name, problem, after.tolist())


def _placed(waypoint: TableReader, name: str, joint: TwistJoint, body: Body) -> tuple[Array, Array]:
    """Entries of q of a base or ball at a pose, and its roll, pitch, yaw [rad]."""
    start = np.asarray(body.xyz)
    if not isinstance(waypoint.peek(name), dict):
        problem = "must be a pose, { xyz = [x, y, z], rpy = [roll, pitch, yaw] }, in m and rad"
        raise waypoint.error_about(name, problem, waypoint.take(name))
    xyz, rpy = pose(waypoint.table(name), ORIGIN if joint.free else start)
    obstacle = joint.obstacle(xyz, rpy, start)
    if obstacle is not None:
        raise waypoint.error_about(name, obstacle, [*xyz.tolist(), *rpy.tolist()])
    return np.array(joint.at(xyz, rpy)), rpy


def _wrenches(name: str, table: TableReader, records: Sequence[Any]) -> Wrenches | None:
    times = []
    values = []
    for i, record in enumerate(records):
        entry = TableReader(record, table.name(f"wrenches[{i}]"), ScenarioError)
        read = checked_fields(entry, WRENCH)
        times.append(read("t"))
        if not {"force", "torque"} & set(entry.names_left()):
            raise table.error_about(
                f"wrenches[{i}]", "must contain a force, a torque or both", record
            )
        values.append(np.concatenate([read("force"), read("torque")]))
    if not times:
        return None
    if not (np.diff(times) > 0).all():
        raise table.error_about("wrenches", "must have increasing times t", times)
    return Wrenches(name, np.array(times), np.array(values))

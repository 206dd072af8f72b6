"""What tables of bodies add to each step: ``joint_friction``, ``support`` and ``joint_limits``."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.files.scenario.bodies import BodyEntry
from quasistatic_ref.files.scenario.checks import checked_fields
from quasistatic_ref.files.scenario.scenario_table import SUPPORT, URDF
from quasistatic_ref.model.joints import BASES
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.extensions.extension import Extension, Rises, checked_extension
from quasistatic_ref.optional.extensions.rises import private_rises, urdf_friction
from quasistatic_ref.optional.extensions.stops import JointLimits, stops_of, urdf_limits
from quasistatic_ref.step.extension import ExtensionOfQ
from quasistatic_ref.text.plain import Plain
from quasistatic_ref.text.table_reader import TableReader


@dataclass(frozen=True, eq=False)
class OfScenario(Plain):
    """The extension of a scenario, at each q, with one of the user's own beside it.

    Parameters
    ----------
    rises : Rises
        Friction of joints and of supports, (R40).
    limits : JointLimits
    of_urdf : tuple of sequence of str
        The bodies whose friction of joints, and those whose limits, are those of their URDF.
    users : callable, optional
        A function of q, without rises and rows.
    """

    rises: Rises
    limits: JointLimits
    of_urdf: tuple[Sequence[str], Sequence[str]]
    users: ExtensionOfQ | None = None

    @property
    def fields(self) -> tuple[str, ...]:
        """The sources of the extension: fields of tables of bodies, and ``extension``."""
        parts = {
            "joint_friction": len(self.rises.coordinates),
            "support": len(self.rises.contacts),
            "joint_limits": len(self.limits),
            "extension": self.users is not None,
        }
        return tuple(name for name, part in parts.items() if part)

    def beside(self, users: ExtensionOfQ | None) -> "OfScenario":
        """The extension of the tables, joined with an extension of the user's own."""
        return replace(self, users=users)

    def __call__(self, q: Array) -> Extension:
        """The extension at q, shape (n_q,)."""
        users = Extension() if self.users is None else checked_extension(self.users(q))
        return replace(users, rises=self.rises, rows=self.limits.rows(q))


def of_scenario(
    system: System,
    pairs: tuple[ContactPair, ...],
    entries: Mapping[str, BodyEntry],
    h: float,
    K_q: Array,
    gravity: Array,
) -> tuple[tuple[ContactPair, ...], OfScenario]:
    """The scenario's pairs with those of supports, and the extension by its bodies' tables.

    Parameters
    ----------
    system : System
    pairs : tuple of ContactPair
    entries : mapping of str to BodyEntry
    h, K_q, gravity
        As of :func:`~quasistatic_ref.optional.extensions.rises.private_rises`.

    Raises
    ------
    InputError
        Naming the field.
    """
    rubbed = tuple(name for name, e in entries.items() if e.joint_friction == URDF)
    stopped = tuple(name for name, e in entries.items() if e.joint_limits == URDF)
    ends = urdf_limits(system, stopped)
    for entry in entries.values():
        ends |= joint_limits(system, entry)
    limits = stops_of(system, ends)
    limits.check_start(system.q_start)
    friction: dict[str, float] = {}
    for entry in entries.values():
        friction |= joint_friction(system, entry)
    support = {name: _support(e, e.support) for name, e in entries.items() if e.support is not None}
    pairs, rises = private_rises(
        system, pairs, h=h, K_q=K_q, gravity=gravity, friction=friction, support=support
    )
    return pairs, OfScenario(rises, limits, (rubbed, stopped))


def joint_limits(system: System, entry: BodyEntry) -> dict[str, tuple[float, float]]:
    """Least and greatest positions that a body's table gives, by the names of joints [m, rad].

    Raises
    ------
    ScenarioError
        If a joint is unknown or has no position of one number, or the first is above the second.
    """
    table = {} if entry.joint_limits in (None, URDF) else entry.joint_limits
    fields = TableReader(table, entry.table.name("joint_limits"), ScenarioError)
    joints = {name: one for name, one in entry.joints(system).items() if len(one.positions) == 1}
    fields.only(joints)
    limits = {}
    for name in fields.names_left():
        lower, upper = fields.array(name, (2,), infinite=True).tolist()
        if lower > upper or lower == math.inf or upper == -math.inf:
            problem = "must be a least position (or -inf), and then a greatest one (or inf)"
            raise fields.error_about(name, problem, [lower, upper])
        limits[joints[name].name] = lower, upper
    return limits


def joint_friction(system: System, entry: BodyEntry) -> dict[str, float]:
    """Friction of a body's coordinates, by their names [N, N m].

    Raises
    ------
    ScenarioError
        If a joint is unknown or a floating base, or a friction is no number >= 0.
    """
    if entry.joint_friction == URDF:
        return urdf_friction(system, entry.body.name)
    table = {} if entry.joint_friction is None else entry.joint_friction
    fields = TableReader(table, entry.table.name("joint_friction"), ScenarioError)
    rubbed = {name: joint for name, joint in entry.joints(system).items() if not joint.free}
    fields.only(rubbed)
    friction: dict[str, float] = {}
    for name, joint in rubbed.items():
        coordinates = joint.coordinates
        if name not in fields:
            continue
        one = len(coordinates) == 1
        loads = [fields.number(name)] if one else fields.array(name, (len(coordinates),)).tolist()
        if min(loads) < 0:
            raise fields.error_about(name, "must be at least 0", loads)
        friction |= {c.name: load for c, load in zip(coordinates, loads, strict=True)}
    return friction


def _support(entry: BodyEntry, rubs: TableReader) -> tuple[float, float]:
    """mu_v [-] and mu_omega [m] of a planar base on its floor."""
    if BASES.get(entry.body.base) is not Planar:
        raise entry.table.error_about("support", 'is for a body with base = "planar"')
    read = checked_fields(rubs, SUPPORT)
    return read("mu_v"), read("mu_omega")

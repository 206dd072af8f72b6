"""The data of a step, Eq. :eq:`eq-13`, formed in one place: from a state, a target and a force."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.groups import coupled_groups
from quasistatic_ref.contact.all_pairs import AllPairs
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactLayout, ContactPair, contact_layout
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.numbers.arrays import (
    Array,
    Indices,
    Mask,
    all_finite,
    checked_numbers,
    read_only,
)
from quasistatic_ref.numbers.compiled import compiled
from quasistatic_ref.solve.by_group import GroupIndex
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import (
    Extra,
    FormedStep,
    RowLayout,
    StepData,
    no_extra,
    row_layout,
)
from quasistatic_ref.step.hessian import Hessian, Hessians
from quasistatic_ref.step.standard_form import Units

FROM_LOADS = 'system.load(q, "BODY", force=(1, 0, 0)) makes it from a force in world axes'
NO_FORCE = read_only(np.zeros(()))
CONTACTS = ("phi", "n", "d1", "d2", "own", "A", "b")


def checked_force(system: System, force: ArrayLike | None) -> Array:
    """A generalised force, shape (n_v,) or () [N, N m]; zero where None.

    Raises
    ------
    StepDataError
        If it has another shape, or is no array of numbers.
    """
    if force is None or (type(force) is float and force == 0):
        return NO_FORCE
    tau = None if isinstance(force, Mapping) else checked_numbers(force, "force")
    if tau is None or (tau.shape != (system.n_v,) and not (tau.shape == () and tau == 0)):
        problem = f"must be numbers of shape ({system.n_v},), in the order of delta_q; {FROM_LOADS}"
        raise StepDataError(problem, field="force", value=force if tau is None else tau.shape)
    return tau


@dataclass(frozen=True, eq=False)
class StepPlan:
    """What the steps of a simulator have in common, formed once.

    Parameters
    ----------
    system, pairs, h, K_q, gravity, gravity_acts, cone
        As of :class:`~quasistatic_ref.simulate.settings.Settings`; the pairs as they are measured.
    hessians : Hessians
        H of Eq. :eq:`eq-13`, which is the same as long as M_u is.
    """

    system: System
    pairs: tuple[ContactPair, ...]
    h: float
    K_q: Array
    gravity: Array
    gravity_acts: Mask
    cone: str
    hessians: Hessians = field(default_factory=Hessians)

    @cached_property
    def layout(self) -> ContactLayout:
        """The constant fields of the contacts."""
        return contact_layout(self.pairs)

    @cached_property
    def all_pairs(self) -> AllPairs:
        """The pairs, arranged for a joint search of closest points."""
        return AllPairs(self.pairs)

    @cached_property
    def geometry(self) -> ContactGeometry:
        """The constant part of the contacts' Jacobians: which coordinates move which contact."""
        return ContactGeometry(self.layout, self.system.column_map)

    @cached_property
    def group_layout(self) -> GroupIndex | None:
        """The groups of all steps, by what can couple their coordinates; None if not known."""
        system = self.system
        entries = system.mass_entries
        if entries is None:
            return None
        contact, k = np.nonzero(self.geometry.column < system.n_v)
        of_contacts = contact, self.geometry.column[contact, k]
        i, j = entries
        of_K, of_K_column = np.nonzero(self.K_q)
        n_a = system.n_a
        of_H = np.concatenate([of_K, n_a + i]), np.concatenate([of_K_column, n_a + j])
        counts = self.row_layout.counts
        every = coupled_groups(of_contacts, of_H, counts, system.n_v)
        return GroupIndex(every, self.geometry.column, counts, system.n_v, 0, len(of_H[0]))

    @cached_property
    def row_layout(self) -> RowLayout:
        """Which rows of the cone the contacts have."""
        return row_layout(self.cone, self.layout.rows.tobytes())

    @cached_property
    def no_extra(self) -> Extra:
        """No rows of a user's own."""
        return no_extra(self.system.n_v)

    def load(self, here: State, force: ArrayLike | None) -> Array:
        """Gravity at a state plus an external `force`, shape (n_v,) [N, N m].

        Raises
        ------
        StepDataError
            If the force has another shape.
        """
        external = checked_force(self.system, force)
        tau = here.gravity(self.gravity)
        tau[: self.system.n_a] *= self.gravity_acts
        return tau + external

    @compiled
    def loads(self, here: State, target: ArrayLike, force: ArrayLike | None) -> Array:
        """The force tau and the change to a target, of the arguments of :func:`form_step`.

        Returns
        -------
        ndarray, shape (n_v + n_a,) [N, N m; m, rad]
        """
        tau = self.load(here, force)
        change = here.change_to(target)  # q_bar_a(t + h) (-) q_a
        return read_only(np.concatenate([tau, change]) + 0.0)  # zero is 0.0, never -0.0

    def fields(self, loads: Array) -> dict[str, Any]:
        """Fields of a step: those of the plan, and views of its loads.

        Parameters
        ----------
        loads : ndarray, shape (n_v + n_a,)
            As of :meth:`loads` [N, N m; m, rad].
        """
        n_v = self.system.n_v
        n_a = self.system.n_a
        return {
            "h": self.h,
            "K_q": self.K_q,
            "tau_a": loads[:n_a],
            "tau_u": loads[n_a:n_v],
            "delta_q_bar_a": loads[n_v:],
            "cone": self.cone,
        }

    @compiled
    def formed(
        self, kinematics: Kinematics, points: ClosestPoints, loads: Array, hessian: Hessian
    ) -> StepData:
        """The data of one step.

        Parameters
        ----------
        kinematics : Kinematics
        points : ClosestPoints
            Of the pairs, at the same configuration.
        loads : ndarray, shape (n_v + n_a,)
            As of :meth:`loads` [N, N m; m, rad].
        hessian : Hessian
        """
        contacts = self.geometry.contacts(points, kinematics)  # Eqs. (2)-(3)
        fields = self.fields(loads)
        arrays = loads, contacts.phi, contacts.n.ravel(), contacts.own.ravel()
        if not all(map(all_finite, arrays)):  # refused by their names
            return StepData(M_u=hessian.M_u, contacts=replace(contacts), **fields)
        constant = {"hessian": hessian, "row_layout": self.row_layout, "extra": self.no_extra}
        return StepData.unchecked(contacts=contacts, **constant, **fields)

    @cached_property
    def block_layout(self) -> dict[str, tuple[slice, tuple[int, ...]]]:
        """Where the arrays of a :class:`StepBlock` stand, and their shapes, by their names."""
        n_c, w = self.geometry.column.shape
        m = int(self.row_layout.offsets[-1])
        shapes: dict[str, tuple[int, ...]] = {
            "phi": (n_c,),
            "n": (n_c, 3),
            "d1": (n_c, 3),
            "d2": (n_c, 3),
            "own": (n_c, 4, w),
            "A": (m, w),
            "b": (m,),
            "g": (self.system.n_v,),
            "units": (3,),
        }
        ends = np.cumsum([0, *map(math.prod, shapes.values())]).tolist()
        places = map(slice, ends, ends[1:])
        return {n: (at, shapes[n]) for n, at in zip(shapes, places, strict=True)}


class StepBlock(NamedTuple):
    """What a step has formed, in one array, of which its fields are read-only views.

    Parameters
    ----------
    plan : StepPlan
    numbers : ndarray, shape (N,)
        As ``StepPlan.block_layout`` says: contacts, rows, g, and the two units and `deepest`, in
        their units [m, rad, N].
    point : ndarray of int, shape (n_c,)
        As of :class:`~quasistatic_ref.contact.closest_points.ClosestPoints`.
    """

    plan: StepPlan
    numbers: Array
    point: Indices

    @property
    def deepest(self) -> float:
        """As of :class:`~quasistatic_ref.step.data.FormedStep` [m]."""
        return float(self.numbers[-1])

    def is_like(self, other: FormedStep | None) -> bool:
        """Whether another step has the same plan."""
        return isinstance(other, StepBlock) and other.plan is self.plan

    def of(self, *names: str) -> list[Array]:
        """Arrays by their names, in the shapes (...) of ``StepPlan.block_layout``."""
        layout = self.plan.block_layout
        return [self.numbers[at].reshape(shape) for at, shape in map(layout.__getitem__, names)]

    @property
    def contacts(self) -> Contacts:
        """The contacts of the step."""
        phi, n, d1, d2, own, A, b = self.of(*CONTACTS)
        return self.plan.geometry.contacts_of(self.point, phi, n, d1, d2, own, (A, b))

    def natural(self, step: StepData, layout: GroupIndex) -> NaturalStep:
        """The step with its program."""
        A, b, g = self.of("A", "b", "g")
        ell, rho = self.numbers[-3:-1].tolist()
        unit = layout.natural_hessian_of(step).unit
        return NaturalStep(step, Units(unit, ell, rho), layout, ((A, b), g))


def form_step(
    plan: StepPlan, here: State, target: ArrayLike, force: ArrayLike | None, points: ClosestPoints
) -> StepData:
    """The problem of one step: everything in Eq. :eq:`eq-13` at a state.

    Parameters
    ----------
    plan : StepPlan
        Of the simulator.
    here : State
        Of its system.
    target : array_like, shape (n_q_a,)
        q_bar_a [m, rad, -].
    force : array_like, shape (n_v,), optional
        In addition to gravity [N, N m].
    points : ClosestPoints
        Of the pairs at that state.

    Raises
    ------
    ModelError, StepDataError
        If the target or the force has another shape, or a number is not finite.
    """
    loads = plan.loads(here, target, force)
    hessian = plan.hessians.of(plan.h, plan.K_q, here.masses)
    if hessian is None:  # refused by its name
        contacts = replace(plan.geometry.contacts(points, here.kinematics))
        return StepData(M_u=here.M_u, contacts=contacts, **plan.fields(loads))
    return plan.formed(here.kinematics, points, loads, hessian)

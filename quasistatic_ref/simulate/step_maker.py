"""The problem of each step of a system: contacts, J, H and loads at q, Eq. :eq:`eq-13`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.groups import coupled_groups
from quasistatic_ref.contact.all_pairs import AllPairs
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactLayout, contact_layout
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import (
    Array,
    all_finite,
    checked_numbers,
    read_only,
)
from quasistatic_ref.numbers.pivots import positive_definite
from quasistatic_ref.simulate.distance_source import measured_pairs
from quasistatic_ref.simulate.settings import Settings
from quasistatic_ref.solve.by_group import GroupLayout
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData, no_extra, row_layout
from quasistatic_ref.step.hessian import Hessian

FROM_LOADS = 'system.load(q, "BODY", force=(1, 0, 0)) makes it from a force in world axes'
NO_FORCE = read_only(np.zeros(()))


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


class StepMaker(Settings):
    """Makes the problems of steps of a system; what they have in common is formed once."""

    _hessian: Hessian | None = None
    """That of the last step."""

    @cached_property
    def layout(self) -> ContactLayout:
        """The constant fields of the contacts."""
        return contact_layout(self.pairs)

    @cached_property
    def all_pairs(self) -> AllPairs:
        """The pairs of this simulator, arranged for a joint search of closest points."""
        return AllPairs(measured_pairs(self.pairs, self.distances))

    @cached_property
    def geometry(self) -> ContactGeometry:
        """The constant part of the contacts' Jacobians: which coordinates move which contact."""
        return ContactGeometry(self.layout, self.system.column_map)

    @cached_property
    def group_layout(self) -> GroupLayout | None:
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
        counts = row_layout(self.cone, self.layout.rows.tobytes()).counts
        every = coupled_groups(of_contacts, of_H, counts, system.n_v)
        return GroupLayout(every, self.geometry.column, counts, system.n_v, 0, len(of_H[0]))

    def scaled(self, step: StepData) -> ScaledStep:
        """A step with its program, by the groups of the simulator if it has its structure."""
        own = step.contacts.column is self.geometry.column and step.extra.empty
        return ScaledStep(step, layout=self.group_layout if own else None)

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, in order, each pair's in ascending distance.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, or a pose is not finite.
        """
        return self.all_pairs.closest_points(kinematics)

    def step_data(
        self,
        q: ArrayLike | State,
        q_bar_a: ArrayLike,
        force: ArrayLike | None,
        points: ClosestPoints,
    ) -> StepData:
        """The problem of one step: everything in Eq. :eq:`eq-13` at q, (n_q,) or a state.

        Raises
        ------
        StepDataError
            If the force has another shape.
        """
        here = self.system.at(q)
        return self.step_at(here, q_bar_a, self.generalised_force(here, force), points)

    def step_at(
        self, q: ArrayLike | State, q_bar_a: ArrayLike, tau: Array, points: ClosestPoints
    ) -> StepData:
        """The problem of one step from its closest points and all forces, (n_v,) [N, N m]."""
        here = self.system.at(q)
        contacts = self.geometry.contacts(points, here.kinematics)  # Eqs. (2)-(3)
        return self.step_under(here, q_bar_a, tau, contacts)

    def step_under(
        self, q: ArrayLike | State, q_bar_a: ArrayLike, tau: Array, contacts: Contacts
    ) -> StepData:
        """The problem of one step from its contacts and all generalised forces, (n_v,) [N, N m]."""
        system = self.system
        here = system.at(q)
        masses = here.masses
        change = here.change_to(q_bar_a)  # q_bar_a(t + h) (-) q_a
        n_a = system.n_a
        loads: dict[str, Any] = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "delta_q_bar_a": change}
        arrays = masses.ravel(), contacts.n.ravel(), contacts.own.ravel()
        if not all(map(all_finite, (tau, change, contacts.phi, *arrays))):  # refused by their names
            loads |= {"contacts": replace(contacts), "cone": self.cone}
            return StepData(h=self.h, K_q=self.K_q, M_u=here.M_u, **loads)
        last = self._hessian
        if last is None or not (masses is last.masses or np.array_equal(masses, last.masses)):
            positive_definite("M_u", masses)
            new = Hessian(self.h, self.K_q, masses) if last is None else last.changed(masses)
            self._hessian = last = new
        return StepData.unchecked(
            h=self.h,
            K_q=self.K_q,
            hessian=last,
            contacts=contacts,
            cone=self.cone,
            extra=no_extra(system.n_v),
            **{name: read_only(load + 0.0) for name, load in loads.items()},
        )

    def generalised_force(self, q: ArrayLike | State, force: ArrayLike | None) -> Array:
        """Gravity at q plus an external `force`, shape (n_v,) [N, N m]."""
        force = checked_force(self.system, force)
        tau = self.system.at(q).gravity(self.gravity)
        tau[: self.system.n_a] *= self.gravity_acts
        return tau + force

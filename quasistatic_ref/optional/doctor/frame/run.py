"""A run at its end: what findings after the run look at."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.screw import rows
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.frame.contacts import (
    contact_mu,
    contact_slips,
    gap_after,
    touching,
)
from quasistatic_ref.optional.doctor.frame.start import Start, side
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.form_step import form_step
from quasistatic_ref.simulate.observer import Recording
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.recorder import POINTS
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    from quasistatic_ref.step.extension import Posed

NOTED = ("tau", "moved", "momentum", "gives", "hinged")
"""What of a recorder, which may go, is kept: loads of each step, and what the observer notes."""
HELD = 1e-9
"""Below this a change of a target counts as zero [m, rad, -]."""
SAME = 1e-6
"""Share of a body's largest load [-] below which a change of load counts as zero."""


def in_world(quaternions: Array, vectors: Array) -> Array:
    """Vectors of bodies' own frames, (..., 3), in the world, by their quaternions, (..., 4).

    `quaternions` [-] are those of each body and step, `vectors` [any unit] too.
    """
    R: Array = np.array(rows([*np.moveaxis(quaternions, -1, 0)]))
    turned: Array = np.einsum("ij...,...j->...i", R, vectors)
    return turned


class Run(Start):
    """A run of at least one step, as the checks of findings read it.

    Parameters
    ----------
    recorder : Recording
    trajectory : Trajectory
    """

    def __init__(self, recorder: Recording, trajectory: Trajectory) -> None:
        super().__init__(recorder.simulator, recorder.start)
        self.tracks = recorder.tracks
        self.idle_columns = recorder.idle_columns
        self._noted = {name: recorder.noted(name) for name in NOTED}
        self.trajectory = trajectory
        self.arrays = trajectory.arrays
        self.steps = trajectory.steps
        self.complete = trajectory.failed is None
        self._formed: dict[int, StepData] = {}

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[name]

    def noted(self, name: str) -> NDArray[Any]:
        """Numbers of each step that the recorder keeps, not the trajectory, shape (steps, ...)."""
        return self._noted[name]

    @property
    def load_at_start(self) -> Array:
        """Gravity and external loads in the first step, shape (n_v,) [N, N m]."""
        return np.asarray(self.noted("tau")[0])

    @cached_property
    def nearest(self) -> Array:
        """Least distance of each pair where a step starts, shape (steps, pairs) [m]."""
        return self.of_pairs(np.minimum, self["phi"])

    @cached_property
    def touched(self) -> Mask:
        """Whether each pair ever touches, shape (pairs,)."""
        return np.asarray(self.of_pairs(np.logical_or, self.touches).any(axis=0))

    def of_pairs(self, ufunc: np.ufunc, values: NDArray[Any]) -> NDArray[Any]:
        """What an operation makes of the contacts of each pair: (steps, pairs).

        `values` are (steps, n_c) of any unit [that of the result].
        """
        starts = [at.start for _, at in self.slices]
        return ufunc.reduceat(values, starts, axis=1) if starts else values

    def held_by(self, i: int) -> tuple[str, str]:
        """Names of the two sides of pair i: the one that nothing drives comes first."""
        pair = self.pairs[i]
        names = side(self.system, pair.alpha), side(self.system, pair.beta)
        return names if self.free[pair.alpha.link] else names[::-1]

    @cached_property
    def touches(self) -> Mask:
        """Which contacts touch, (steps, n_c), with load or without: which bears may be open."""
        return touching(self.trajectory, self.noted("moved"), self.sliding)

    @cached_property
    def mu(self) -> Array:
        """mu_v, mu_v and mu_omega of each contact, shape (n_c, 3) [-, -, m]."""
        return contact_mu(self.trajectory)

    @cached_property
    def slips(self) -> Array:
        """Slips along d1 and d2 [m] and turns of what has torsion [rad], shape (steps, n_c, 3)."""
        return contact_slips(self.trajectory, self.noted("moved"))

    @cached_property
    def sliding(self) -> Array:
        """By how much each contact has to rise, as it slides and turns, (steps, n_c) [m]."""
        return slip_norm(self.mu * self.slips, self.simulator.cone)

    @cached_property
    def gap(self) -> Array:
        """Gaps after each step, shape (steps, n_c) [m]."""
        return gap_after(self["phi"], self["n"], self.noted("moved"))

    @cached_property
    def targets_move(self) -> Mask:
        """Whether a target moves in each step, shape (steps,): where none does, bodies settle."""
        ways = np.abs(np.diff(self["q_bar_a"], axis=0)).max(axis=1, initial=0.0) > HELD
        return np.append(ways[:1], ways) if len(ways) else np.zeros(self.steps, dtype=bool)

    @cached_property
    def loads_move(self) -> Mask:
        """Whether a load on a free body changes in each step, shape (steps,), seen in the world."""
        moves = np.zeros(self.steps, dtype=bool)
        bases = self.free_bases.values()
        if bases:
            q = np.array([self["q"][:-1, base.q][:, 3:] for base in bases])
            load = np.array([self.noted("tau")[:, base.v] for base in bases])
            seen = np.array([in_world(q, load[..., :3]), in_world(q, load[..., 3:])])
            change = np.abs(np.diff(seen, axis=2)).max(axis=(0, 3))
            largest = np.abs(load).max(axis=(1, 2))
            moves[1:] = (change > SAME * largest[:, None]).any(axis=0)
        return moves

    def falls(self, base: Joint) -> Mask:
        """The steps in which a body goes down by more than a half of h^2 g, shape (steps,)."""
        drop = np.diff(self["q"][:, base.q][:, :3] @ self.down)
        return np.asarray(drop > self.h**2 * self.g / 2) & (self.g > 0)

    def points_of(self, k: int) -> ClosestPoints:
        """The recorded contacts of step k, without the record's ties."""
        fields = {name: self[name][k] for name in POINTS}
        return ClosestPoints(**fields, tie=np.zeros_like(fields["point"]))

    def step(self, k: int) -> StepData:
        """The problem of step k, up to rounding."""
        if k not in self._formed:
            q, targets, tau = self["q"][k], self["q_bar_a"][k], self.noted("tau")[k]
            plan = self.simulator.plan
            points = self.points_of(k)
            step = form_step(plan, self.system.at(q), targets, None, points)
            n_a = self.system.n_a
            self._formed[k] = step.with_fields(tau_a=tau[:n_a], tau_u=tau[n_a:])
        return self._formed[k]

    def posed(self, k: int) -> tuple[StepData, bool]:
        """Step k with the rows, rises and quadratic costs of an extension, and if that is all."""
        extension = self.simulator.extension
        if extension is None:
            return self.step(k), True
        posed: Posed = part("posed")
        return posed(self.step(k), extension(self["q"][k]))

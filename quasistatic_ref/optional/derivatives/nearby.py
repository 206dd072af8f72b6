"""The steps near one step: where they lead when a parameter changes a little."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.groups import flat_rows, row_owners
from quasistatic_ref.model.state import State
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, without_warnings
from quasistatic_ref.numbers.ordered import crossed
from quasistatic_ref.simulate.form_step import checked_force, form_step
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import DAQP, NONE
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solve import solve_step, step_solution
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.step.standard_form import standard_form

Changes = Mapping[str, Array]
"""What some parameters change by, by their names."""

PLACE: Final = 0.01
"""Size of a coordinate of q [m, rad], of which a thousandth is the first difference."""

SLACK: Final = 4e-15
"""Slack that rounding may leave, relative to the sum of a row's terms, or to places [-]."""

ELSEWHERE: Final = 0.1
"""Change of a row of A in natural units, relative to its largest entry [-], beyond which it is
another row."""

ROUNDING: Final = 1e-13
"""What rounding may change in q+ [m, rad]: some hundred times that of places in the world where q
changes. Where only a step's data change, it is this share of the step's own size."""


class End(NamedTuple):
    """The end of a step nearby: the change of q+, and the solution.

    Parameters
    ----------
    change : ndarray, shape (n_v,)
        Of q+, in the tangent space there [m, rad].
    solution : StepSolution
    """

    change: Array
    solution: StepSolution


def exact_step(
    simulator: Simulator, q: ArrayLike, q_bar_a: ArrayLike, force: ArrayLike | None
) -> StepResult:
    """The step of a simulator with its exact optimum, whatever the simulator certifies."""
    result = simulator.step(q, q_bar_a, force)
    if result.solution.certificate.kind == "exact":
        return result
    solution = solve_step(result.step.replace(), NONE)
    end = simulator.system.at(q).plus(solution.delta_q)
    return replace(result, q=end.q, step=solution.step, solution=solution, end=end)


def slacks(solution: StepSolution) -> tuple[Array, Array, Array]:
    """A (m, n_v), the slack of each row, (m,) [m], and what rounding may leave of that."""
    form = standard_form(solution.step)
    x = solution.delta_q
    terms = np.abs(form.A) @ np.abs(x) + np.abs(form.b)
    return form.A, form.A @ x - form.b, SLACK * terms


class Nearby:
    """The steps of a simulator at places and parameters near those of one step.

    Places are compared as seen from where a step starts, which (-) does not depend on: what is far
    from the world's origin is then not rounded to more.

    Parameters
    ----------
    simulator : Simulator
    q : array_like, shape (n_q,)
    q_bar_a : array_like, shape (n_q_a,)
    force : array_like, shape (n_v,)

    Attributes
    ----------
    result : StepResult
        The step itself, with its exact optimum whatever the simulator certifies.
    sizes : dict of str to ndarray, shape (P,)
        By what a change of each parameter is measured [of the parameter].
    """

    def __init__(
        self, simulator: Simulator, q: ArrayLike, q_bar_a: ArrayLike, force: ArrayLike | None
    ) -> None:
        system = simulator.system
        self.simulator = simulator
        self.result: StepResult = exact_step(simulator, q, q_bar_a, force)
        self._start = system.at(q)
        self._given = np.array(q_bar_a, np.float64), checked_force(system, force)
        self._step = step = self.result.step.replace()
        self._solver = solver_for(step, NONE)
        self._quickly = simulator.backend == DAQP and simulator.certify == "full"
        self._rows = flat_rows(step, self.result.solution.certificate.active)
        self._origin = system.at(system.neutral())
        self._end = self._origin.plus(self.result.solution.delta_q)

        self._natural = NaturalStep(step)
        units = self._natural.units
        coordinate = units.size * units.coordinate
        mu_v, mu_omega = np.array([(p.mu_v, p.mu_omega) for p in simulator.pairs]).reshape(-1, 2).T
        self._no_friction = {"mu_v": mu_v == 0, "mu_omega": mu_omega == 0}
        masses = system.masses
        self.sizes: dict[str, Array] = {
            "q": np.full(system.n_v, PLACE),
            "q_bar_a": coordinate[: system.n_a],
            "tau": units.size / (step.h * units.coordinate),
            "mu_v": np.where(mu_v > 0, mu_v, 1.0),
            "mu_omega": np.where(mu_omega > 0, mu_omega, units.size * units.length),
            "K_q": np.diag(step.K_q),
            "h": np.array([step.h]),
            "masses": np.where(masses > 0, masses, masses.max() or 1.0),
        }
        self._moved = float(coordinate.max(initial=0.0))

    def unknown(self, direction: Changes) -> str:
        """Why nothing is known of steps along a direction; empty if they are."""
        system = self.simulator.system
        changed = direction.get("masses", np.zeros(0))
        links = [system.links[k] for k in np.flatnonzero(changed).tolist()]
        if welded := [link for link in links if link in system.welded]:
            problem = "a pinocchio Model has one mass for all links that are welded to each other"
            return f"{problem}: {', '.join(welded)}"
        return ""

    def only_side(self, direction: Changes) -> float:
        """The sign [-] of the only steps along a direction that changes friction of 0; else 0."""
        signs = {
            float(sign)
            for name, none in self._no_friction.items()
            for sign in np.sign(direction.get(name, np.zeros(len(none)))[none])
            if sign
        }
        return signs.pop() if len(signs) == 1 else 0.0

    @cached_property
    def _closed(self) -> tuple[Indices, Indices, Array]:
        """The rows without slack here, their contacts, (k,) each, and their rows of A, (k, n_v)."""
        step = self._step
        A, slack, rounding = slacks(self.result.solution)
        closed = np.flatnonzero(slack <= rounding)
        closed = closed[closed < step.offsets[-1]]
        return closed, np.searchsorted(step.offsets, closed, side="right") - 1, A[closed]

    def slack(self, end: End) -> tuple[Array, Array]:
        """The slack at another step's end of each row that has none here, and its rounding.

        Shapes (k,) [m]. Zero of a row that is not there: its contact is another one, or touches
        elsewhere. A row is known by its entries of A, since tangents may switch axis.
        """
        _, contact, A = self._closed
        there = end.solution.step
        A_there, slack, rounding = slacks(end.solution)
        places = {name: c for c, name in enumerate(there.contacts.name)}
        of = np.array([places.get(self._step.contacts.name[c], -1) for c in contact.tolist()], int)
        counts = np.append(there.counts, 0)[of]
        every = np.arange(there.counts.max(initial=1))
        rows = np.where(every < counts[:, None], there.offsets[of][:, None] + every, -1)
        unit = self._natural.units.coordinate
        off = np.abs((A_there[rows] - A[:, None]) * unit).max(axis=2)
        off[rows < 0] = np.inf
        nearest = off.argmin(axis=1)[:, None]
        same = np.take_along_axis(off, nearest, 1)[:, 0] <= ELSEWHERE * np.abs(A * unit).max(axis=1)
        row = np.take_along_axis(rows, nearest, 1)[:, 0]
        return np.where(same, slack[row], 0.0), rounding[row]

    def rounding_of_slack(self, changes: Changes) -> float:
        """What the rounding of places in the world leaves of a slack [m]."""
        points = self.result.points
        places = np.abs(np.concatenate([points.alpha, points.beta])).max(initial=0.0)
        return SLACK * float(places) if "q" in changes else 0.0

    def names_of_closed(self, some: Mask) -> tuple[str, ...]:
        """Names of some of the rows without slack here, (k,), each with its contact's."""
        owners = row_owners(self._step, self._closed[0][some])
        return tuple(f"{row} of {name}" for name, each in owners.items() for row in each)

    def rounding(self, changes: Changes) -> float:
        """What the rounding of a step nearby may change in q+ [m, rad]."""
        return ROUNDING if "q" in changes else ROUNDING * self._moved

    def end(self, changes: Changes) -> End:
        """The step of other parameters; errors as of a step."""
        shift = changes.get("q", np.zeros(self.simulator.system.n_v))
        start = self._start.plus(shift)
        if self._quickly and changes.keys() == {"q"}:
            solution = self.simulator.step(start, *self._given).solution
        else:
            solution = self._proved(self._changed(start, changes))
        there = self._origin.plus(shift).plus(solution.delta_q)
        return End(self.simulator.system.difference(self._end.q, there.q), solution)

    def _proved(self, step: StepData) -> StepSolution:
        """The exact optimum of a step, from the rows of the one that all are near to."""
        here = self._step
        of_loads = step.contacts is here.contacts and step.hessian is here.hessian
        natural = self._natural.with_loads(step) if of_loads else NaturalStep(step)
        accuracy = self.simulator.accuracy
        return without_warnings(step_solution, natural, self._solver, accuracy, "full", self._rows)

    def _changed(self, start: State, changes: Changes) -> StepData:
        """The data of a step from there under other parameters; q alone goes through geometry."""
        simulator = self.simulator
        system = simulator.system
        n_a = system.n_a
        kinematics = start.kinematics
        step = self._step
        if "q" in changes:
            points = simulator.closest_points(kinematics)
            step = form_step(simulator.plan, start, *self._given, points)
        if changes.keys() == {"q"}:
            return step

        change = {name: np.zeros(size.shape) for name, size in self.sizes.items()} | {**changes}
        contacts = step.contacts
        of_pair = [pair.n_c for pair in simulator.pairs]
        mu_v = np.repeat(change["mu_v"], of_pair)
        mu_omega = np.repeat(change["mu_omega"], of_pair)

        none = np.zeros(system.n_u)
        target = self._origin.plus(np.append(step.delta_q_bar_a, none))
        target = target.plus(np.append(change["q_bar_a"], none))
        delta_q_bar_a = self._origin.change_to(target.q[: system.n_q_a])
        if changes.keys() <= {"q_bar_a", "tau"}:  # g alone differs
            tau = np.concatenate([step.tau_a, step.tau_u]) + change["tau"] + 0.0
            loads = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "delta_q_bar_a": delta_q_bar_a + 0.0}
            changed: StepData = step.with_fields(**loads)
            return changed

        arms = np.einsum("lab,lb->la", kinematics.R, system.centres)
        centres = kinematics.J[:, :3] + crossed(kinematics.J[:, 3:], arms[:, :, None])
        M = np.einsum("l,lai,laj->ij", change["masses"], centres, centres)
        weights = np.einsum("l,lai,a->i", change["masses"], centres, simulator.gravity)
        weights[:n_a] *= simulator.gravity_acts
        tau = weights + change["tau"]

        return step.replace(
            contacts=replace(
                contacts,
                mu_v=contacts.mu_v + mu_v,
                mu_omega=contacts.mu_omega + mu_omega * contacts.torsion,
            ),
            K_q=step.K_q + np.diag(change["K_q"]),
            h=step.h + change["h"].item(),
            M_u=step.M_u + M[n_a:, n_a:],
            tau_a=step.tau_a + tau[:n_a],
            tau_u=step.tau_u + tau[n_a:],
            delta_q_bar_a=delta_q_bar_a,
        )

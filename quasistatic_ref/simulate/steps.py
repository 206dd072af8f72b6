"""Many steps from one state: contacts, J, H and A depend on q alone, targets and loads on g."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import overload

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.pairs import contact_layout
from quasistatic_ref.errors import ModelError, StepDataError
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Indices, checked_numbers, read_only
from quasistatic_ref.quoting import counted
from quasistatic_ref.simulate import wrenches
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.scene import Scene
from quasistatic_ref.simulate.wrenches import ContactsOverSteps
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution

SURELY = 1 - 2.0**-30
"""Factor that covers the rounding of sums of some lengths."""


class Steps(Sequence[StepResult]):
    """Steps from one state, towards many targets or under many loads.

    ``simulator.steps`` makes it; its constructor checks nothing. Each item is the result that
    ``simulator.step`` would give of a solver that starts cold.

    Parameters
    ----------
    scene : Scene
    here : State
        Where all start.
    points : ClosestPoints
        Of all.
    first : StepData
        The first step, or any that starts there.
    delta_q, lam : ndarray, shapes (N, n_v) and (N, m)
        [m, rad] and [N s].
    solution : callable
        Number of a step -> its StepSolution.

    Attributes
    ----------
    delta_q, lam : ndarray
        As above, read-only.

    Examples
    --------
    >>> scenario = qr.load_scenario("two_finger_pinch")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> targets = q[: scenario.system.n_q_a] + [[0.0], [1e-3], [2e-3]]
    >>> results = simulator.steps(q, targets)
    >>> results.q.shape == (3, scenario.system.n_q), len(results)
    (True, 3)
    >>> bool((results[1].q == simulator.step(q, targets[1]).q).all())
    True
    """

    def __init__(
        self,
        scene: Scene,
        here: State,
        points: ClosestPoints,
        first: StepData,
        delta_q: Array,
        lam: Array,
        solution: Callable[[int], StepSolution],
    ) -> None:
        self.delta_q = read_only(delta_q)
        self.lam = read_only(lam)
        self._scene = scene
        self._here = here
        self._points = points
        self._first = first
        self._solution = solution

    def __len__(self) -> int:
        return len(self.delta_q)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {counted(len(self), 'step')} from one state>"

    @overload
    def __getitem__(self, i: int) -> StepResult: ...

    @overload
    def __getitem__(self, i: slice) -> list[StepResult]: ...

    def __getitem__(self, i: int | slice) -> StepResult | list[StepResult]:
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        i = range(len(self))[i]  # or IndexError
        solution = self._solution(i)
        end = self._here.plus(self.delta_q[i])
        here = self._here.q
        return StepResult(end.q, solution.step, solution, self._points, {}, end, here, self._scene)

    @cached_property
    def q(self) -> Array:
        """The configurations after the steps, shape (N, n_q) [m, rad, -]."""
        return read_only(self._here.plus_each(self.delta_q))

    def pair_forces(self) -> dict[str, Array]:
        """Force of each pair on its beta's body, shape (N, 3) [N], world frame, by its name.

        Raises
        ------
        InputError
            As of :attr:`~quasistatic_ref.step.solution.StepSolution.forces`.
        """
        return wrenches.pair_forces(self._contacts, contact_layout(self._scene.pairs).names)

    def forces_on(self, name: str) -> Array:
        """Sums of the forces on a body or a link, shape (N, 6) [N, N m].

        As of :meth:`~quasistatic_ref.simulate.result.StepResult.forces_on`, errors too.
        """
        return wrenches.wrench_on(self._contacts, self._scene, name)

    @cached_property
    def _contacts(self) -> ContactsOverSteps:
        k = self._first.contacts
        frame = np.stack([k.d1, k.d2, k.n], axis=1)
        forces = [self._solution(i).forces for i in range(len(self))]
        N = len(self)
        q, alpha, beta, frames = (
            np.broadcast_to(one, (N, *one.shape))
            for one in (self._here.q, self._points.alpha, self._points.beta, frame)
        )
        wrench = np.reshape(np.array(forces, np.float64), (N, k.n_c, 4))
        return ContactsOverSteps(q, alpha, beta, frames, wrench)


def targets_and_loads(
    system: System, targets: ArrayLike, force: ArrayLike | None
) -> tuple[Array, Array]:
    """Targets (N, n_q_a) and loads (N, n_v) [N, N m] of N steps; one of a kind serves all.

    Raises
    ------
    ModelError, StepDataError
        If one of them has another shape.
    """
    q_bar_a = checked_numbers(targets, "targets", ModelError)
    tau = np.zeros(system.n_v) if force is None else checked_numbers(force, "force")
    tau = np.full(system.n_v, tau) if tau.shape == () and tau == 0 else tau
    wants = (
        (q_bar_a, system.n_q_a, "targets", "n_q_a", ModelError),
        (tau, system.n_v, "force", "n_v", StepDataError),
    )
    counts = {len(one) for one, *_ in wants if one.ndim == 2}
    for one, n, field, word, error in wants:
        if one.ndim not in (1, 2) or one.shape[-1] != n or len(counts) > 1:
            count = max(counts, default=1)
            problem = f"must have shape (N, {word}) = ({count}, {n}), or ({n},) for all"
            raise error(problem, field=field, value=one.shape)
    N = max(counts, default=1)
    return np.broadcast_to(q_bar_a, (N, system.n_q_a)), np.broadcast_to(tau, (N, system.n_v))


class ReachBound:
    """How far the origins of links can come by a change of the coordinates, without forming it.

    Parameters
    ----------
    system : System
    """

    def __init__(self, system: System) -> None:
        moves = system.column_map.of_coordinates(system.column_map.moves)[:, 0] != 0
        link, coordinate = np.nonzero(moves)
        count = np.bincount(link, minlength=len(moves))
        at = np.arange(len(link)) - (np.cumsum(count) - count)[link]
        self._coordinate: Indices = np.full((len(moves), count.max(initial=0)), system.n_v)
        self._coordinate[link, at] = coordinate
        self._is_length = np.array([c.unit == "m" for c in system.coordinates], dtype=bool)

    def farthest(self, t: Array, delta_q: Array) -> Array:
        """An upper bound of the distance of any link from the world's origin, (N,) [m].

        A base or a joint moves what hangs on it by no more than its way, and by its angle times how
        far that is: at most the lengths between the joints on the way, two of which are no farther
        from each other than twice the farthest is from the origin, and the ways along them.

        Parameters
        ----------
        t : ndarray, shape (L, 3)
            Origins of the links where the changes start [m], world frame.
        delta_q : ndarray, shape (N, n_v)
            [m, rad].
        """
        far = float(np.sqrt(np.square(t).sum(axis=1)).max(initial=0.0))
        size = np.pad(np.abs(delta_q), ((0, 0), (0, 1)))
        is_length = np.append(self._is_length, False)
        ways = np.where(is_length, size, 0.0)[:, self._coordinate].sum(axis=2)  # (N, L)
        angles = np.where(is_length, 0.0, size)[:, self._coordinate].sum(axis=2)
        arm = 2 * far * self._coordinate.shape[1] + ways
        return np.asarray(far + (ways + angles * arm).max(axis=1, initial=0.0)) / SURELY

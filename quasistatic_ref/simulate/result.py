"""The result of one step of a simulator."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.normals import SAYS, UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import contact_layout
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.state import State
from quasistatic_ref.numbers.arrays import Array, freeze_copies
from quasistatic_ref.shown import Shown
from quasistatic_ref.simulate import wrenches
from quasistatic_ref.simulate.scene import Scene
from quasistatic_ref.simulate.wrenches import ContactsOverSteps
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.text.plain import Plain


class StepArrays(dict[str, NDArray[Any]]):
    """Arrays over some steps that follow one another, by their names.

    A run makes them; their constructor checks nothing.

    Examples
    --------
    >>> class Lowest(qr.Observer):
    ...     def after(self, recorder, results, arrays: qr.StepArrays):
    ...         print(sorted(arrays)[:4], arrays["phi"].shape)
    ...         return {}
    >>> ball = qr.load_scenario("sphere_spin", steps=3)
    >>> run = ball.run(progress=False, observers=[Lowest()])
    ['A', 'H', 'J', 'K_q'] (3, 1)
    """


@dataclass(frozen=True, eq=False, repr=False)
class StepResult(Plain, Shown):
    """The result of one step of a simulator.

    ``simulator.step`` makes it; its constructor checks nothing.

    Parameters
    ----------
    q : ndarray, shape (n_q,)
        Configuration after the step; a copy, read-only.
    step : StepData
        The problem of the step.
    solution : StepSolution
    points : ClosestPoints
        Where the contacts were, before the step.
    seconds : dict of str to float
        Wall time of the parts: distances, rows, solve, proof, integrate [s]; not compared.
    end : State
        The system at q, from which the next step may start; not compared, copied or pickled.
    q_start : ndarray, shape (n_q,), optional
        Configuration before the step [m, rad, -]; a copy, read-only.
    scene : Scene, optional
        The system and the pairs; as the end.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> result = simulator.step(q)
    >>> result.solution.wrench[0, 2].round(6)  # the weight [N]
    np.float64(2.943)
    """

    q: Array
    step: StepData
    solution: StepSolution
    points: ClosestPoints
    seconds: dict[str, float] = field(compare=False)
    end: State = field(compare=False)
    q_start: Array | None = field(default=None, compare=False)
    scene: Scene | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        freeze_copies(self, "q")
        if self.q_start is not None:
            freeze_copies(self, "q_start")

    if not TYPE_CHECKING:  # it would answer any name

        def __getattr__(self, name: str) -> State:
            problem = f"a {type(self).__name__} has no {name!r}"
            if name == "end":
                problem = "this result is a copy, which has no end: system.at(result.q) makes it"
            raise AttributeError(problem)

    @classmethod
    @cache
    def kept(cls) -> tuple[str, ...]:
        """Names of the fields that copies and pickles keep: all but the scene and the end."""
        return tuple(name for name in super().kept() if name not in ("scene", "end"))

    @property
    def forces(self) -> Array:
        """Forces of single contacts, shape (n_c, 4) [N, N m]."""
        return self.solution.forces

    @property
    def imbalance(self) -> float:
        """The share of the load that the forces do not balance [-]."""
        return self.solution.imbalance

    def pair_forces(self) -> dict[str, Array]:
        """Force of each pair on its beta's body, shape (3,) [N], world frame, by the pair's name.

        Raises
        ------
        InputError
            If the result is from a pickle, which has no scene; or as of
            :attr:`~quasistatic_ref.step.solution.StepSolution.forces`.
        """
        contacts, scene = self._contacts()
        forces = wrenches.pair_forces(contacts, contact_layout(scene.pairs).names)
        return wrenches.ByPair({name: force[0] for name, force in forces.items()})

    def forces_on(self, name: str) -> Array:
        """Sum of the forces on a body or a link, shape (6,) [N, N m].

        Parameters
        ----------
        name : str
            A body, for all of its links; or one link, such as ``gripper/left_finger``.

        Returns
        -------
        ndarray, shape (6,)
            Force and torque along the world's axes; the torque about the origin of the link (of a
            body: of its root link) where the step started.

        Raises
        ------
        ModelError
            If there is no such body or link.
        InputError
            As :meth:`pair_forces`.
        """
        contacts, scene = self._contacts()
        return np.asarray(wrenches.wrench_on(contacts, scene, name)[0])

    def _contacts(self) -> tuple[ContactsOverSteps, Scene]:
        if self.scene is None or self.q_start is None:
            raise InputError("is not known: this result is a copy", field="scene")
        k = self.step.contacts
        points = self.points
        frame = np.stack([k.d1, k.d2, k.n], axis=1)
        arrays = self.q_start, points.alpha, points.beta, frame, self.forces
        return ContactsOverSteps(*(array[None] for array in arrays)), self.scene

    @property
    def tied(self) -> dict[str, str]:
        """Names of the contacts with several possible normals, and how one normal was chosen."""
        chosen = zip(self.step.contacts.name, self.points.tie.tolist(), strict=True)
        return {name: SAYS[tie] for name, tie in chosen if tie != UNIQUE_NORMAL}

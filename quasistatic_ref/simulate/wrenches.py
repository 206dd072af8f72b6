"""Contact forces of a trajectory, summed over bodies and over pairs, in the world frame."""

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import System
from quasistatic_ref.step.data import Array

if TYPE_CHECKING:
    from quasistatic_ref.simulate.trajectory import Trajectory


class Scene(NamedTuple):
    """What moves, and what may touch.

    Parameters
    ----------
    system : System
    pairs : tuple of ContactPair
    """

    system: System
    pairs: tuple[ContactPair, ...]


class HasScene(Protocol):
    """A Scenario, a Simulator or a Scene."""

    @property
    def system(self) -> System:
        """What moves."""

    @property
    def pairs(self) -> tuple[ContactPair, ...]:
        """What may touch."""


def wrench_on(trajectory: "Trajectory", scene: HasScene, name: str) -> Array:
    """Sum of the contact wrenches on a body or a link, in each step.

    A contact pushes beta's body with the force f = f_d1 d1 + f_d2 d2 + f_n n at the point beta
    and the torque tau_n n; it pushes alpha's body with -f at the point alpha and -tau_n n.

    Parameters
    ----------
    trajectory : Trajectory
    scene : HasScene
        That of the trajectory.
    name : str
        A body, for all of its links; or one link, such as ``gripper/left_finger``.

    Returns
    -------
    ndarray, shape (steps, 6)
        Force [N] and torque [N m] along the world's axes; the torque about the origin of the link
        (of a body: of its root link) where the step starts, as the points and normals are.

    Raises
    ------
    ModelError
        If there is no such body or link.
    InputError
        If the contacts are not those of the scene.
    """
    system, layout = scene.system, contact_layout(scene.pairs)
    link = system.link(name)
    own = [link]
    if any(body.name == name for body in system.bodies):
        own = [i for i, other in enumerate(system.links) if other.startswith(f"{name}/")]
    forces = _forces(trajectory, scene)
    tau_n = trajectory["wrench"][:, :, 3, None] * trajectory["n"] if len(forces) else forces
    origins = [system.kinematics(q).t[link] for q in trajectory["q"][: len(forces)]]
    origin = np.reshape(origins, (len(forces), 1, 3))
    total = np.zeros((len(forces), 6))
    for sign, links, key in ((1, layout.link_beta, "beta"), (-1, layout.link_alpha, "alpha")):
        on = np.isin(links, own)
        if not (len(forces) and on.any()):
            continue
        f, arm = forces[:, on], trajectory[key][:, on] - origin
        torque = np.cross(arm, f) + tau_n[:, on]
        total += sign * np.concatenate([f, torque], axis=2).sum(axis=1)
    return total


def pair_forces(trajectory: "Trajectory", scene: HasScene) -> dict[str, Array]:
    """Force of each pair on its beta's body, by the pair's name.

    Parameters
    ----------
    trajectory : Trajectory
    scene : HasScene
        That of the trajectory.

    Returns
    -------
    dict of str to ndarray, shape (steps, 3)
        Sums of f_d1 d1 + f_d2 d2 + f_n n over the pair's contacts [N], world frame; two pairs of
        one name are one entry.

    Raises
    ------
    InputError
        If the contacts are not those of the scene.
    """
    forces, names = _forces(trajectory, scene), np.array(contact_layout(scene.pairs).names)
    return {pair.name: forces[:, names == pair.name].sum(axis=1) for pair in scene.pairs}


def _forces(trajectory: "Trajectory", scene: HasScene) -> Array:
    """Force of each contact on beta's body, shape (steps, n_c, 3) [N], world frame."""
    n_c = len(contact_layout(scene.pairs).names)
    if not len(trajectory):
        return np.zeros((0, n_c, 3))
    wrench = trajectory["wrench"]
    if wrench.shape[1] != n_c or trajectory["q"].shape[1] != scene.system.n_q:
        problem = "is another one than that of the trajectory: numbers of contacts or of q differ"
        raise InputError(problem, field="scene")
    frame = np.stack([trajectory[key] for key in ("d1", "d2", "n")], axis=2)
    return np.asarray(np.einsum("kci,kcix->kcx", wrench[:, :, :3], frame))

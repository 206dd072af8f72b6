"""Contact forces, summed over bodies and over pairs, in the world frame."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.pairs import contact_layout
from quasistatic_ref.errors import InputError, MissingKey, check_kind
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.quoting import known_names
from quasistatic_ref.simulate.scene import Scene


class ContactsOverSteps(NamedTuple):
    """Where and how contacts push in some steps.

    Parameters
    ----------
    q : ndarray, shape (steps, n_q)
        Where each step starts.
    alpha, beta : ndarray, shape (steps, n_c, 3)
        Closest points there [m], world frame.
    frame : ndarray, shape (steps, n_c, 3, 3)
        Rows d1, d2 and n [-].
    wrench : ndarray, shape (steps, n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m].
    """

    q: Array
    alpha: Array
    beta: Array
    frame: Array
    wrench: Array

    @property
    def force(self) -> Array:
        """Force of each contact on beta's body, shape (steps, n_c, 3) [N], world frame."""
        return np.asarray(np.einsum("kci,kcix->kcx", self.wrench[:, :, :3], self.frame))

    def check(self, scene: Scene) -> None:
        """Raise InputError if a scene is not the one that these contacts belong to."""
        check_kind(scene, Scene, "scene", "a Scenario or Simulator")
        n_c = len(contact_layout(scene.pairs).names)
        if self.wrench.shape[1] != n_c or self.q.shape[1] != scene.system.n_q:
            problem = "must be that of the steps: numbers of contacts or of q differ"
            raise InputError(problem, field="scene")


def contacts_over_steps(arrays: Mapping[str, Array], wrench: Array) -> ContactsOverSteps:
    """The contacts of a trajectory's arrays with these wrenches, (steps, n_c, 4) [N, N m]."""
    axes = [arrays[key] for key in ("d1", "d2", "n")]
    points = arrays["alpha"], arrays["beta"]
    return ContactsOverSteps(arrays["q"][:-1], *points, np.stack(axes, axis=2), wrench)


def wrench_on(contacts: ContactsOverSteps, scene: Scene, name: str) -> Array:
    """Sum of the contact wrenches on a body or a link, in each step.

    A contact pushes beta's body with the force f = f_d1 d1 + f_d2 d2 + f_n n at the point beta
    and the torque tau_n n; it pushes alpha's body with -f at the point alpha and -tau_n n.

    Parameters
    ----------
    contacts : ContactsOverSteps
    scene : Scene
        Theirs.
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
    contacts.check(scene)
    system = scene.system
    layout = contact_layout(scene.pairs)
    link = system.link(name)
    body_links = [link]
    if any(body.name == name for body in system.bodies):
        body_links = [i for i, other in enumerate(system.links) if other.startswith(f"{name}/")]
    tau_n = contacts.wrench[:, :, 3, None] * contacts.frame[:, :, 2]
    origins = [system.kinematics(q).t[link] for q in contacts.q]
    origin = np.reshape(origins, (-1, 1, 3))
    total = np.zeros((len(contacts.q), 6))
    sides = (1, layout.link_beta, contacts.beta), (-1, layout.link_alpha, contacts.alpha)
    for sign, links, point in sides:
        on = np.isin(links, body_links)
        f = contacts.force[:, on]
        arm = point[:, on] - origin
        torque = np.cross(arm, f) + tau_n[:, on]
        total += sign * np.concatenate([f, torque], axis=2).sum(axis=1)
    return total


class ByPair(dict[str, Array]):
    """A mapping by the names of pairs; an unknown name is answered with all known names."""

    def __missing__(self, name: str) -> Array:
        raise MissingKey(f"is no pair; {known_names(self)}", field=str(name))


def pair_forces(contacts: ContactsOverSteps, pairs: Sequence[str]) -> dict[str, Array]:
    """Force of each pair on its beta's body, by the pair's name.

    Parameters
    ----------
    contacts : ContactsOverSteps
    pairs : sequence of str, length n_c
        The pair of each contact.

    Returns
    -------
    dict of str to ndarray, shape (steps, 3)
        Sums of f_d1 d1 + f_d2 d2 + f_n n over the pair's contacts [N], world frame; two pairs of
        one name are one entry.
    """
    force = contacts.force
    names = np.array(pairs)
    return ByPair({name: force[:, names == name].sum(axis=1) for name in dict.fromkeys(pairs)})

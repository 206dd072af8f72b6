"""One instant of a run as something that can be drawn: bodies placed, contacts, forces."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.friction_cone import rim
from quasistatic_ref.optional.show.figures.looks import link_colours
from quasistatic_ref.optional.show.figures.surfaces import surface_points
from quasistatic_ref.optional.show.figures.visuals import Visual
from quasistatic_ref.optional.show.loads import bearing, shown_forces
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.scene import Scene

SLIP = 1e-9
"""A contact that bears load slides where beta moves along the tangents by more in a step, or turns
about n by more over mu_omega [m]."""

MOVES = 1e-3
"""A link is looked at where it moves by more in a run [m]; or all, where none does."""


@dataclass(frozen=True, eq=False)
class DrawnContact:
    """One contact: the frame of Fig. 2 at beta, and the force on beta's body there.

    Parameters
    ----------
    beta : ndarray, shape (3,)
        [m], world frame.
    frame : ndarray, shape (3, 3)
        Rows d1, d2, n [-].
    force : ndarray, shape (3,)
        [N], world frame.
    torque : float
        About n [N m].
    f_n, mu_v, mu_omega : float
        [N], [-], [m].
    rim : ndarray, shape (N, 3)
        Forces on the edge of the friction cone, without torque, at this normal force [N].
    state : str
        ``"apart"``, or bearing load ``"sticking"`` or ``"sliding"``, where the record knows it.
    """

    beta: Array
    frame: Array
    force: Array
    torque: float
    f_n: float
    mu_v: float
    mu_omega: float
    rim: Array
    state: str

    @property
    def bears(self) -> bool:
        """Whether the contact bears load."""
        return self.state != "apart"


@dataclass(frozen=True, eq=False)
class Moment:
    """Where everything is at the start of a step, and the forces of that step.

    Parameters
    ----------
    t : float
        [s].
    shapes : tuple of PlacedShape
        Every shape once.
    R, t_links : ndarray, shapes (L, 3, 3) and (L, 3)
        Poses of the links [-], [m].
    contacts : tuple of DrawnContact
    newton : str
        The unit of force, which says where the run does not know the forces of single contacts.
    colours : dict of int to str
        The colour of each link, by its number.
    """

    t: float
    shapes: tuple[PlacedShape, ...]
    R: Array
    t_links: Array
    contacts: tuple[DrawnContact, ...]
    newton: str
    colours: dict[int, str]

    def world(self, placed: PlacedShape, points: Array) -> Array:
        """Points of a shape's own frame, (N, 3), in the world [m]."""
        R = self.R[placed.link]
        t = self.t_links[placed.link]
        return np.asarray((points @ placed.R.T + placed.t) @ R.T + t)


def still(scene: Scene) -> Moment:
    """The moment at which a scene starts: its bodies without contacts."""
    return _moment(scene, scene.system.q_start, 0.0, (), "1 N")


def moment(scene: Scene, run: Trajectory, k: int) -> Moment:
    """Step k of a run: the poses and contacts that it starts from, and its forces.

    Parameters
    ----------
    scene : Scenario or Simulator
        Whose bodies and shapes these are.
    run : Trajectory
    k : int
        From 0; from the end, if negative.

    Raises
    ------
    InputError
        If there is no such step.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin", steps=2)
    >>> len(qr.figures.moment(scenario, scenario.run(progress=False), -1).contacts)
    1
    """
    if not -run.steps <= k < run.steps:
        raise InputError(f"must be {-run.steps} to {run.steps - 1}", field="step", value=k)
    k = k % run.steps
    shown = shown_forces(run, k)
    contacts = _contacts(run, k, shown.wrench)
    start = float(run["t"][k]) - run.header.h
    return _moment(scene, run["q"][k], start, contacts, shown.newton)


def _moment(
    scene: Scene, q: Array, t: float, contacts: tuple[DrawnContact, ...], newton: str
) -> Moment:
    """A scene at q, shape (n_q,), with contacts."""
    kinematics = scene.system.kinematics(q)
    colours = link_colours(scene.system)
    return Moment(t, drawn_shapes(scene), kinematics.R, kinematics.t, contacts, newton, colours)


def frames(scene: Scene, run: Trajectory, fps: float) -> tuple[list[Moment], float]:
    """Moments of a film in real time, and how many of them a second.

    Parameters
    ----------
    scene : Scenario or Simulator
    run : Trajectory
    fps : float
        Frames a second that are wanted [1/s]; there are no more than steps.

    Raises
    ------
    InputError
        If the run has no steps.
    """
    check_kind(scene, Scene, "scene", "a Scenario or Simulator")
    check_kind(run, Trajectory, "run", "a Trajectory")
    if not run.steps:
        raise InputError("has no steps to show; take one", field="trajectory")
    h = run.header.h
    every = max(round(1 / (fps * h)), 1)
    return [moment(scene, run, k) for k in range(0, run.steps, every)], 1 / (every * h)


def drawn_shapes(scene: Scene) -> tuple[PlacedShape, ...]:
    """Every shape of a scene once: those of URDFs, clouds, and what is fixed in the world.

    A body with a cloud is drawn as that cloud.
    """
    pairs = [shape for pair in scene.pairs for shape in (pair.alpha, pair.beta)]
    clouded = {shape.link for shape in pairs if isinstance(shape.shape, PointCloud)}
    of_bodies = [shape for shape in scene.system.shapes if shape.link not in clouded]
    return tuple({id(shape): shape for shape in (*of_bodies, *pairs)}.values())


def extent(of: Moment) -> Array:
    """Least and greatest coordinates of what is bounded, shape (2, 3) [m]."""
    points = [of.world(placed, surface_points(placed.shape)) for placed in of.shapes]
    return box_of(np.concatenate([*points, *([c.beta] for c in of.contacts)]))


def box_of(points: Array) -> Array:
    """Least and greatest coordinates of points (N, 3) [m], shape (2, 3) [m]."""
    return np.array([points.min(axis=0), points.max(axis=0)])


def middle(box: Array) -> tuple[Array, float]:
    """Centre, shape (3,), of a box (2, 3), and half its longest side [m]."""
    return box.mean(axis=0), float(np.ptp(box, axis=0).max()) / 2


def focus(moments: list[Moment], looks: Sequence[Visual] = ()) -> Array:
    """Least and greatest coordinates of what moves, and of contacts, shape (2, 3) [m].

    Of links that move by a millimetre between the first moment, the middle and the last.

    Parameters
    ----------
    moments : list of Moment
    looks : sequence of Visual
        What the links look like, besides the shapes that touch.
    """
    looked_at = [moments[0], moments[len(moments) // 2], moments[-1]]
    poses = np.array([np.concatenate([m.R, m.t_links[:, :, None]], axis=2) for m in looked_at])
    moved = np.abs(poses - poses[0]).max(axis=(0, 2, 3)) > MOVES
    if not moved.any():
        moved[1:] = True
    points = [c.beta[None] for m in looked_at for c in m.contacts]
    for m in looked_at:
        moving = [placed for placed in m.shapes if moved[placed.link]]
        points += [m.world(placed, surface_points(placed.shape)) for placed in moving]
        seen = [visual for visual in looks if moved[visual.link]]
        points += [v.corners @ m.R[v.link].T + m.t_links[v.link] for v in seen]
    return box_of(np.concatenate(points))


def _contacts(run: Trajectory, k: int, wrench: Array) -> tuple[DrawnContact, ...]:
    corners = rim(run.header.cone)
    edge = np.column_stack([corners, np.ones(len(corners))])
    bears = bearing(wrench[:, 2])
    drawn = []
    for j, (*force, torque) in enumerate(wrench):
        frame = np.stack([run[axis][k, j] for axis in ("d1", "d2", "n")])
        f_n = float(force[2])
        mu_v = float(run["mu_v"][j])
        drawn.append(DrawnContact(
            beta=run["beta"][k, j],
            frame=frame,
            force=force @ frame,
            torque=float(torque),
            f_n=f_n,
            mu_v=mu_v,
            mu_omega=float(run["mu_omega"][j]),
            rim=f_n * edge * [mu_v, mu_v, 1.0] @ frame,
            state=_state(run, k, j, frame) if bears[j] else "apart",
        ))  # fmt: skip
    return tuple(drawn)


def _state(run: Trajectory, k: int, j: int, frame: Array) -> str:
    """State of a contact that bears load; ``"sticking"`` if the record does not hold it."""
    if run.header.record != "full":
        return "sticking"
    delta_q = run["delta_q"][k]  # without private rises, which J has
    motion = run["J"][k, j][:, : len(delta_q)] @ delta_q
    along = np.abs(frame[:2] @ motion[:3]).max()
    turning = run["mu_omega"][j] * abs(motion[3])
    return "sliding" if max(along, turning) > SLIP else "sticking"

"""What a run warns of: what its steps, each of them exact, did not represent.

A step knows k contacts of each pair, to first order. All is read from the record of a run, at its
end, over all steps at once. Steps are counted from 0, as everywhere.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.wrenches import Scene
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import BEYOND, IN_METRES, LEAP, SUNK

LENGTHS = {"floating": 3, "planar": 2, "prismatic": 1}
"""How many of a joint's coordinates, the first ones, are lengths; the others are angles."""


class _Sentence(NamedTuple):
    """What to say once of a table of contacts: by the step that finds it, the first is said."""

    step: int
    text: str


def watched(scene: Scene, run: Mapping[str, NDArray[np.generic]], gap: Array) -> list[str]:
    """Sentences on a run, each of which names a remedy.

    Parameters
    ----------
    scene : Scene
        Of the run.
    run : mapping of str to ndarray
        Of a trajectory of one step at least: ``phi`` [m], ``point``, of shape (steps, n_c),
        ``q``, ``delta_q`` and ``q_bar_a`` [m, rad].
    gap : ndarray, shape (steps, n_c)
        What each step predicts for its contacts, phi + n'J delta_q [m].

    Returns
    -------
    list of str
        At most one for meshes and clouds, one for each table's mu_omega, one for each table of
        contacts, one for the fastest motion, one for each joint's targets, and one for each that
        comes to lag its target by half a turn.
    """
    system, pairs = scene
    sunk = _sunk(pairs, np.asarray(run["phi"]), np.asarray(run["point"]), gap)
    leaps = _leaps(system, pairs, np.asarray(run["delta_q"]))
    q_bar_a = np.asarray(run["q_bar_a"])
    targets, turns = _targets(system, q_bar_a), _half_turns(system, np.asarray(run["q"]), q_bar_a)
    # Causes before what comes of them.
    return [*doubtful_units(scene), *sunk, *leaps, *targets, *turns]


def _table(pair: ContactPair) -> str:
    return f"contacts.{pair.name.partition('(')[0]}"


def _size(shapes: Iterable[PlacedShape]) -> list[float]:
    """Extents [m] of those shapes that have one: neither half-spaces nor single points."""
    extents = [placed.shape.extent for placed in shapes]
    return [x for x in extents if 0 < x < np.inf]


def _least(pair: ContactPair) -> float:
    return min(_size((pair.alpha, pair.beta)), default=np.inf)


def _sunk(
    pairs: Iterable[ContactPair], phi: Array, point: NDArray[np.generic], gap: Array
) -> Iterator[str]:
    """Contacts that a step finds deep and the step before did not: of each table the first."""
    first: dict[str, _Sentence] = {}
    end = 0
    for pair in pairs:
        start, end = end, end + pair.n_c
        own = np.s_[:, start:end]
        surprise, table = _surprise(pair, phi[own], point[own], gap[own]), _table(pair)
        if surprise and (table not in first or surprise.step < first[table].step):
            first[table] = surprise
    return (surprise.text for surprise in first.values())


def _surprise(
    pair: ContactPair, phi: Array, point: NDArray[np.generic], gap: Array
) -> _Sentence | None:
    deepest = SUNK * _least(pair)
    k, j = np.nonzero(phi[1:] < -deepest)  # contacts are in ascending distance
    before, number = point[k], point[k + 1, j]
    same = before == number[:, None]
    # The closest pair of two solids has one number wherever it is: that names no point.
    considered = same.any(axis=1) | (pair.n_c == 1 and not pair.has_cloud)
    predicted = np.where(considered, gap[k, same.argmax(axis=1)], 0.0)
    surprising = np.flatnonzero(np.minimum(predicted, 0.0) - phi[k + 1, j] > deepest)
    if not surprising.size:
        return None
    i = surprising[0]
    step, depth = int(k[i]) + 1, f"{-1e3 * phi[k[i] + 1, j[i]]:.3g} mm deep at step {int(k[i]) + 1}"
    what = "point" if pair.has_cloud or number[i] < pair.corners else "candidate"
    raised = f"raise k of {_table(pair)}"
    if not considered[i]:
        left_out = f"was not among its {pair.n_c} closest at step {step - 1}"
        text = f"{raised}: {what} {number[i]} of {pair.name} {left_out} and is {depth}"
        return _Sentence(step, text)
    more = f", or {raised}" if pair.n_c < pair.candidates else ""
    remedy = f"take a smaller h or move slower{more}"
    left = f"the step before, which is right to first order, left it at {1e3 * predicted[i]:.3g} mm"
    return _Sentence(step, f"{remedy}: {what} {number[i]} of {pair.name} is {depth}; {left}")


def _leaps(system: System, pairs: Iterable[ContactPair], delta_q: Array) -> list[str]:
    """The first step that moves a body of a pair by much of its size, or turns it by much."""
    moves = system.motion.of_coordinates(system.motion.moves)[:, 0] != 0  # (L, n_v)
    sides = [side for pair in pairs for side in (pair.alpha, pair.beta)]
    links = np.array([side.link for side in sides], dtype=np.int64)
    found: list[tuple[int, float, str]] = []
    for joint in system.joints:
        moved = [sides[i] for i in np.flatnonzero(moves[links, joint.v].any(axis=1))]
        motion, lengths = delta_q[:, joint.v], LENGTHS.get(joint.kind, 0)
        size = max(_size(moved), default=np.inf)
        length = np.linalg.norm(motion[:, :lengths], axis=1)
        angle = np.linalg.norm(motion[:, lengths:], axis=1)
        share = np.maximum(length / size, angle)
        if not (moved and (leaps := share > LEAP).any()):
            continue
        k = int(leaps.argmax())
        how = f"turns by {np.degrees(angle[k]):.3g} degrees"
        if length[k] / size > angle[k]:
            how = f"moves by {1e3 * length[k]:.3g} mm, {share[k]:.2g} of the {size:.3g} m it moves"
        text = (
            f"take a smaller h, move slower, or start nearer to the first target: {joint.name} "
            f"{how}, in step {k}, and a step is accurate to first order only"
        )
        found.append((k, -float(share[k]), text))
    return [text for _, _, text in sorted(found)[:1]]


def _targets(system: System, q_bar_a: Array) -> Iterator[str]:
    """Targets that look like millimetres, or lie beyond the limits that a URDF names."""
    for joint in system.joints:
        if not joint.actuated:
            continue
        value = q_bar_a[:, joint.q]
        length = np.abs(value[:, : LENGTHS.get(joint.kind, 0)])
        if length.max(initial=0.0) > IN_METRES:
            k = int(length.max(axis=1).argmax())
            yield (
                f"check the unit of the targets of {joint.name}: lengths are in metres, and that "
                f"of step {k} is {length[k].max():.3g} m"
            )
        elif joint.limits is not None:
            yield from _beyond(joint, value[:, 0], *joint.limits)


def _beyond(joint: Joint, target: Array, lower: float, upper: float) -> Iterator[str]:
    k = int(np.maximum(lower - target, target - upper).argmax())
    limit = lower if target[k] < lower else upper
    if max(lower - target[k], target[k] - upper) > BEYOND:
        unit = joint.coordinates[0].unit
        yield (
            f"change the target of {joint.name}, {target[k]:.3g} {unit} at step {k}, or the limit "
            f"in its URDF, {limit:.3g} {unit}: the model ignores limits, the robot does not"
        )


def _half_turns(system: System, q: Array, q_bar_a: Array) -> Iterator[str]:
    """Joints that come to lag their target by half a turn, from where springs turn them back."""
    for joint in system.joints:
        if not joint.actuated or joint.kind not in ("floating", "planar", "continuous"):
            continue
        lag = _lag(joint.kind, q[:-1, joint.q], q_bar_a[:, joint.q])
        far = np.linalg.norm(lag, axis=1) > np.sqrt(2)  # 2 sin of an eighth of a turn
        turned_over = far[1:] & far[:-1] & (np.vecdot(lag[1:], lag[:-1]) < 0)
        if turned_over.any():
            yield (
                f"take a larger K_q or a slower target: {joint.name} lags its target by half a "
                f"turn at step {int(turned_over.argmax()) + 1}, and a spring turns the shorter way"
            )


def _lag(kind: str, q: Array, q_bar: Array) -> Array:
    """Axis of the shorter turn from q to q_bar times 2 sin of half its angle; (steps, 1 or 3)."""
    if kind == "floating":
        v, w, v_bar, w_bar = q[:, 3:6], q[:, 6:], q_bar[:, 3:6], q_bar[:, 6:]
        both = w * v_bar - w_bar * v - np.cross(v, v_bar)
        cosine = w * w_bar + np.vecdot(v, v_bar)[:, None]
        return np.where(cosine < 0, -2.0, 2.0) * both
    (c, s), (c_bar, s_bar) = q[:, -2:].T, q_bar[:, -2:].T
    angle = np.arctan2(c * s_bar - s * c_bar, c * c_bar + s * s_bar)
    return np.asarray(2 * np.sin(angle / 2))[:, None]


def doubtful_units(scene: Scene) -> Iterator[str]:
    """Sentences on meshes, clouds and mu_omega that look like millimetres."""
    system, pairs = scene
    shapes = [*system.shapes, *(side for pair in pairs for side in (pair.alpha, pair.beta))]
    modelled = {p.name: p.shape for p in shapes if isinstance(p.shape, PointCloud | ConvexMesh)}
    long = {name: x for name, shape in modelled.items() if (x := shape.extent) > IN_METRES}
    if long:
        name = max(long, key=long.__getitem__)
        others = f" ({len(long) - 1} more are as suspect)" if len(long) > 1 else ""
        yield (
            f"check the unit of {name}: lengths are in metres, and it is {long[name]:.3g} m long; "
            f"scale it by 0.001 if that is meant in millimetres{others}"
        )
    rough = [pair for pair in pairs if pair.mu_omega > _least(pair)]
    for table, pair in {_table(pair): pair for pair in rough}.items():
        yield (
            f"check the unit of mu_omega of {table}: it is a length in metres, and "
            f"{pair.mu_omega:.3g} m is more than the size of the smaller body, {_least(pair):.3g} m"
        )

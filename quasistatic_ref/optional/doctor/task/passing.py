"""Bodies that come to be in each other, since no table lets them touch."""

from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations, islice

import numpy as np

from quasistatic_ref.contact.distance import in_world, pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import joining, least, side
from quasistatic_ref.optional.doctor.frame.tolerances import SUNK
from quasistatic_ref.optional.doctor.frame.undecided import Undecided
from quasistatic_ref.optional.doctor.texts import finding, length
from quasistatic_ref.quoting import listed
from quasistatic_ref.shapes.half_space import HalfSpace
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud, Shape
from quasistatic_ref.simulate.finding import Finding

LOOKED = 8
"""Steps, spread over a run, in which bodies are looked for that pass through each other."""
MOST_PAIRS = 300
"""Pairs of shapes that are looked at."""
NEVER_BOTH = PointCloud, HalfSpace
"""What at most one side of a pair may be."""


def through(run: Run) -> Iterator[Finding | Undecided]:
    """Bodies that come to be in each other and share no table: of each two the deepest."""
    both = [*islice(_apart(run), MOST_PAIRS + 1)] if run.complete else []
    if len(both) > MOST_PAIRS:
        yield Undecided("bodies that share no table", f"more than {MOST_PAIRS} pairs of shapes")
        return
    apart = [ContactPair(f"{a.name}, {b.name}", a, b, 0.0, 0.0, 4, 1, hull=True) for a, b in both]
    steps = sorted(set(np.linspace(0, run.steps, 1 + LOOKED).round().astype(int).tolist()))
    radii = [(_radius(pair.alpha.shape), _radius(pair.beta.shape)) for pair in apart]
    depths = np.array([_depths(run, k, apart, radii) for k in steps])
    deep = (depths[0] <= 0) & (depths > SUNK * np.array([least(pair) for pair in apart]))
    found: dict[frozenset[str], Finding] = {}
    for i, j in sorted(np.argwhere(deep).tolist(), key=lambda at: -depths[at[0], at[1]]):
        depth = float(depths[i, j])
        names = [side(run.system, shape) for shape in (apart[j].alpha, apart[j].beta)]
        cause = f"nothing lets {listed(names)} touch, and they pass through each other, "
        cause += f"{length(depth)} deep at {steps[i] * run.h:.2f} s"
        remedy = f"{joining(run, listed(names))}, or keep them apart"
        numbers = {"depth_mm": 1e3 * depth, "step": steps[i] - 1}
        one = finding("passes-through", cause, remedy, **numbers)
        found.setdefault(frozenset(name.partition("/")[0] for name in names), one)
    yield from found.values()


def _apart(run: Run) -> Iterator[tuple[PlacedShape, PlacedShape]]:
    """Pairs of shapes of two bodies, one of which moves, that no table joins.

    Two clouds have no distance, nor have two half-spaces.
    """
    shapes = {shape.name: shape for shape in (*run.system.shapes, *run.sides)}
    joined = {frozenset((_who(pair.alpha), _who(pair.beta))) for pair in run.pairs}
    moves = run.driven | run.free
    for a, b in combinations(shapes.values(), 2):
        same = run.body(a.link) == run.body(b.link)
        alike = any(isinstance(a.shape, x) and isinstance(b.shape, x) for x in NEVER_BOTH)
        joins = {_who(a), _who(b)} in joined
        if not (same or alike or joins) and moves[[a.link, b.link]].any():
            yield a, b


def _who(placed: PlacedShape) -> str | int:
    """What a table joins: a link, or a shape of the world."""
    return placed.link or placed.name


def _depths(
    run: Run, k: int, pairs: list[ContactPair], radii: list[tuple[float, float]]
) -> list[float]:
    """How deep each of some pairs is where step k starts [m]; NaN where that is not known."""
    at = run.system.kinematics(run["q"][k])
    depths = [-np.inf] * len(pairs)
    for i, (pair, reach) in enumerate(zip(pairs, radii, strict=True)):
        alpha, beta = in_world(pair, at.R, at.t)
        if _gap(alpha, beta, *reach) <= 0:
            depths[i] = np.nan
            with suppress(ContactError):  # of bodies so deep that no normal is known
                depths[i] = -float(pair_closest_points(pair, at.R, at.t).phi[0])
    return depths


def _gap(alpha: ShapeInWorld, beta: ShapeInWorld, of_alpha: float, of_beta: float) -> float:
    """Distance between balls about both shapes, of these radii; of a half-space its plane [m]."""
    for plane, other, radius in ((alpha, beta, of_beta), (beta, alpha, of_alpha)):
        if isinstance(plane.shape, HalfSpace):
            seen = (other.t - plane.t) @ plane.R
            return float(plane.shape.signed_distance(seen[None])[0][0]) - radius
    return float(np.linalg.norm(alpha.t - beta.t)) - (of_alpha + of_beta)


def _radius(shape: Shape | PointCloud) -> float:
    """Radius of a ball about the shape's origin that contains the shape [m]."""
    if isinstance(shape, PointCloud):
        return float(np.linalg.norm(shape.points, axis=1).max())
    if not np.isfinite(shape.extent):
        return np.inf
    axes = np.vstack([np.eye(3), -np.eye(3)])
    return float(np.linalg.norm(shape.support_value(axes).reshape(2, 3).max(axis=0)))

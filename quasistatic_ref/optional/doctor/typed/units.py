"""Numbers that look like another unit, or like nothing that is meant, and a run of no steps."""

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import Start, friction_of, least, table
from quasistatic_ref.optional.doctor.frame.tolerances import IN_METRES
from quasistatic_ref.optional.doctor.texts import finding, others
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.simulate.finding import Finding

ROUGH: Final = 5.0
"""Above this a number is no friction coefficient [-]: racing tyres have 1.7."""
TIMES_TOO_MANY = 10
"""Times as many contacts as a pair has candidates [-] that no one means by k."""
LONGEST = 1.0
"""Time step [s] above which milliseconds are meant: what hands move goes its whole way in it."""


def long_step(start: Start) -> Iterator[Finding]:
    """A time step of more than a second."""
    if start.h > LONGEST:
        cause = f"times are in seconds, and a step of {start.h:g} s is one straight motion between "
        cause += f"contacts that do not change; {start.h:g} ms are h = {start.h / 1e3:g}"
        yield finding("unit-of-h", cause, "check the unit of h", h_s=start.h)


def long_shapes(start: Start) -> Iterator[Finding]:
    """Meshes and clouds longer than anything that a robot meets: the longest is named."""
    shapes = {side.name: side.shape for side in (*start.system.shapes, *start.sides)}
    long = {
        name: shape.extent
        for name, shape in shapes.items()
        if isinstance(shape, PointCloud | ConvexMesh) and shape.extent > IN_METRES
    }
    if long:
        name = max(long, key=long.__getitem__)
        cause = f"lengths are in metres, and {name} is {long[name]:.3g} m long; scale it by 0.001 "
        cause += f"if that is meant in millimetres{others(len(long) - 1)}"
        yield finding("unit-of-a-shape", cause, f"check the unit of {name}", length_m=long[name])


def far_targets(run: Run) -> Iterator[Finding]:
    """Targets farther away than anything that a robot reaches."""
    for joint in run.actuated:
        targets = np.abs(run["q_bar_a"][:, joint.q][:, : joint.lengths])
        far = targets.max(axis=1, initial=0.0)
        k = int(far.argmax())
        if far[k] > IN_METRES:
            cause = f"lengths are in metres, and the target of {joint.name} in step {k} is "
            cause += f"{far[k]:.3g} m"
            remedy = f"check the unit of the targets of {joint.name}"
            yield finding("unit-of-a-target", cause, remedy, length_m=far[k], step=k)


def large_mu_omega(start: Start) -> Iterator[Finding]:
    """mu_omega longer than the smaller body, once for each table of contacts or MuJoCo scene."""
    for field, pair, more in _worst(start, "mu_omega", lambda pair: pair.mu_omega / least(pair)):
        length, size = pair.mu_omega, least(pair)
        cause = f"{field} is a length in metres, and {length:.3g} m is more than the size of the "
        cause += f"smaller body, {size:.3g} m{more}"
        remedy = f"check the unit of {field}"
        yield finding("unit-of-mu-omega", cause, remedy, mu_omega_m=length, size_m=size)


def friction(start: Start) -> Iterator[Finding]:
    """A mu_v larger than any real one, once for each table or MuJoCo scene."""
    for field, pair, more in _worst(start, "mu_v", lambda pair: pair.mu_v / ROUGH):
        cause = "a friction coefficient is the ratio of two forces, of rubber on asphalt 1, and "
        cause += f"{field} is {pair.mu_v:g}{more}"
        yield finding("no-friction-coefficient", cause, f"check {field}", mu_v=pair.mu_v)


def _worst(
    start: Start, coefficient: str, excess: Callable[[ContactPair], float]
) -> Iterator[tuple[str, ContactPair, str]]:
    """The last pair of each table that exceeds 1, or the worst of a MuJoCo scene: field, words.

    A MuJoCo scene has a pair for any two geoms that may touch, and one default for their friction.
    """
    rough = sorted((pair for pair in start.pairs if excess(pair) > 1), key=excess)
    named = {table(start, pair): pair for pair in rough}
    more = ""
    if start.system.of_mjcf and rough:
        more = others(len(rough) - 1, " pairs")
        named = dict([named.popitem()])
    for name, pair in named.items():
        yield friction_of(start, coefficient, name), pair, more


def angle(start: Start) -> Iterator[Finding]:
    """An rpy beyond a whole turn."""
    for body in start.system.bodies:
        x = float(np.abs(body.rpy).max())
        if x > 2 * np.pi:
            cause = f"angles are in radians: the {x:g} rad in rpy of {body.name} are "
            cause += f"{np.degrees(x):.4g} degrees, and {x:g} degrees are {np.radians(x):.4g} rad"
            yield finding("no-angle", cause, f"check the unit of rpy of {body.name}", angle_rad=x)


def count(start: Start) -> Iterator[Finding]:
    """A k far beyond the points of its pairs, once for each table."""
    beyond = {
        table(start, pair): pair
        for pair in start.pairs
        if pair.k > TIMES_TOO_MANY * pair.candidates
    }
    for name, pair in beyond.items():
        cause = f"k of {name} is {pair.k}, and {pair.name} has {pair.candidates} points, all of "
        cause += "which are contacts of every step"
        yield finding("no-count", cause, f"lower k of {name}", k=pair.k, points=pair.candidates)


def no_steps(start: Start) -> Iterator[Finding]:
    """The finding of a run whose `steps` is 0."""
    yield finding("no-motion", "steps is 0, and nothing happens", "raise steps", steps=0)

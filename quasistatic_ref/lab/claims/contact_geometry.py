"""Figure 2: alpha, beta, phi, n, d1, d2 of contacts, from data."""

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison
from quasistatic_ref.lab.made_steps.free_pair import geometry, pair_system
from quasistatic_ref.lab.made_steps.systems import cloud_on, on_link
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Shape, Sphere

SHAPES: dict[str, Shape] = {
    "sphere": Sphere(0.05),
    "box": Box((0.03, 0.05, 0.04)),
    "capsule": Capsule(0.03, 0.04),
    "cylinder": Cylinder(0.04, 0.05),
}
POSES = 20
SPREAD = np.tile([0.07, 0.07, 0.07, 1.0, 1.0, 1.0], 2)
"""How far each body is moved and turned at random [m, rad]."""

IDENTITY_TOLERANCE = 1e-14
"""beta - alpha = phi n and orthonormality, in metres and in ones: sums of a few products."""

DIFFERENCE = 1e-6
"""Step of central differences [m, rad]: truncation 1e-12 / gap^2, cancellation 1e-10."""

DIFFERENCE_TOLERANCE = 1e-6
"""Of derivatives of size 1: curvature over a gap of 1 mm leaves (1e-6 / 1e-3)^2."""


def evidence() -> list[Comparison]:
    """Four shapes against a cloud of points, near and inside, at random poses."""
    rng = np.random.default_rng(5)
    system = pair_system()
    cloud = cloud_on(system, "two", rng.uniform(-0.05, 0.05, (40, 3)))
    defects = []
    lengths = []
    frames = []
    slopes = []
    rows = []
    for name, shape in SHAPES.items():
        pair = ContactPair(name, on_link(system, "one", shape), cloud, 0.5, 0.01, 6, 3)
        for _ in range(POSES):
            q = system.integrate(system.q_start, rng.uniform(-1, 1, 12) * SPREAD)
            points, contacts = geometry(system, pair, q)
            gap = points.beta - points.alpha
            defects.append(gap - points.phi[:, None] * points.n)
            lengths.append(np.sign(points.phi) * np.linalg.norm(gap, axis=1) - points.phi)
            axes = np.stack([contacts.d1, contacts.d2, contacts.n], axis=1)
            frames.append(axes @ axes.transpose(0, 2, 1) - np.eye(3))
            frames.append((np.cross(contacts.d1, contacts.d2) - contacts.n)[:, None])
            if abs(points.phi).min() > 1e-3:
                slopes.append(_differences(system, pair, q, points.point))
                rows.append(np.einsum("cr,crv->cv", contacts.n, contacts.J[:, :3]))
    ordinary = [np.isfinite(s).all(axis=1) for s in slopes]
    measured = np.concatenate([s[o] for s, o in zip(slopes, ordinary, strict=True)])
    expected = np.concatenate([r[o] for r, o in zip(rows, ordinary, strict=True)])
    defect = np.concatenate(defects)
    excess = np.concatenate(lengths)
    frame = np.concatenate([f.ravel() for f in frames])
    return [
        comparison("beta - alpha - phi n [m]", defect, 0.0, IDENTITY_TOLERANCE),
        comparison("|beta - alpha| - |phi| [m]", excess, 0.0, IDENTITY_TOLERANCE),
        comparison("{d1, d2, n}, defect of a dextral triad [-]", frame, 0.0, IDENTITY_TOLERANCE),
        comparison("d phi / d q against n'J [-]", measured, expected, DIFFERENCE_TOLERANCE),
    ]


def _differences(system: System, pair: ContactPair, q: Array, chosen: NDArray[np.int64]) -> Array:
    """Central differences of phi of the chosen points; NaN where the k closest changed."""
    columns = []
    for e in DIFFERENCE * np.eye(system.n_v):
        ahead, _ = geometry(system, pair, system.integrate(q, e))
        behind, _ = geometry(system, pair, system.integrate(q, -e))
        same = np.array_equal(ahead.point, chosen) and np.array_equal(behind.point, chosen)
        change = (ahead.phi - behind.phi) / (2 * DIFFERENCE)
        columns.append(change if same else np.full(len(chosen), np.nan))
    return np.stack(columns, axis=1)


CLAIM = Claim(
    name="contact_geometry",
    sentence="alpha and beta are the closest points, beta - alpha = phi n with phi signed, n "
    "points from alpha's body to beta's also in penetration, {d1, d2, n} is dextral, and n'J is "
    "the derivative of phi.",
    where="the paper, Fig. 2 and Eqs. (2)-(4)",
    sweep="points against sphere, box, capsule and cylinder, 20 random poses each, gaps of both "
    "signs",
    reason="IDENTITY_TOLERANCE: a few sums and products; DIFFERENCE_TOLERANCE: central "
    "differences.",
    measure=evidence,
)

"""Closest points by coal, for pairs without a closed form, believed only with a proof.

For any unit vector n, the gap s(n) between two convex solids along n is at most their signed
distance. So points on both that are phi n apart, with s(n) = phi, prove themselves: apart, phi
is the distance; in penetration, n parts the solids after a translation by -phi. coal's answers
are held against that with closed-form support points, which never share its mistakes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import coal
import numpy as np

from quasistatic_ref.contact.placed import Placed, Witness
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.shapes import PointCloud
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import SUPPORT, WITNESS

ACCURACIES = (1e-10, 1e-9, 1e-8, 1e-7, 1e-6)
"""Tolerances asked of coal in turn: the tighter ones sometimes end without an answer."""

CLEARANCE = 1.0
"""How far apart, relative to the depth, the solids are put to have a normal computed."""

ROUNDS = 8
"""Refinements of a normal in penetration; each gains a factor of about curvature times depth."""


class Judged(NamedTuple):
    """coal's answer, and what is wrong with it."""

    phi: float
    alpha: Array
    beta: Array
    n: Array
    defect: float
    """|s(n) - phi| or the disagreement of the points, the larger [m]."""


def coal_witness(name: str, a: Placed, b: Placed) -> Witness:
    """Signed distance, closest points and normal of two bounded convex solids, world frame.

    Raises
    ------
    ContactError
        If coal has no answer that proves itself.
    """
    best = _asked(a, b)
    if best.phi < 0:
        best = _refined(a, b, best)
    if not best.defect <= WITNESS:  # `not <=`, so that NaN is refused as well
        raise ContactError(
            "no trustworthy contact normal at this pose; move the bodies slightly, or use a box, "
            "a capsule, a convex mesh or a cloud",
            field=name,
            value={"phi": best.phi, "n": best.n.tolist()},
        )
    return Witness(best.phi, best.alpha, best.beta, best.n)


def _asked(a: Placed, b: Placed) -> Judged:
    """The best of coal's answers, with its defect."""
    best: Judged | None = None
    for accuracy in ACCURACIES:
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        request.enable_signed_distance = True
        request.gjk_tolerance = request.epa_tolerance = accuracy
        request.gjk_max_iterations = request.epa_max_iterations = 1000
        phi = coal.distance(
            _geometry(a), coal.Transform3s(a.R, a.t), _geometry(b), coal.Transform3s(b.R, b.t),
            request, result,
        )  # fmt: skip
        alpha, beta = np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
        found = _judged(a, b, phi, alpha, beta, np.array(result.normal))
        # NaN compares as false: it never becomes the best unless there is nothing else.
        if best is None or not np.isfinite(best.defect) or found.defect < best.defect:
            best = found
        if best.defect <= SUPPORT * np.abs(a.t - b.t).max():
            break
    assert best is not None
    return best


def _judged(a: Placed, b: Placed, phi: float, alpha: Array, beta: Array, n: Array) -> Judged:
    if not (np.isfinite(phi) and np.isfinite(n).all() and abs(n @ n - 1) <= WITNESS):
        return Judged(phi, alpha, beta, n, np.inf)
    gap = n @ (b.farthest(-n) - a.farthest(n))
    apart = np.abs(beta - alpha - phi * n).max()
    return Judged(phi, alpha, beta, n, float(max(abs(gap - phi), apart)))


def _refined(a: Placed, b: Placed, first: Judged) -> Judged:
    """A normal in penetration, made as good as one apart.

    Parted along n by a little more than the depth, the solids have a distance and a normal that
    coal is good at; that normal is the next n, until it stays.
    """
    best, n = first, first.n
    for _ in range(ROUNDS):
        if not np.isfinite(n).all():
            break
        gap = float(n @ (b.farthest(-n) - a.farthest(n)))
        shift = (CLEARANCE * abs(gap) - gap) * n
        parted = _asked(a, b._replace(t=b.t + shift))
        if not (np.isfinite(parted.defect) and parted.phi > 0):
            break
        n = parted.n
        phi = float(n @ (b.farthest(-n) - a.farthest(n)))
        alpha, beta = parted.alpha, parted.beta - shift
        found = _judged(a, b, phi, alpha, alpha + phi * n, n)
        drift = float(np.abs(beta - found.beta).max())
        found = found._replace(defect=max(found.defect, drift))
        if not found.defect < best.defect:
            break
        best = found
    return best


def _geometry(solid: Placed) -> Any:
    if isinstance(solid.shape, PointCloud):
        raise ContactError("a cloud has no coal object", field="shape")
    return solid.shape.coal

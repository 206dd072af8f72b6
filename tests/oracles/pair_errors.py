"""Largest errors of a pair of solids over random poses, half of them degenerate.

- phi: |phi - reference| [m], where the plain program has a closed form (closest.py);
- inside: where it has none, by how much the gap along some of 4,000 directions exceeds phi [m]: in
  penetration a shallower way out than the one that was taken; apart, normal and points prove phi;
- normal: |s(n) - phi| [m], the gap along the normal against the distance, |n' n - 1| [-], and
  |beta - alpha - phi n| [m];
- points: distance of the witness points from the surfaces [m];
- moved: |phi' - (phi + d)| [m] after moving beta's body by d = 1 mm along n.
"""

import numpy as np

from quasistatic_ref import ContactError
from tests.contact.still import in_world, solid_pair
from tests.oracles import closest

STEP = 1e-3


def pair_errors(names, count):
    """Largest errors over some poses, and how many were refused."""
    solids = closest.solids()
    a, b = (solids[name] for name in names)
    tables = [closest.TABLES[name] for name in names]
    random = np.random.default_rng(0)
    directions = random.normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    worst = {}
    refused = 0
    here = in_world(a)
    for R, t in closest.poses(count, 0):
        try:
            found = solid_pair("pair", here, in_world(b, t, R))
            moved = solid_pair("pair", here, in_world(b, t + STEP * found.n, R))
        except ContactError:
            refused += 1
            continue
        phi = found.phi
        n = found.n
        reference = closest.signed_distance(names, R, t)
        on_a = a.signed_distance(found.alpha[None])[0][0]
        on_b = b.signed_distance(((found.beta - t) @ R)[None])[0][0]
        errors = {
            "points": max(abs(float(on_a)), abs(float(on_b))),
            "moved": abs(moved.phi - phi - STEP),
            "normal": max(abs(n @ n - 1), np.abs(found.beta - found.alpha - phi * n).max()),
        }
        if "half-space" not in names:
            along = float(closest.gap(*tables, R, t, n[None])[0])
            errors["normal"] = max(errors["normal"], abs(along - phi))
        if reference is not None:
            errors["phi"] = abs(phi - reference)
        else:
            errors["inside"] = float(closest.gap(*tables, R, t, directions).max()) - phi
        for name, error in errors.items():
            worst[name] = float(np.maximum(worst.get(name, 0.0), error))  # NaN stays
    return worst, refused

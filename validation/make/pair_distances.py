"""Signed distance, witness points and normal of every pair of shapes, on 1,000 poses each.

    python -m validation.make.pair_distances [--count POSES] [--out FILE]

For each pair, the largest of:
- phi: |phi - reference| [m], where the plain program has a closed form (tests/oracles/closest.py);
- inside: where it has none, by how much the gap along some of 4,000 directions exceeds phi [m]: in
  penetration a shallower way out than the one found; apart, normal and points prove phi;
- normal: |s(n) - phi| [m], the gap along the normal against the distance, |n' n - 1| [-], and
  |beta - alpha - phi n| [m];
- points: distance of the witness points from the surfaces [m];
- moved: |phi' - (phi + d)| [m] after moving beta's body by d = 1 mm along n.
"""

import time
from pathlib import Path

import numpy as np

from quasistatic_ref import ContactError
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.shapes.placed_shape import Shape
from tests.oracles import closest
from validation.tools.scripts import script_options, show_page

COLUMNS = ("phi", "inside", "normal", "points", "moved")
STEP = 1e-3
WORDS = """{count} poses a pair, half of them degenerate; errors in metres, sizes of 0.1 m.

Refused: curved solids that meet, and whose answer could not be proved. Microseconds are
upper bounds: the machine did other work meanwhile.
"""


def points_off(a: Shape, b: Shape, R: np.ndarray, t: np.ndarray, found: Witness) -> float:
    """How far closest points are off the surfaces [m]."""
    on_a = a.signed_distance(found.alpha[None])[0][0]
    on_b = b.signed_distance(((found.beta - t) @ R)[None])[0][0]
    return float(max(abs(on_a), abs(on_b)))


def pair_errors(names: tuple[str, str], count: int) -> tuple[dict[str, float], int, int]:
    """Largest errors over some poses, how many were in penetration, how many were refused."""
    solids = closest.solids()
    a, b = (solids[name] for name in names)
    tables = [closest.TABLES[name] for name in names]
    random = np.random.default_rng(0)
    directions = random.normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    worst = {}
    inside = refused = 0
    here = ShapeInWorld(a, np.eye(3), np.zeros(3))
    for R, t in closest.poses(count, 0):
        try:
            found = solid_pair("pair", here, ShapeInWorld(b, R, t))
            moved = solid_pair("pair", here, ShapeInWorld(b, R, t + STEP * found.n))
        except ContactError:
            refused += 1
            continue
        phi = found.phi
        n = found.n
        inside += phi < 0
        reference = closest.signed_distance(names, R, t)
        errors = {
            "points": points_off(a, b, R, t, found),
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
    return worst, inside, refused


def main() -> None:
    """Write the table."""
    options = script_options(__doc__, count=1000, out=Path)
    solids = closest.solids()
    rows = []
    for first, second in closest.pairs():
        a = solids[first]
        b = solids[second]
        worst, inside, refused = pair_errors((first, second), options.count)
        poses = list(closest.poses(50, 1))
        start = time.perf_counter()
        for R, t in poses:
            try:
                solid_pair("pair", ShapeInWorld(a, np.eye(3), np.zeros(3)), ShapeInWorld(b, R, t))
            except ContactError:
                continue
        cost = (time.perf_counter() - start) / len(poses) * 1e6
        cells = [f"{worst[name]:.1g}" if name in worst else "-" for name in COLUMNS]
        rows.append([f"{first} - {second}", *cells, inside, refused, f"{cost:.0f}"])
    table = markdown_table(("pair", *COLUMNS, "in penetration", "refused", "us"), rows)
    show_page("\n".join([WORDS.format(count=options.count), *table]), options.out)


if __name__ == "__main__":
    main()

"""Inputs of the layer `derivative`: two shapes of any kinds that are pressed together.

The shapes stand anyhow; one is moved along the line of their closest points until the gap is
small, and its body is pushed with a force that leaves it apart, or lets it stick, slide or spin.
"""

from typing import Final

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.mechanisms import (
    ORIGIN,
    few_digits,
    link,
    mass,
    random_quaternion,
)
from quasistatic_ref.lab.vectors.families.step_scenes import GRAVITY, scene
from quasistatic_ref.lab.vectors.layers.distance import answer

KINDS: Final = (
    "sphere",
    "halfspace",
    "box",
    "capsule",
    "convex",
    "cylinder",
    "cone",
    "ellipsoid",
    "cloud",
)
NO_PAIR: Final = (
    {"halfspace"},
    {"cloud"},
    {"cone"},
    {"ellipsoid"},
    {"cone", "ellipsoid"},
)
"""Kinds between which the layer ``distance`` knows no closest points."""
FLAT: Final = {"box", "convex", "cylinder"}
CURVED: Final = {"cylinder", "cone", "ellipsoid"}
H: Final = 0.01
GAPS: Final = (0.0004, 0.0001, -0.0004)
"""[m]"""
PUSHES: Final = (0.4, 2.0, 4.0, 4.0)
"""Force along the normal in units of what closes a gap of 0.4 mm in one step."""


def pair_kinds() -> list[tuple[str, str]]:
    """Kinds of alpha and beta of each pair that has a distance."""
    both = [(a, b) for i, a in enumerate(KINDS) for b in KINDS[i:]]
    return [(a, b) for a, b in both if {a, b} not in NO_PAIR]


def pressed(rng: Rng, alpha: str, beta: str, moving: str, *, driven: bool = False) -> Json:
    """The input of a case.

    Parameters
    ----------
    rng : Rng
    alpha, beta : str
        Kinds of shape.
    moving : str
        Whose body is free, ``"alpha"`` or ``"beta"``.
    driven : bool
        Whether the other stands on a driven joint, or in the world.
    """
    shapes = {"alpha": shape_of(rng, alpha), "beta": shape_of(rng, beta)}
    other = "alpha" if moving == "beta" else "beta"
    kinds = {alpha, beta}
    touching = bool(kinds & CURVED) and kinds <= FLAT | CURVED
    gap = GAPS[0] if touching else float(rng.choice(GAPS))
    place, n = placed_at(rng, shapes, moving, gap)
    towards = n if moving == "alpha" else -n
    body = link("body", None, "floating", **mass(rng))
    push = float(rng.choice(PUSHES)) * body["mass"] * GAPS[0] / H**2
    side = np.cross(towards, rng.uniform(-1, 1, 3)) * rng.uniform(0, 1.2)
    force = push * (towards + side) - body["mass"] * np.array(GRAVITY)
    torque = push * rng.uniform(-1, 1, 3) * float(rng.choice([0.0, 0.01, 0.05]))
    wrench = {"body": "body", "force": few_digits(force, 3), "torque": few_digits(torque, 4)}
    bodies, q, stiff = [body], [*place["xyz"], *place["quaternion"]], {}
    own = {moving: "body", other: None}
    if driven and shapes[other]["kind"] != "halfspace":
        joint = str(rng.choice(["prismatic", "revolute"]))
        drive = link("drive", None, joint, axis=few_digits(rng.uniform(-1, 1, 3)), actuated=True)
        bodies, q, own[other] = [drive, body], [0.0, *q], "drive"
        stiff = {
            "K_q": [[float(rng.integers(50, 500))]],
            "q_bar_a": few_digits([rng.uniform(0, 1e-3)], 5),
        }
    mu_v, mu_omega = few_digits([rng.uniform(0.1, 1.0), rng.uniform(0.001, 0.02)])
    pair = {"name": "pair", "alpha": "alpha", "beta": "beta", "mu_v": mu_v, "mu_omega": mu_omega}
    pair |= {"rows": int(rng.choice([4, 6, 6])), "k": 3 if "cloud" in kinds else 1}
    return scene(
        bodies,
        {
            side: {"body": own[side], "pose": ORIGIN, "shape": shapes[side]}
            for side in ("alpha", "beta")
        },
        q,
        pairs=[pair],
        cone=str(rng.choice(["pyramid", "pyramid", "pyramid", "product", "facets-6"])),
        wrenches=[wrench],
        **stiff,
    )


def placed_at(rng: Rng, shapes: Json, moving: str, gap: float) -> tuple[Json, np.ndarray]:
    """Where the moving shape is, `gap` [m] from the other at the origin, and n.

    Its centre starts far out in a random direction and is moved along n: of convex shapes that
    ends at the gap wanted, but for the rounding of the place.
    """
    way = rng.uniform(-1, 1, 3)
    other = shapes["beta" if moving == "alpha" else "alpha"]
    if other["kind"] == "halfspace":
        way = np.array(other["normal"]) + 0.3 * way
    xyz, quaternion = way / np.linalg.norm(way) * 0.4, random_quaternion(rng)
    n = np.zeros(3)
    for _ in range(3):
        places = {moving: {"xyz": xyz.tolist(), "quaternion": quaternion}}
        case = {**shapes, **{f"pose_{s}": places.get(s, ORIGIN) for s in ("alpha", "beta")}}
        try:
            found = answer(case)[0]
        except QuasistaticError:
            break
        nearest = int(np.argmin(found["phi"]))
        n, phi = np.array(found["n"][nearest]), found["phi"][nearest]
        xyz = xyz + (phi - gap) * (n if moving == "alpha" else -n)
    return {"xyz": few_digits(xyz, 6), "quaternion": quaternion}, n


def shape_of(rng: Rng, kind: str) -> Json:
    """A shape of some centimetres."""
    size = few_digits(rng.uniform(0.03, 0.08, 3), 3)
    match kind:
        case "sphere":
            return {"kind": kind, "radius": size[0]}
        case "box":
            return {"kind": kind, "size": size}
        case "capsule" | "cylinder" | "cone":
            return {"kind": kind, "radius": size[0], "length": size[1]}
        case "ellipsoid":
            return {"kind": kind, "half_axes": size}
        case "halfspace":
            normal = few_digits(rng.uniform([-0.8, -0.8, 0.3], [0.8, 0.8, 1.0]), 2)
            return {"kind": kind, "normal": normal, "offset": 0.0}
        case _:
            points = rng.uniform(-0.05, 0.05, (8 if kind == "convex" else 5, 3))
            name = "vertices" if kind == "convex" else "points"
            return {"kind": kind, name: [few_digits(x) for x in points]}

"""Every claim by name."""

from __future__ import annotations

from types import ModuleType
from typing import Final

from quasistatic_ref.lab.validate.claim import Claim
from quasistatic_ref.lab.validate.closed_forms import (
    couple,
    fall,
    flat_patch,
    impedance,
    incline,
    octahedron,
    patch_torsion,
    peg,
    pinch,
    planar_push,
    pushed_block,
    rolling,
    sliding_point,
    spinning_sphere,
)
from quasistatic_ref.lab.validate.engines import by_hand, drake, mujoco_friction, mujoco_rows
from quasistatic_ref.lab.validate.paper import (
    boundary_layer,
    contact_geometry,
    grasp,
    step_time,
    sticking,
    structure,
)

SECTIONS: Final[dict[str, tuple[ModuleType, ...]]] = {
    "The paper's claims": (grasp, contact_geometry, boundary_layer, step_time, structure, sticking),
    "Closed forms": (
        impedance, fall, spinning_sphere, sliding_point, octahedron, incline, rolling, pushed_block,
        pinch, patch_torsion, flat_patch, peg, couple, planar_push,
    ),
    "Independent engines": (mujoco_rows, mujoco_friction, by_hand, drake),
}  # fmt: skip


def _claims(modules: tuple[ModuleType, ...]) -> dict[str, Claim]:
    found = [x for module in modules for x in vars(module).values() if isinstance(x, Claim)]
    return {claim.name: claim for claim in found}


CLAIMS: Final[dict[str, dict[str, Claim]]] = {
    section: _claims(modules) for section, modules in SECTIONS.items()
}
"""Section -> name -> claim."""

BY_NAME: Final[dict[str, Claim]] = {
    name: claim for claims in CLAIMS.values() for name, claim in claims.items()
}

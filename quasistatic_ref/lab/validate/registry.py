"""Every claim by name."""

from __future__ import annotations

from importlib import import_module
from typing import Final

from quasistatic_ref.lab.validate.claim import Claim

MODULES: Final = {
    "The paper's claims": (
        "paper",
        "grasp contact_geometry boundary_layer step_time structure sticking",
    ),
    "Closed forms": (
        "closed_forms",
        "impedance fall spinning_sphere sliding_point octahedron incline rolling pushed_block "
        "pinch patch_torsion flat_patch peg couple planar_push",
    ),
    "Independent engines": ("engines", "mujoco_rows mujoco_friction by_hand drake"),
}
"""Section -> folder, and its modules in order."""


def _claims(folder: str, names: str) -> dict[str, Claim]:
    modules = [import_module(f"{__package__}.{folder}.{name}") for name in names.split()]
    found = [x for module in modules for x in vars(module).values() if isinstance(x, Claim)]
    return {claim.name: claim for claim in found}


CLAIMS: Final = {section: _claims(*modules) for section, modules in MODULES.items()}
"""Section -> name -> claim."""

BY_NAME: Final = {name: claim for claims in CLAIMS.values() for name, claim in claims.items()}

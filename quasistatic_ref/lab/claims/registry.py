"""Every claim by name."""

from importlib import import_module

from quasistatic_ref.lab.claims.claim import Claim

MODULES = {
    "The paper's claims": ("bunny_grasp", "contact_geometry", "boundary_layer"),
    "Closed forms": (
        "free_bodies",
        "impedance",
        "one_contact",
        "slopes",
        "pushing",
        "grips",
        "patches",
        "jams",
    ),
    "Independent engines": ("mujoco_rows",),
    "Measurements": ("measured_pushes",),
}
"""Section -> its modules, in the order of the page."""


def _claims(modules: tuple[str, ...]) -> dict[str, Claim]:
    loaded = [import_module(f"{__package__}.{name}") for name in modules]
    claims = [x for module in loaded for x in vars(module).values() if isinstance(x, Claim)]
    return {claim.name: claim for claim in claims}


CLAIMS = {section: _claims(modules) for section, modules in MODULES.items()}
"""Section -> name -> claim."""

BY_NAME = {name: claim for claims in CLAIMS.values() for name, claim in claims.items()}

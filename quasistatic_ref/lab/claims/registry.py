"""Every claim by name."""

from importlib import import_module

from quasistatic_ref.lab.claims.claim import Claim

MODULES = {
    "The paper's claims": (
        "paper.grasp",
        "paper.contact_geometry",
        "paper.boundary_layer",
        "paper.step_time",
        "paper.structure",
        "paper.sticking",
    ),
    "Closed forms": (
        "closed_forms.impedance",
        "closed_forms.fall",
        "closed_forms.spinning_sphere",
        "closed_forms.sliding_point",
        "closed_forms.octahedron",
        "closed_forms.incline",
        "closed_forms.rolling",
        "closed_forms.pushed_block",
        "closed_forms.pinch",
        "closed_forms.patch_torsion",
        "closed_forms.flat_patch",
        "closed_forms.peg",
        "closed_forms.locked_guide",
        "closed_forms.lift",
        "closed_forms.inertia",
        "closed_forms.couple",
        "closed_forms.planar_push",
    ),
    "Independent engines": (
        "engines.mujoco_rows",
        "engines.peer",
    ),
    "Measurements": ("measured.pushes",),
}
"""Section -> its modules, in the order of the page."""


def _claims(modules: tuple[str, ...]) -> dict[str, Claim]:
    loaded = [import_module(f"{__package__}.{name}") for name in modules]
    claims = [x for module in loaded for x in vars(module).values() if isinstance(x, Claim)]
    return {claim.name: claim for claim in claims}


CLAIMS = {section: _claims(modules) for section, modules in MODULES.items()}
"""Section -> name -> claim."""

BY_NAME = {name: claim for claims in CLAIMS.values() for name, claim in claims.items()}

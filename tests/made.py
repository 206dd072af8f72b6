"""What tests make and read steps, files and bits with: this file alone knows where it is kept."""

from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.contact.crossings import crossings
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.files.clouds import point_cloud, seen_points
from quasistatic_ref.files.mesh_files import loaded_mesh, mesh_hull, mesh_path
from quasistatic_ref.files.solution import infeasible_text, solution_text
from quasistatic_ref.lab.made_steps.at_random import (
    Rng,
    random_contacts,
    random_frames,
    spread_matrix,
)
from quasistatic_ref.lab.made_steps.at_random import random_step as step_on
from quasistatic_ref.lab.made_steps.contacts import (
    GRAVITY,
    X,
    Y,
    Z,
    contacts_of,
    frames_about,
    no_contacts,
    point_jacobian,
    repeated,
)
from quasistatic_ref.lab.made_steps.pinch import pinch_step
from quasistatic_ref.lab.made_steps.rigid import (
    actuated_step,
    free_step,
    point_step,
    rigid_step,
    sphere_step,
)
from quasistatic_ref.step.text import step_record, step_sha256, step_text
from quasistatic_ref.text.content import text_written
from quasistatic_ref.text.plain import Plain, bits

__all__ = [
    "GRAVITY",
    "Plain",
    "Rng",
    "StepProgram",
    "X",
    "Y",
    "Z",
    "actuated_step",
    "bits",
    "contacts_of",
    "crossings",
    "frames_about",
    "free_step",
    "infeasible_text",
    "loaded_mesh",
    "mesh_hull",
    "mesh_path",
    "no_contacts",
    "pinch_step",
    "point_cloud",
    "point_jacobian",
    "point_step",
    "random_contacts",
    "random_frames",
    "repeated",
    "rigid_step",
    "seen_points",
    "solid_pair",
    "solution_text",
    "sphere_step",
    "spread_matrix",
    "step_on",
    "step_record",
    "step_sha256",
    "step_text",
    "text_written",
]

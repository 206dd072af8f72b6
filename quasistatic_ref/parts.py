"""Optional parts: the one table that names them, and what is loaded when its word is asked for.

The core imports nothing of ``optional``, nor does what stands low import what reads files: it asks
for a word of this table. What it expects is a type of the core, stated where it asks;
tests/optional/test_expected.py gives each part to that type. Where the folder of a part is missing,
what a user wrote is refused in a sentence, or what needs no part is done without it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any, Final

from quasistatic_ref.errors import InputError

PACKAGE = "quasistatic_ref"
OPTIONAL = f"{PACKAGE}.optional"

PARTS: Final = {
    # A word: what a user wrote, and "folder.module:name".
    # Of a scene.
    "urdf_tree": ("a URDF", "files.urdf.file:urdf_tree"),
    "described_model": ("Body.of_pinocchio", "optional.pinocchio_models.described:described_model"),
    "file_mesh": ("a mesh of this format", "optional.mesh_formats.meshes:file_mesh"),
    "file_points": ("a cloud of this format", "optional.mesh_formats.points:file_points"),
    "extended_bodies": (
        "joint_friction, support and joint_limits",
        "optional.extensions.of_scenario:of_scenario",
    ),
    # Of contacts.
    "coal_witness": ("contact of curved solids", "optional.curved.by_coal:coal_witness"),
    "curve_crossings": ("a rim", "optional.curved.rims:curve_crossings"),
    "known_gaps": ("a curved solid", "optional.curved.ways_out:known_gaps"),
    "is_compiled": ("compiled code", "optional.compiled.leaves:is_compiled"),
    "compiled_function": ("compiled code", "optional.compiled.leaves:compiled_function"),
    "pairs_by_coal": ('distances = "coal"', "optional.curved.measured_by_coal:pairs_by_coal"),
    # Of a step.
    "ellipsoid": ('cone = "ellipsoid"', "optional.ellipsoid.cone:ELLIPSOID_CONE"),
    "coulomb": ('law = "coulomb"', "optional.coulomb.fixed_point:simulated_solution"),
    "coulomb_from": ("Coulomb's law", "optional.coulomb.fixed_point:fixed_point_from"),
    "posed": ("extension", "optional.extensions.extended:posed"),
    "extended_solution": ("extension", "optional.extensions.extended:extended_solution"),
    "simulated_solution": ("extension", "optional.extensions.extended:simulated_solution"),
    "contact_forces": ("forces", "optional.forces.forces:contact_forces"),
    # Of solvers.
    "function_solver": (
        "a function as backend",
        "optional.extensions.by_function:FunctionSolver",
    ),
    "function_at": ("a function as backend", "optional.extensions.by_function:function_at"),
    "qpsolvers_solver": ("qpsolvers", "optional.qpsolvers.through_qpsolvers:QpsolversSolver"),
    "qpsolvers_names": ("qpsolvers", "optional.qpsolvers.through_qpsolvers:available_solvers"),
    "daqp_solver": ('backend = "daqp"', "optional.daqp.solver:DaqpSolver"),
    "bearing_rows": ("a refined start", "optional.daqp.bearing_rows:bearing_rows"),
    "cold_replies": ('backend = "daqp"', "optional.daqp.solver:cold_replies"),
    "fast_backend": ("fast", "optional.daqp.default:default_backend"),
    # Of runs.
    "stands": ("stands", "optional.stands.stands:stands"),
    "slow_step": ("stands", "optional.stands.slow:slow_step"),
    "kept_loads": ("stands", "optional.stands.after:kept"),
    "stands_after": ("stands", "optional.stands.after:stands_after"),
    "doctor": ("strict", "optional.doctor.observer:Doctor"),
    "scene_findings": ("findings", "optional.doctor.checks:scene_findings"),
    "finding_names": ("findings", "optional.doctor.texts:NAMES"),
    # Of pages and tables.
    "page_text": ("a page", "optional.show.pages:text"),
    "page_html": ("a page", "optional.show.pages:html"),
    "step_table": ("to_pandas", "optional.show.table:data_frame"),
    "contact_table": ("to_pandas", "optional.show.table:contact_frame"),
}


def part(word: str, written: str | None = None) -> Any:
    """The function or class of an optional part that ``PARTS`` lists under a word, imported.

    Parameters
    ----------
    word : str
        One of ``PARTS``.
    written : str, optional
        What the user wrote, where that is more than the table says.

    Raises
    ------
    InputError
        If its folder is missing, or all of ``optional/``, which is then named.
    """
    by_default, place = PARTS[word]
    module, name = place.split(":")
    with needing(written or by_default):
        return getattr(import_module(f"{PACKAGE}.{module}"), name)


def is_there(word: str) -> bool:
    """Whether the optional part of a word is installed, for what can be done without it."""
    folder = ".".join(PARTS[word][1].split(".")[:2])
    try:
        import_module(f"{PACKAGE}.{folder}")
    except ModuleNotFoundError as error:
        _missing_part(error)
        return False
    return True


@contextmanager
def needing(written: str) -> Iterator[None]:
    """A context for imports of an optional part, without which the user's text means nothing.

    Raises
    ------
    InputError
        If its folder is missing, or all of ``optional/``, which is then named.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = _missing_part(error)
        problem = f"{written} needs {name.replace('.', '/')}"
        raise InputError(problem) from None


def needed_package(package: str, extra: str, what: str) -> ModuleType:
    """A package that an extra of the installation brings.

    Parameters
    ----------
    package, extra : str
    what : str
        What needs it, for the message.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        return import_module(package)
    except ImportError:
        problem = f"{what} needs {package}: pip install 'quasistatic-ref[{extra}]'"
        raise InputError(problem) from None


def _missing_part(error: ModuleNotFoundError) -> str:
    """The folder of a part that is missing; the error itself where something else is."""
    name = str(error.name)
    if not (name.startswith(OPTIONAL) and name.count(".") <= 2):
        raise error
    return name

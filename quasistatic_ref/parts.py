"""What optional parts answer: a function for each word that users write and that needs one.

The core names ``optional`` here alone, in functions, so that a part is imported when its word is
used. Where its folder is missing, a word that means nothing without it is refused in a sentence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from quasistatic_ref.errors import InputError

if TYPE_CHECKING:
    import pinocchio as pin
    from pandas import DataFrame

    from quasistatic_ref.certify.curved_cone import CurvedCone
    from quasistatic_ref.certify.optimum import ContactForces, StepSolution
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.files.mesh import Mesh
    from quasistatic_ref.files.scenario.bodies import BodyEntry, OfBodies
    from quasistatic_ref.model.system import System
    from quasistatic_ref.model.tree import Tree
    from quasistatic_ref.numbers.arrays import Array
    from quasistatic_ref.simulate.finding import Finding
    from quasistatic_ref.simulate.observer import Observer
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.trajectory import Trajectory
    from quasistatic_ref.solve.backends import Certify
    from quasistatic_ref.solve.solver import Solver
    from quasistatic_ref.step.data import StepData
    from quasistatic_ref.step.extension import StepExtension

OPTIONAL = "quasistatic_ref.optional"


@contextmanager
def needing(word: str) -> Iterator[None]:
    """Around imports of an optional part, for a word that means nothing without it.

    Raises
    ------
    InputError
        If its folder is missing, or all of ``optional/``, which is then named.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = _missing_part(error)
        problem = f"{word} needs {name.replace('.', '/')}"
        raise InputError(problem) from None


def check_there(part: str, word: str) -> None:
    """Refuse a word whose part is missing, before the work in which it is used: InputError."""
    with needing(word):
        import_module(f"{OPTIONAL}.{part}")


def is_there(part: str) -> bool:
    """Whether the folder of a part is there, for what is done without it, too."""
    try:
        import_module(f"{OPTIONAL}.{part}")
    except ModuleNotFoundError as error:
        _missing_part(error)
        return False
    return True


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


def urdf_tree(source: str | Path, package_dirs: Sequence[str | Path]) -> Tree:
    """A body's URDF: the tree in a file, or in a text that begins with ``<``.

    Parameters
    ----------
    source : str or Path
    package_dirs : sequence of str or Path
        Where ``package://`` URIs are looked for.
    """
    from quasistatic_ref.files.urdf.file import urdf_tree as tree

    return tree(source, package_dirs)


def coulomb_solution(step: StepData, solver: Solver, accuracy: float) -> StepSolution:
    """``law = "coulomb"``: the step of a simulator under Coulomb's law."""
    with needing('law = "coulomb"'):
        from quasistatic_ref.optional.coulomb.fixed_point import simulated_solution
    return simulated_solution(step, solver, accuracy)


def doctors(
    printed: bool = False, notes: bool = False, ignore: Sequence[str] = ()
) -> list[Observer]:
    """The observer that notes a run's scene and finds at its end, perhaps printing its findings.

    Parameters
    ----------
    printed, notes : bool
        Whether to print what is found, and whether to print what is not grave whole.
    ignore : sequence of str
        Names of findings that are not printed.
    """
    if not is_there("doctor"):
        return []
    from quasistatic_ref.optional.doctor.observer import Doctor

    return [Doctor(printed, notes, ignore)]


def finding_names() -> frozenset[str]:
    """``ignore``: the names that findings have; none without ``optional/doctor``."""
    if not is_there("doctor"):
        return frozenset()
    from quasistatic_ref.optional.doctor.names import NAMES

    return NAMES


def findings_of_scene(simulator: Simulator, q: Array, force: Array) -> list[Finding]:
    """``findings``: what is wrong with a scene that is to start at q, (n_q,), under a force."""
    with needing("findings"):
        from quasistatic_ref.optional.doctor.checks import scene_findings
    return scene_findings(simulator, q, force)


def findings_of_time(trajectory: Trajectory) -> list[Finding]:
    """What is found of the seconds that a run took."""
    if not is_there("doctor"):
        return []
    from quasistatic_ref.optional.doctor import checks

    return checks.looked(checks.OF_TIME, trajectory)[0]


def described_model(model: pin.Model, geometry: pin.GeometryModel | None) -> tuple[Tree, str]:
    """``Body.of_pinocchio``: the tree of a Model, and the kind of its base."""
    with needing("Body.of_pinocchio"):
        from quasistatic_ref.optional.models.described import described_model as described
    return described(model, geometry)


def pairs_by_coal(pairs: tuple[ContactPair, ...]) -> tuple[ContactPair, ...]:
    """``distances = "coal"``: pairs whose solids take their distances to points from coal."""
    with needing('distances = "coal"'):
        from quasistatic_ref.optional.curved.clouds_by_coal import pairs_by_coal as by_coal
    return by_coal(pairs)


def ellipsoid_cone() -> CurvedCone:
    """``cone = "ellipsoid"``."""
    with needing('cone = "ellipsoid"'):
        from quasistatic_ref.optional.ellipsoid.cone import ELLIPSOID_CONE
    return ELLIPSOID_CONE


def extended_solution(
    simulator: Simulator, step: StepData, extension: StepExtension
) -> StepSolution:
    """``extension``: a step of a simulator, solved with it."""
    with needing("extension"):
        from quasistatic_ref.optional.extensions.extended import simulated_solution
    return simulated_solution(simulator, step, extension)


def extended_step(
    step: StepData,
    extension: StepExtension,
    solver: str | Callable[..., Any] | Solver | None,
    fast: bool,
    accuracy: float,
    certify: Certify,
) -> StepSolution:
    """``extension``: a step solved with it, from the arguments of ``solve_step``."""
    with needing("extension"):
        from quasistatic_ref.optional.extensions.extended import extended_step as extended
    return extended(step, extension, solver, fast, accuracy, certify)


def posed(step: StepData, extension: StepExtension) -> tuple[StepData, bool]:
    """``extension``: a step with what of it is data, and whether that is all of it."""
    with needing("extension"):
        from quasistatic_ref.optional.extensions import extended
    return extended.posed(step, extension)


def extended_bodies(
    system: System,
    pairs: tuple[ContactPair, ...],
    entries: Mapping[str, BodyEntry],
    h: float,
    K_q: Array,
    gravity: Array,
) -> tuple[tuple[ContactPair, ...], OfBodies]:
    """``joint_friction``, ``support`` and ``joint_limits``: what a scenario's bodies extend.

    These are the pairs with those of supports, and what else is added to each step.
    """
    with needing("joint_friction, support and joint_limits"):
        from quasistatic_ref.optional.extensions.of_scenario import of_scenario
    return of_scenario(system, pairs, entries, h, K_q, gravity)


def fast_simulator(simulator: Simulator) -> Simulator:
    """``fast``: a simulator that takes the steps of another one sooner."""
    with needing("fast"):
        from quasistatic_ref.optional.fast.simulator import FastSimulator
    return FastSimulator(simulator)


def fast_backend(system: System, pairs: Sequence[ContactPair], cone: str, law: str) -> str:
    """``fast``: its backend where none is named.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    cone, law : str
    """
    with needing("fast"):
        from quasistatic_ref.optional.fast.simulator import default_backend
    return default_backend(system, pairs, cone, law)


def fast_solver(step: StepData, name: str | None) -> Solver:
    """``fast``: its solver of steps like this one, by the name of a backend."""
    with needing("fast"):
        from quasistatic_ref.optional.fast.solver import fast_solver as fast
    return fast(step, name)


def contact_forces(step: StepData, near: tuple[Array, Array] | None) -> ContactForces:
    """``forces``: those of a step's contacts, sought from where a solution shows them to be.

    Parameters
    ----------
    step : StepData
    near : (ndarray, ndarray), optional
        delta_q, shape (n_v,) [m, rad], and wrenches, shape (n_c, 4) [N, N m], of the solution.
    """
    with needing("forces"):
        from quasistatic_ref.optional.forces.forces import contact_forces as forces
    return forces(step, near=near)


def function_solver(step: StepData, function: str | Callable[..., Any]) -> Solver:
    """``backend = "MODULE:FUNCTION"``: a solver of steps like this one that asks a function."""
    with needing("a function as backend"):
        from quasistatic_ref.optional.extensions.by_function import FunctionSolver
    return FunctionSolver(step, function)


def qpsolvers_names() -> list[str]:
    """Names of the solvers that qpsolvers finds here."""
    if not is_there("qpsolvers"):
        return []
    from quasistatic_ref.optional.qpsolvers.through_qpsolvers import available_solvers

    return available_solvers()


def qpsolvers_solver(step: StepData, name: str) -> Solver:
    """``qpsolvers:NAME``: the solver of steps like this one."""
    with needing(name):
        from quasistatic_ref.optional.qpsolvers.through_qpsolvers import QpsolversSolver
    return QpsolversSolver(step, name)


def file_points(path: Path, kind: str) -> Array:
    """``cloud``: the points of a file of this kind, as ``.ply``, shape (N, 3) [m]."""
    with needing(f"a {kind} cloud"):
        from quasistatic_ref.optional.readers.points import file_points as points
    return points(path)


def file_mesh(path: Path, kind: str) -> Mesh:
    """``mesh``: what a file of this kind, as ``.stl``, holds."""
    with needing(f"a {kind} mesh"):
        from quasistatic_ref.optional.readers.meshes import file_mesh as mesh
    return mesh(path, kind)


def page_text(shown: object) -> str | None:
    """The page of an object in words."""
    if not is_there("show"):
        return None
    from quasistatic_ref.optional.show.pages import text

    return text(shown)


def page_html(shown: object) -> str | None:
    """The page of an object as an HTML element."""
    if not is_there("show"):
        return None
    from quasistatic_ref.optional.show.pages import html

    return html(shown)


def step_table(trajectory: Trajectory) -> DataFrame:
    """``to_pandas``: one row a step, one column a number."""
    with needing("to_pandas"):
        from quasistatic_ref.optional.show.table import data_frame
    return data_frame(trajectory)


def contact_table(trajectory: Trajectory) -> DataFrame:
    """``contacts_to_pandas``: one row a step and contact."""
    with needing("to_pandas"):
        from quasistatic_ref.optional.show.table import contact_frame
    return contact_frame(trajectory)


def _missing_part(error: ModuleNotFoundError) -> str:
    """The folder of a part that is missing; the error itself where something else is."""
    name = str(error.name)
    if not (name.startswith(OPTIONAL) and name.count(".") <= 2):
        raise error
    return name

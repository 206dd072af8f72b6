"""What runs ask of parts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from quasistatic_ref.parts import is_there, needing

if TYPE_CHECKING:
    from pandas import DataFrame

    from quasistatic_ref.certify.optimum import StepSolution
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.numbers.arrays import Array
    from quasistatic_ref.simulate.finding import Finding
    from quasistatic_ref.simulate.observer import Observer
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.trajectory import Trajectory
    from quasistatic_ref.solve.solver import Solver
    from quasistatic_ref.step.data import StepData
    from quasistatic_ref.step.extension import StepExtension


def pairs_by_coal(pairs: tuple[ContactPair, ...]) -> tuple[ContactPair, ...]:
    """``distances = "coal"``: pairs whose solids take their distances to points from coal."""
    with needing('distances = "coal"'):
        from quasistatic_ref.optional.curved.clouds_by_coal import pairs_by_coal as by_coal
    return by_coal(pairs)


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


def extended_solution(
    simulator: Simulator, step: StepData, extension: StepExtension
) -> StepSolution:
    """``extension``: a step of a simulator, solved with it."""
    with needing("extension"):
        from quasistatic_ref.optional.extensions.extended import simulated_solution
    return simulated_solution(simulator, step, extension)


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

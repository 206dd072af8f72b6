"""Where runs of another program leave the reference: the first step, the layer, the cause.

Each step of the other program is taken once more, from where it began in that run. So one wrong
step is one wrong step, however far the runs have drifted apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.norm import (
    energy_norm,
    error_length,
    load_length,
    relative_digits,
    single_loads,
)
from quasistatic_ref.errors import InputError, StepNotSolved
from quasistatic_ref.lab.oracle.alike import Diagnosis, diagnosis, known_name
from quasistatic_ref.lab.oracle.causes import Cause, Taken, causes
from quasistatic_ref.lab.oracle.parts import Part, parts_of
from quasistatic_ref.lab.oracle.run_table import OtherRun
from quasistatic_ref.lab.oracle.scene_case import SceneCases
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import standard_form

DIGITS = 6.0
"""Correct digits of a step that count as right, if not another number is asked for [-]."""
TRIED = 12
"""Wrong steps, and as many right ones, on which causes are tried."""
MATCH = 1e-3
"""How far from the other program's state a cause may end, over how far the reference does [-]."""
EXACT = 1e-9
"""How far it may end from a right step, over the displacement [-]."""
SAME = 1e-6
"""How far a state may be from the start of a known scene [m, rad, -]."""
TURNED = 2.0
"""By how many units of the last digit rounding turns a quaternion at most [-]."""
ROUNDED = 8
"""How many units of the last digit that a file keeps may come of a step."""


class StepOff(NamedTuple):
    """A step of the other program, compared with the reference's from the same state.

    Parameters
    ----------
    k : int
    q : ndarray, shape (n_q,)
        The other program's state before it [m, rad, -].
    result : StepResult
        From there.
    delta_q : ndarray, shape (n_v,)
        The displacement of the other program [m, rad].
    off : ndarray, shape (n_v,)
        Where it ended less where the reference does [m, rad].
    digits : float
    """

    k: int
    q: Array
    result: StepResult
    delta_q: Array
    off: Array
    digits: float


@dataclass(frozen=True)
class Comparison:
    """What a run is beside the reference.

    Parameters
    ----------
    scene : str
        The known one of which it is the first step; "" if it is none.
    steps : int
        That were compared.
    digits : float
        Of the worst step before the first wrong one.
    resolution : float
        To which the file's numbers are rounded [m, rad, -]; 0 if they have all digits.
    first : StepOff or None
        The first wrong step.
    contact : str
        Whose gap or slip is off the most; "" if there is none.
    causes : tuple of Cause
        None if nothing that is tried explains it, or a part is wrong.
    failed : str
        Why the reference takes no step from a state of the run.
    parts : tuple of Part
        What moves by itself in the first step of a known scene, right or wrong; else none.
    """

    scene: str
    steps: int
    digits: float
    resolution: float
    first: StepOff | None = None
    contact: str = ""
    causes: tuple[Cause, ...] = ()
    failed: str = ""
    parts: tuple[Part, ...] = ()

    @property
    def wrong_parts(self) -> list[Part]:
        """The parts that move wrongly in the first step of a known scene."""
        return [part for part in self.parts if part.way]

    @property
    def is_wrong(self) -> bool:
        """Whether a step is wrong, or there is none."""
        return self.first is not None or not self.steps


def common_causes(found: Sequence[Comparison]) -> list[Cause]:
    """The causes of all wrong runs in which causes are tried: those without wrong parts.

    Parameters
    ----------
    found : sequence of Comparison

    Returns
    -------
    list of Cause
    """
    tried = [one.causes for one in found if one.first and not one.wrong_parts]
    return [cause for cause in tried[0] if all(cause in one for one in tried)] if tried else []


def diagnosis_of_runs(found: Sequence[Comparison]) -> Diagnosis | None:
    """What wrong parts of known scenes are like; of runs of one scene, a part is wrong if in any.

    Parameters
    ----------
    found : sequence of Comparison
    """
    parts: dict[str, dict[str, Part]] = {}
    for one in found:
        own = parts.setdefault(one.scene, {}) if one.parts else {}
        for part in one.parts:
            if part.way or part.name not in own:
                own[part.name] = part
    return diagnosis({scene: [*own.values()] for scene, own in parts.items()})


def comparison_of_run(
    scenario: Scenario,
    run: OtherRun,
    digits: float = DIGITS,
) -> Comparison:
    """Take each step of a run once more, and say where it first is another.

    Parameters
    ----------
    scenario : Scenario
    run : OtherRun
    digits : float
        Of a step that counts as right [-].
    """
    unit = run.resolution
    simulator = scenario.simulator()
    scene = known_name(scenario) if run.first == 0 and _starts(scenario, run) else ""
    wrong: list[StepOff] = []
    right: list[StepOff] = []
    parts: tuple[Part, ...] = ()
    failed = ""
    for i, q in enumerate(run.q[:-1] if len(run.q) > 1 else run.q):
        k = run.first + i
        try:
            result = _reference_step(scenario, simulator, k, q)
        except StepNotSolved as error:
            failed = f"step {k}: {error}"
            break
        q_next = run.q[i + 1] if len(run.q) > 1 else None
        if scene and i == 0:
            parts = parts_of(scenario.system, result, q_next, digits, ROUNDED * unit)
        if q_next is not None:
            one = _beside(scenario, k, q, result, q_next)
            near = np.abs(one.off).max(initial=0.0) <= ROUNDED * unit
            (right if near or one.digits >= digits else wrong).append(one)
    first = wrong[0] if wrong else None
    before = [one.digits for one in right if first is None or one.k < first.k]
    worst = min(before, default=16.0)
    whole = Comparison(
        scene, len(wrong) + len(right), worst, unit, first,
        contact_of(first) if first else "", (), failed, parts,
    )  # fmt: skip
    cases = None if first is None or whole.wrong_parts else _cases(scenario)
    if first is None or cases is None:
        return whole
    taken = [_taken_step(cases, one, run, True) for one in spread(wrong)]
    if not _is_reproduced(scenario, taken[0], first):
        return whole
    kept = [_taken_step(cases, one, run, False) for one in spread(right)]
    return replace(whole, causes=tuple(causes(scenario.system, taken, kept)))


def _starts(scenario: Scenario, run: OtherRun) -> bool:
    """Whether a run starts where the scene does, as nearly as its file says it."""
    off = scenario.system.difference(scenario.system.q_start, run.q[0])
    return bool(np.abs(off).max(initial=0.0) <= max(SAME, TURNED * run.resolution))


def _reference_step(scenario: Scenario, simulator: Simulator, k: int, q: Array) -> StepResult:
    """Step k of the reference, from a state of the other program."""
    t = (k + 1) * scenario.h
    force = 0.0 if scenario.force is None else scenario.force(t, q)
    return simulator.step(q, scenario.targets(t), force)


def _cases(scenario: Scenario) -> SceneCases | None:
    """The scene for the plain program; None if that cannot hold it."""
    try:
        return SceneCases(scenario)
    except InputError:
        return None


def spread(some: list[StepOff]) -> list[StepOff]:
    """The first, and others from all over the run."""
    return some[:: -(-len(some) // TRIED)] if some else []


def _beside(scenario: Scenario, k: int, q: Array, result: StepResult, q_next: Array) -> StepOff:
    system = scenario.system
    assert result.q_start is not None
    off = system.difference(result.q, q_next)
    form = standard_form(result.step)
    n_v = system.n_v  # an extension's coordinates come after them
    H = form.H[:n_v, :n_v]
    norm = energy_norm(H)
    loads = load_length(norm, single_loads(result.step)[:, :n_v])
    exact = result.solution.delta_q[:n_v]
    length = error_length(norm, np.diag(H), form.g[:n_v], exact, loads)
    digits = relative_digits(norm.of_displacement(off), length)
    return StepOff(k, q, result, system.difference(result.q_start, q_next), off, digits)


def _taken_step(cases: SceneCases, one: StepOff, run: OtherRun, is_wrong: bool) -> Taken:
    case = cases.at(one.k, one.q)
    off = float(np.abs(one.off).max(initial=0.0))
    moved = float(np.abs(one.delta_q).max(initial=0.0))
    allowed = max(ROUNDED * run.resolution, MATCH * off if is_wrong else 4 * off + EXACT * moved)
    if is_wrong:
        allowed = min(allowed, off / 2)
    return Taken(case, run.q[one.k - run.first + 1], allowed)


def _is_reproduced(scenario: Scenario, taken: Taken, first: StepOff) -> bool:
    """Whether the plain program without a bug ends where the reference does."""
    q = scenario.system.normalised(program()("step", taken.case)["q_next"])
    off = np.abs(scenario.system.difference(first.result.q, q)).max(initial=0.0)
    return bool(off <= taken.allowed)


def contact_of(one: StepOff) -> str:
    """The contact whose gap or slip is off the most; "" if there is none."""
    step = one.result.step
    if not step.contacts.n_c:
        return ""
    off = np.abs(step.contacts.J[:, :3, : len(one.off)] @ one.off).max(axis=1)
    return step.contacts.name[int(off.argmax())] if off.any() else ""

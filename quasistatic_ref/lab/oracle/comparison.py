"""Where runs of another program leave the reference: the first step, the layer, the cause.

Each step of the other program is taken once more, from where it began in that run. So one wrong
step is one wrong step, however far the runs have drifted apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import nnls

from quasistatic_ref.certify.norm import energy_norm, relative_digits
from quasistatic_ref.errors import InputError, StepNotSolved
from quasistatic_ref.lab.oracle.causes import Cause, Taken, causes
from quasistatic_ref.lab.oracle.run_table import OtherRun
from quasistatic_ref.lab.oracle.scene_case import SceneCases
from quasistatic_ref.lab.vectors.check.common import common_of
from quasistatic_ref.lab.vectors.check.mistakes import Failed
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.check.verdict import FAILED, PASSED, Verdict
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import standard_form

OBJECTIVE = "step (H and g)"
"""What of a step is of no other layer."""
DIGITS = 6.0
"""Correct digits of a step that count as right, if not another number is asked for [-]."""
TRIED = 12
"""Wrong steps, and as many right ones, by which causes are told apart."""
CLEAR = 1e-3
"""What counts as nothing beside what is wrong in a step [-]."""
MATCH = 1e-3
"""How far from the other program's state a cause may end, over how far the reference does [-]."""
EXACT = 1e-9
"""How far it may end from a right step, over the displacement [-]."""
ROUNDED = 8
"""How many units of the last digit that a file keeps may come of a step."""


class StepOff(NamedTuple):
    """A step of the other program beside the reference's.

    Parameters
    ----------
    k : int
    result : StepResult
        From the other program's state.
    delta_q : ndarray, shape (n_v,)
        The displacement of the other program [m, rad].
    off : ndarray, shape (n_v,)
        Where it ended less where the reference does [m, rad].
    digits : float
    """

    k: int
    result: StepResult
    delta_q: Array
    off: Array
    digits: float


@dataclass(frozen=True)
class Comparison:
    """What a run is beside the reference.

    Parameters
    ----------
    steps : int
        That were compared.
    digits : float
        Of the worst step before the first wrong one.
    resolution : float
        To which the file's numbers are rounded [m, rad, -]; 0 if they have all digits.
    first : StepOff or None
        The first wrong step.
    contact : str
        Which contact it is about; "" if none.
    layers : tuple of str
        The layer; several if the run does not tell.
    causes : tuple of Cause
        None if nothing that is tried explains it.
    failed : str
        Why the reference takes no step from a state of the run.
    wrong, right : tuple of Taken
        Some steps.
    """

    steps: int
    digits: float
    resolution: float
    first: StepOff | None = None
    contact: str = ""
    layers: tuple[str, ...] = ()
    causes: tuple[Cause, ...] = ()
    failed: str = ""
    wrong: tuple[Taken, ...] = ()
    right: tuple[Taken, ...] = ()


def common_of_runs(found: Sequence[Comparison]) -> str:
    """What wrong steps of runs have in common, if no cause explains them; often empty.

    Parameters
    ----------
    found : sequence of Comparison

    Returns
    -------
    str
    """
    wrong = [_as_case(step, FAILED) for one in found for step in one.wrong]
    if not wrong or any(one.causes for one in found):
        return ""
    return common_of("step", wrong, [_as_case(step) for one in found for step in one.right])


def _as_case(one: Taken, verdict: str = PASSED) -> Failed:
    """A step as an answer to a case of the vectors, of which only delta_q is known."""
    tolerance = {"delta_q": {"absolute": one.allowed}}
    record = {"output": program()("step", one.case), "tolerance": tolerance}
    given = {"delta_q": one.delta_q.tolist()}
    return Failed("", one.case, record, given, Verdict("", verdict, field="delta_q"))


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
    cases = _cases(scenario)
    wrong: list[StepOff] = []
    right: list[StepOff] = []
    failed = ""
    for i, (q, q_next) in enumerate(zip(run.q[:-1], run.q[1:], strict=True)):
        k = run.first + i
        t = (k + 1) * scenario.h
        force = 0.0 if scenario.force is None else scenario.force(t, q)
        try:
            result = simulator.step(q, scenario.targets(t), force)
        except StepNotSolved as error:
            failed = f"step {k}: {error}"
            break
        one = _beside(scenario, k, result, q_next)
        near = np.abs(one.off).max(initial=0.0) <= ROUNDED * unit
        (right if near or one.digits >= digits else wrong).append(one)
    steps = len(wrong) + len(right)
    first = wrong[0] if wrong else None
    before = [one.digits for one in right if first is None or one.k < first.k]
    worst = min(before, default=16.0)
    taken: list[Taken] = []
    kept: list[Taken] = []
    if cases is not None:
        taken = [_taken_step(scenario, cases, one, run, True) for one in spread(wrong)]
        kept = [_taken_step(scenario, cases, one, run, False) for one in spread(right)]
    if first is None:
        return Comparison(steps, worst, unit, failed=failed, right=tuple(kept))
    contact, layers = where(first, scenario.system.n_v)
    if not taken or not _is_reproduced(scenario, taken[0], first):
        return Comparison(steps, worst, unit, first, contact, layers, (), failed)
    found = tuple(causes(scenario.system, taken, kept))
    if found:
        layers = tuple(dict.fromkeys(cause.layer for cause in found))
    some = (tuple(taken), tuple(kept))
    return Comparison(steps, worst, unit, first, contact, layers, found, failed, *some)


def _cases(scenario: Scenario) -> SceneCases | None:
    """The scene for the plain program; None if that cannot hold it."""
    try:
        return SceneCases(scenario)
    except InputError:
        return None


def spread(some: list[StepOff]) -> list[StepOff]:
    """The first, and others from all over the run."""
    return some[:: -(-len(some) // TRIED)] if some else []


def _beside(scenario: Scenario, k: int, result: StepResult, q_next: Array) -> StepOff:
    system = scenario.system
    assert result.q_start is not None
    off = system.difference(result.q, q_next)
    form = standard_form(result.step)
    n_v = system.n_v  # an extension's coordinates come after them
    norm = energy_norm(form.H[:n_v, :n_v])
    digits = relative_digits(norm.of_displacement(off), norm.of_impulse(form.g[:n_v]))
    return StepOff(k, result, system.difference(result.q_start, q_next), off, digits)


def _taken_step(
    scenario: Scenario, cases: SceneCases, one: StepOff, run: OtherRun, is_wrong: bool
) -> Taken:
    case = cases.at(one.k, run.q[one.k - run.first])
    off = float(np.abs(one.off).max(initial=0.0))
    moved = float(np.abs(one.delta_q).max(initial=0.0))
    allowed = max(ROUNDED * run.resolution, MATCH * off if is_wrong else 4 * off + EXACT * moved)
    if is_wrong:
        allowed = min(allowed, off / 2)
    return Taken(case, run.q[one.k - run.first + 1], one.delta_q, allowed)


def _is_reproduced(scenario: Scenario, taken: Taken, first: StepOff) -> bool:
    """Whether the plain program without a bug ends where the reference does."""
    q = scenario.system.normalised(program()("step", taken.case)["q_next"])
    off = np.abs(scenario.system.difference(first.result.q, q)).max(initial=0.0)
    return bool(off <= taken.allowed)


def where(one: StepOff, n_v: int) -> tuple[str, tuple[str, ...]]:
    """The contact and the layer of a wrong step, by its forces alone.

    The displacement of the other program needs the impulse p = H delta_q - g. Where p is one of
    the rows without slack, the solution on another working set was taken. Where p is one of
    contacts that press, but gaps close or open otherwise, the distances are others; where it is
    within reach of the contacts' forces, but not of their cones, the rows are; else J, H or g.
    Forces that reach every direction tell none of these apart.

    Returns
    -------
    contact : str
    layers : tuple of str
    """
    step = one.result.step
    form = standard_form(step)
    if step.n_v != n_v or not len(form.b):
        return "", (OBJECTIVE, "integrate")
    unit = 1 / np.sqrt(np.diag(form.H))
    p = unit * (form.H @ one.delta_q - form.g)
    nothing = CLEAR * np.abs(unit * (form.H @ one.off)).max()  # beside what is wrong
    rows = form.A * unit
    owner = np.repeat(np.arange(step.contacts.n_c), np.diff(step.offsets))
    lam, rest = nnls(rows.T, p, maxiter=30 * len(p) + 1000)
    names = step.contacts.name
    slack = form.A @ one.delta_q - form.b
    tight = np.abs(slack) <= CLEAR * np.abs(form.A @ one.off).max()
    own, *_ = np.linalg.lstsq(rows[tight].T, p, rcond=None)
    if tight.any() and np.abs(rows[tight].T @ own - p).max() <= nothing:
        worst = np.full(len(slack), np.inf)
        worst[tight] = own / max(np.abs(own).max(), 1e-300)
        worst[~tight] = slack[~tight] / np.abs(slack).max()
        return names[owner[int(np.argmin(worst))]], ("qp",)
    if rest <= nothing:
        gaps = np.where(lam > CLEAR * lam.max(initial=0.0), np.abs(slack), -slack)
        return names[owner[int(np.argmax(gaps))]], ("distance", "rows")
    J = np.concatenate(step.contacts.J) * unit
    forces, *_ = np.linalg.lstsq(J.T, p, rcond=None)
    left = np.abs(J.T @ forces - p).max()
    pressing = int(np.argmax(np.abs(forces).reshape(-1, 4).max(axis=1)))
    reaches_all = np.linalg.matrix_rank(J) == n_v
    if left <= nothing and not reaches_all:
        return names[pressing], ("rows",)
    untouched = ~np.abs(J).any(axis=0)
    free = np.abs(p[untouched]).max(initial=0.0) > nothing
    if free or not one.result.solution.lam.any():
        return "", (OBJECTIVE, "integrate")
    others = ("jacobian", OBJECTIVE, "integrate")
    return names[pressing], (("rows", *others) if reaches_all else others)

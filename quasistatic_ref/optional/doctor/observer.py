"""The observer of a run: it notes numbers of each step and the scene, and finds at the end."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.formats.plain import field_values
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.account import scene_notes
from quasistatic_ref.optional.doctor.artifacts import (
    boundary_layer,
    gap_after,
    gives,
    quasi_dynamic_number,
)
from quasistatic_ref.optional.doctor.checks import (
    NO_STEPS,
    OF_RUN,
    OF_SCENE,
    Check,
    findings,
    not_looked_at,
)
from quasistatic_ref.optional.doctor.run import Run, largest
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.header import Header
from quasistatic_ref.simulate.observer import Observer, Recording
from quasistatic_ref.simulate.result import StepArrays, StepResult
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import StepData


class Doctor(Observer):
    """The findings on a run, and the largest of its artifacts, in the header of its trajectory.

    Parameters
    ----------
    printed : bool
        Whether to print the findings on standard error, too.
    """

    notes = ("gap", "moved", "Pi", "layer", "momentum", "gives")

    def __init__(self, printed: bool) -> None:
        self.printed = printed

    def after(
        self, recorder: Recording, results: Sequence[StepResult], arrays: StepArrays
    ) -> dict[str, Array]:
        """What is read at the end, of each step.

        Gaps after the step, shape (steps, n_c) [m]; J delta_q, (steps, n_c, 4) [m, m, m, rad], of
        which a light record holds nothing; each (steps,): Pi [-] and boundary layer [m]; M_u
        delta_q_u, (steps, n_u) [kg m, kg m^2]; what springs give along n, (steps, n_c) [m/N].
        """
        system = recorder.system
        simulator = recorder.simulator
        n_u = system.n_u
        g = float(np.linalg.norm(simulator.gravity))
        gap = gap_after(arrays["phi"], arrays["n"], arrays["motion"])
        if system.constant_mass_matrix and simulator.extension is None:
            blocks = system.mass_blocks
            u = arrays["delta_q"][:, system.n_a :].reshape(len(results), *blocks.shape[:2], 1)
            momentum = (blocks @ u).reshape(len(results), n_u)
        else:
            each = [_momentum(one.step, one.solution.delta_q)[:n_u] for one in results]
            momentum = np.array(each)
        return {
            "gap": gap,
            "moved": arrays["motion"],
            "Pi": quasi_dynamic_number(system, results[0].step, arrays["delta_q"], g),
            "layer": boundary_layer(gap, arrays["wrench"]),
            "momentum": momentum,
            "gives": gives([result.step for result in results]),
        }

    def end(self, recorder: Recording, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """The trajectory with its findings: unless they are printed, they are looked for late."""
        known = field_values(trajectory.header) | {
            "scene": scene_notes(recorder),
            "quasi_dynamic_number": largest(recorder.noted("Pi")),
            "largest_boundary_layer": largest(recorder.noted("layer")) or 0.0,
        }
        del known["findings"], known["not_looked_at"]
        header: Header
        try:
            run = Notes(recorder, self.notes), trajectory
        except MemoryError as error:
            header = Header(**known, findings=(), not_looked_at=_lost(error))
        else:
            header = LateHeader.unchecked(**known, run=run)
        if not self.printed:
            return replace(trajectory, header=header)
        trajectory = replace(trajectory, header=Header(**field_values(header)))
        for finding in trajectory.findings:
            print(f"quasistatic-ref: {finding}", file=sys.stderr)
        if header.not_looked_at:
            print(f"quasistatic-ref: not looked at: {header.not_looked_at}", file=sys.stderr)
        return trajectory


class Notes:
    """What a run's findings ask of its recorder, which may go.

    Parameters
    ----------
    recorder : Recording
    names : sequence of str
        Of what its observers keep.
    """

    def __init__(self, recorder: Recording, names: Sequence[str]) -> None:
        self.simulator = recorder.simulator
        self.system = recorder.system
        self.start = recorder.start
        self.q = recorder.q
        self.steps = recorder.steps
        self.tracks = recorder.tracks
        self.idle_columns = recorder.idle_columns
        self._arrays = {name: recorder.noted(name) for name in ("tau", *names)}

    def noted(self, name: str) -> NDArray[Any]:
        """What an observer kept of each step, shape (steps, ...) [any unit]."""
        return self._arrays[name]


class LateHeader(Header):
    """A header whose findings are looked for when they are first read, or copied.

    Attributes
    ----------
    run : tuple of Notes and Trajectory
        What is looked at.
    """

    run: tuple[Notes, Trajectory]

    @classmethod
    def compared_as(cls) -> type:
        """As any header."""
        return Header

    def __reduce__(self) -> tuple[Any, ...]:
        return _header, (field_values(self),)

    @cached_property
    def _diagnosis(self) -> tuple[tuple[Finding, ...], str]:
        """Findings, and what was not looked at: an error costs the findings, and not the run."""
        try:
            return _looked_for(*self.run)
        except (MemoryError, QuasistaticError) as error:
            return (), _lost(error)

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """As of a header."""
        return self._diagnosis[0]

    @cached_property
    def not_looked_at(self) -> str:
        """As of a header."""
        return self._diagnosis[1]


def _lost(error: Exception) -> str:
    """The findings, as not looked at because of an error."""
    return f"findings: {type(error).__name__} {error}".rstrip()


def _header(values: dict[str, Any]) -> Header:
    return Header(**values)


def _momentum(step: StepData, delta_q: Array) -> Array:
    """M_u delta_q_u, shape (..., n_u) [kg m, kg m^2], of delta_q, shape (..., n_v) [m, rad]."""
    return np.asarray((step.M_u @ delta_q[..., step.n_a :, None])[..., 0])


def _looked_for(recorder: Recording, trajectory: Trajectory) -> tuple[tuple[Finding, ...], str]:
    """The findings, and what was not looked at."""
    of = Start(recorder.simulator, recorder.start)
    checks: tuple[Check, ...] = OF_SCENE
    if trajectory.steps:
        of = Run(recorder, trajectory)
        checks += OF_RUN
    elif not trajectory.failed:
        checks += NO_STEPS
    every = findings(checks, of)
    skipped = [not_looked_at(checks, of)]
    if isinstance(of, Run) and not of.own_terms:
        skipped.append(of.looking.not_looked_at)
    return tuple(every), "; ".join(filter(None, skipped))

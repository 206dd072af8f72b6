"""The observer of a run: it notes numbers of each step and the scene, and finds at the end."""

import sys
from collections.abc import Sequence
from dataclasses import fields, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.artifacts import boundary_layer, gives, quasi_dynamic_number
from quasistatic_ref.optional.doctor.checks import (
    NO_STEPS,
    OF_RUN,
    OF_SCENE,
    Check,
    looked,
)
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.optional.doctor.undecided import failure
from quasistatic_ref.simulate.finding import Finding, told
from quasistatic_ref.simulate.header import Header
from quasistatic_ref.simulate.observer import Observer, Recording
from quasistatic_ref.simulate.result import StepArrays, StepResult
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.text.plain import field_values


class Doctor(Observer):
    """The findings on a run, and the largest of its artifacts, in the header of its trajectory.

    Parameters
    ----------
    printed : bool
        Whether to print the findings on standard error, too.
    ignore : sequence of str
        Names of findings that are not said.
    """

    notes = ("moved", "momentum", "gives")

    def __init__(self, printed: bool = False, ignore: Sequence[str] = ()) -> None:
        self.printed = printed
        self.ignore = tuple(ignore)

    def after(
        self, recorder: Recording, results: Sequence[StepResult], arrays: StepArrays
    ) -> dict[str, Array]:
        """Note the numbers of each step that findings need at the end of the run.

        J delta_q, shape (steps, n_c, 4) [m, m, m, rad], of which a light record holds nothing; M_u
        delta_q_u, (steps, n_u) [kg m, kg m^2]; what springs give along n, (steps, n_c) [m/N].
        Nothing where that fails, as without room: it costs the findings, and not the run.
        """
        try:
            return {
                "moved": arrays["motion"],
                "momentum": _momentum(recorder.system, results, arrays["delta_q"]),
                "gives": gives([result.step for result in results]),
            }
        except Exception:
            return {}

    def end(self, recorder: Recording, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """The trajectory with its findings, which are computed late unless they are printed."""
        known = field_values(trajectory.header) | {
            "largest_boundary_layer": 0.0,
            "ignore": self.ignore,
        }
        lost = ""
        noted = len(recorder.noted("gives"))
        try:
            at: Start = Start(recorder.simulator, recorder.start)
            if noted < trajectory.steps:  # there was no room, or Ctrl-C came in between
                lost = f"findings: nothing is noted of the steps after {noted}"
            elif trajectory.steps:
                at = run = Run(recorder, trajectory)
                known["quasi_dynamic_number"] = quasi_dynamic_number(run)
                known["largest_boundary_layer"] = boundary_layer(run)
        except Exception as error:
            lost = f"findings: {failure(error)}"
        header = Header(**known | {"not_looked_at": lost})
        if not lost:
            del known["findings"], known["not_looked_at"]
            header = LateHeader.unchecked(**known, at=at)
        if not self.printed:
            return replace(trajectory, header=header)
        trajectory = replace(trajectory, header=Header(**field_values(header)))
        for line in told(trajectory.findings, trajectory.ignored_findings):
            print(f"quasistatic-ref: {line}", file=sys.stderr)
        if header.not_looked_at:
            print(f"quasistatic-ref: not looked at: {header.not_looked_at}", file=sys.stderr)
        return trajectory


def _momentum(system: System, results: Sequence[StepResult], delta_q: Array) -> Array:
    """M_u delta_q_u of some steps, shape (steps, n_u) [kg m, kg m^2]."""
    n_u = system.n_u
    delta_q_u = delta_q[:, system.n_a :]
    if system.constant_mass_matrix:
        M_u = system.mass_blocks
    else:
        M_u = np.array([result.step.M_u[:n_u, :n_u] for result in results])[:, None]
    by_block = delta_q_u.reshape(len(results), M_u.shape[-3], M_u.shape[-1], 1)
    return np.asarray((M_u @ by_block).reshape(delta_q_u.shape))


class LateHeader(Header):
    """A header whose findings are computed when they are first read or copied.

    Attributes
    ----------
    at : Start or Run
        What is looked at.
    """

    at: Start

    @classmethod
    def compared_as(cls) -> type:
        """The class :class:`Header`, as which a late header is compared."""
        return Header

    def with_fields(self, **changes: Any) -> Self:
        """A copy with some fields replaced, whose findings are as late."""
        late = {"findings", "not_looked_at"}
        kept = {
            field.name: getattr(self, field.name)
            for field in fields(Header)
            if field.name not in late
        }
        return self.unchecked(**kept | changes, at=self.at)

    def __reduce__(self) -> tuple[Any, ...]:
        return _header, (field_values(self),)

    @cached_property
    def _diagnosis(self) -> tuple[tuple[Finding, ...], str]:
        """The findings, and the checks that were not made."""
        return _looked_for(self.at, self.failed is not None)

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """The field of :class:`Header` of this name, computed when it is first read."""
        return self._diagnosis[0]

    @cached_property
    def not_looked_at(self) -> str:
        """The field of :class:`Header` of this name, computed when it is first read."""
        return self._diagnosis[1]


def _header(values: dict[str, Any]) -> Header:
    return Header(**values)


def _looked_for(at: Start, failed: bool) -> tuple[tuple[Finding, ...], str]:
    """The findings at the end of a run, and the checks that were not made."""
    checks: tuple[Check, ...] = OF_SCENE
    if isinstance(at, Run):
        checks += OF_RUN
    elif not failed:
        checks += NO_STEPS
    found, skipped = looked(checks, at)
    return tuple(found), skipped

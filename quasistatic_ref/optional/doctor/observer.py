"""The observer of a run: it notes numbers of each step and the scene, and finds at the end."""

import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property, partial
from typing import Any, Self

import numpy as np

from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.added import largest_drag
from quasistatic_ref.optional.doctor.checks import (
    NO_STEPS,
    OF_RUN,
    OF_SCENE,
    looked,
)
from quasistatic_ref.optional.doctor.did.artifacts import (
    boundary_layer,
    gives,
    quasi_dynamic_number,
)
from quasistatic_ref.optional.doctor.did.numbers import least_artifacts, resolved_number
from quasistatic_ref.optional.doctor.frame.hinged import motions
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import Start
from quasistatic_ref.optional.doctor.frame.undecided import failure
from quasistatic_ref.simulate.finding import Finding, told
from quasistatic_ref.simulate.observer import Observer, Recording
from quasistatic_ref.simulate.record.header import Header
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.result import StepArrays, StepResult
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

    notes = ("moved", "momentum", "gives", "hinged")

    def __init__(self, printed: bool = False, ignore: Sequence[str] = ()) -> None:
        self.printed = printed
        self.ignore = tuple(ignore)

    def after(
        self, recorder: Recording, results: Sequence[StepResult], arrays: StepArrays
    ) -> dict[str, Array]:
        """Note the numbers of each step that findings need at the end of the run.

        J delta_q, shape (steps, n_c, 4) [m, m, m, rad], of which a light record holds nothing; M_u
        delta_q_u, (steps, n_u) [kg m, kg m^2]; what springs give along n, (steps, n_c) [m/N]; and
        J delta_q by mechanisms that nothing drives, (steps, n_c, 2, 3) [m].
        Nothing where that fails, as without room: it costs the findings, and not the run.
        """
        try:
            return {
                "moved": arrays["motion"],
                "momentum": _momentum(recorder.system, results, arrays["delta_q"]),
                "gives": gives([result.step for result in results]),
                "hinged": motions(recorder.simulator, results, arrays["delta_q"]),
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
                least = least_artifacts(trajectory, recorder.simulator)
                known |= {
                    "quasi_dynamic_number": resolved_number(quasi_dynamic_number(run), least[0]),
                    "largest_boundary_layer": resolved_number(boundary_layer(run), least[1]),
                }
        except Exception as error:
            lost = f"findings: {failure(error)}"
        header = Header(**known | {"not_looked_at": lost})
        if not lost:
            del known["findings"], known["not_looked_at"]
            header = LateHeader.unchecked(**known, at=at)
        trajectory = replace(trajectory, header=header)
        if self.printed:
            lines = [*told(trajectory.findings, trajectory.ignored_findings)]
            lines += [f"not looked at: {header.not_looked_at}"] * bool(header.not_looked_at)
            for line in lines:
                print(f"quasistatic-ref: {line}", file=sys.stderr)
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
    __qualname__ = "Header"  # as which it is shown

    @classmethod
    def compared_as(cls) -> type:
        """The class :class:`Header`, as which a late header is compared."""
        return Header

    def with_fields(self, **changes: Any) -> Self:
        """A copy with some fields replaced, which looks no second time."""
        return self.unchecked(**vars(self) | changes)

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(Header, **field_values(self)), ()

    @cached_property
    def _looked(self) -> tuple[list[Finding], str]:
        """The findings, and the checks that were not made."""
        of_run = NO_STEPS if self.failed is None else ()
        return looked(OF_SCENE + (OF_RUN if isinstance(self.at, Run) else of_run), self.at)

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """The field of :class:`Header` of this name, computed when it is first read."""
        return tuple(self._looked[0])

    @cached_property
    def not_looked_at(self) -> str:
        """The field of :class:`Header` of this name, computed when it is first read."""
        return self._looked[1]

    @property
    def drag(self) -> str:
        """The drag of the pair in which it is most: ``; drag about 0.5 of 2.46 N at push``."""
        with suppress(Exception):  # it costs the words, and not the run
            return largest_drag(self.at) if isinstance(self.at, Run) else ""
        return ""

"""DAQP called by its own interface, group by group, and kept between steps."""

from __future__ import annotations

from quasistatic_ref.optional.fast.program import Program, Workspaces
from quasistatic_ref.solve.backends import check_backend
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solver import BackendSolver, OptionSet, Solver
from quasistatic_ref.solve.units import (
    HessianInBothUnits,
    StepInBothUnits,
    Units,
)
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.groups import groups

DAQP = "daqp"


def fast_solver(step: StepData, name: str | None = None) -> Solver:
    """DAQP by its own interface, where it is asked for by name or by default; others as without.

    Parameters
    ----------
    step : StepData
    name : str, optional
        Of the backend.
    """
    polyhedral = cone(step.cone).polyhedral
    if name is None:
        name = DAQP if polyhedral else None
    elif name == DAQP:
        check_backend(name, step.cone)
    return FastSolver(step) if name == DAQP else solver_for(step, name)


class FastSolver(BackendSolver):
    """DAQP for steps of one kind; it starts from its answer to the step before.

    Parameters
    ----------
    template : StepData
        A step of that kind, in a polyhedral cone.
    name : str
        ``"daqp"``.

    Attributes
    ----------
    program : Program
        Of the groups of the step that was written last.
    written : Units or None
        Natural units of the step that a simulator has written into the program.
    """

    interface = "native"
    remembers = True
    fixed = ("n_a", "n_u", "cone", "contacts.rows", "extra")

    def __init__(self, template: StepData, name: str = DAQP) -> None:
        super().__init__(template, name)
        self.program = Program(groups(template))
        self.written: Units | None = None
        self._hessian: HessianInBothUnits | None = None

    def in_both_units(self, step: StepData) -> StepInBothUnits:
        """The step in both units; what H gives of them is kept while H is the same array."""
        return StepInBothUnits(step, self._hessian)

    def write(self, both: StepInBothUnits) -> None:
        """Write the program, unless a simulator has."""
        self._hessian = both.hessian
        if self.written is not both.units:
            if not self.program.has_all_of(both.natural_form):
                self.program = Program(groups(both.si_step))
            self.program.write(both.natural_form)
        self.written = None

    def reply(self, option_set: OptionSet, both: StepInBothUnits) -> Reply:
        """One attempt, by the workspaces that are kept if the groups are those of before."""
        assert self._hessian is not None
        kept = option_set.kept
        option_set.kept = None  # what has raised is set up again
        if not isinstance(kept, Workspaces) or kept.program is not self.program:
            kept = Workspaces(self.program, self._hessian, option_set.options)
        reply = kept.reply(self._hessian)
        option_set.kept = kept
        return reply

"""DAQP called by its own interface, group by group, and kept between steps."""

from __future__ import annotations

from quasistatic_ref.optional.fast.program import Program, Workspaces
from quasistatic_ref.solve.backends import Options, check_backend
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solver import BackendSolver, Solver
from quasistatic_ref.solve.units import HessianInBothUnits, StepInBothUnits
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.groups import groups
from quasistatic_ref.step.standard_form import StandardForm

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


class FormedStep(StepInBothUnits):
    """A step whose matrices are formed already; what else is known of it may be set.

    Parameters
    ----------
    step : StepData
    form : StandardForm
        Its H, g, A and b.
    """

    def __init__(self, step: StepData, form: StandardForm) -> None:
        super().__init__(step)
        self.si_form = form


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
    written : FormedStep or None
        The step that a simulator has written into the program.
    """

    interface = "native"
    remembers = True
    fixed = ("n_a", "n_u", "cone", "contacts.rows", "extra")

    def __init__(self, template: StepData, name: str = DAQP) -> None:
        super().__init__(template, name)
        self.program = Program(groups(template))
        self.written: FormedStep | None = None
        self._kept: dict[int, Workspaces] = {}
        self._hessian: HessianInBothUnits | None = None

    def write(self, both: StepInBothUnits) -> None:
        """Write the program, unless a simulator has."""
        self._hessian = both.hessian
        if self.written is not both:
            if not self.program.has_all_of(both.natural_form):
                self.program = Program(groups(both.si_step))
            self.program.write(both.natural_form)
        self.written = None

    def reply(self, options: Options, both: StepInBothUnits) -> Reply:
        """One attempt, by the workspaces that are kept if the groups are those of before."""
        assert self._hessian is not None
        kept = self._kept.pop(id(options), None)  # what has raised is set up again
        if kept is None or kept.program is not self.program:
            kept = Workspaces(self.program, self._hessian, options)
        reply = kept.reply(self._hessian)
        self._kept[id(options)] = kept
        return reply

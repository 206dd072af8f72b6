"""DAQP called by its own interface, group by group, and kept between steps."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from quasistatic_ref.certify.groups import Group, group_step, group_steps, groups
from quasistatic_ref.numbers.arrays import Array, all_finite
from quasistatic_ref.optional.fast.joined import JoinedStep
from quasistatic_ref.optional.fast.program import Program, Workspaces
from quasistatic_ref.solve.backends import Options, check_backend
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solver import BackendSolver, Reply, Solver
from quasistatic_ref.solve.units import ScaledStep, of_group, out_of_range
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm, Units

DAQP = "daqp"


def fast_solver(step: StepData, name: str | None = None) -> Solver:
    """DAQP by its own interface if `name` asks for it; another solver through CVXPY.

    Parameters
    ----------
    step : StepData
    name : str, optional
        Of the backend.
    """
    if name is None and cone(step.cone).polyhedral:
        name = DAQP
    if name != DAQP:
        return solver_for(step, name)
    check_backend(name, step.cone)
    return FastSolver(step)


class FormedStep(ScaledStep):
    """A step whose natural units and program are already computed.

    Parameters
    ----------
    step : JoinedStep
    units : Units
        Its natural units.
    blocks : list of ndarray, shape (n, n)
        H of each group in natural units [-].
    program : Program
        Overwritten by the next step.
    """

    def __init__(
        self, step: JoinedStep, units: Units, blocks: Sequence[Array], program: Program
    ) -> None:
        super().__init__(step, units)
        self.step: JoinedStep = step
        self.blocks = blocks
        self.program = program

    def check_range(self) -> None:
        """Refuse a step that natural units take out of the range of float64: StepDataError."""
        if not all(map(all_finite, (self.program.f, self.program.A, self.program.b))):
            raise out_of_range()

    @cached_property
    def _finer(self) -> list[tuple[int, Group, Group, StepData]]:
        """The groups of each group of the program: J may have zeros by chance.

        Each with the number of that, counted in that, counted in the step, and as a step.
        """
        parts = []
        if self.step.couples_all:
            both = zip(self.program.groups, self.program.within, strict=True)
            return [
                (i, part, group, group_step(self.step, group))
                for i, (group, part) in enumerate(both)
            ]
        for i, group in enumerate(self.program.groups):
            whole = group_step(self.step, group)
            for part, step in group_steps(whole):
                of_step = Group(*(of_all[some] for of_all, some in zip(group, part, strict=True)))
                parts.append((i, part, of_step, step))
        return parts

    @cached_property
    def groups(self) -> list[tuple[Group, StepData]]:
        """The groups of the step, each as a step of its own in SI units."""
        return [(group, step) for _, _, group, step in self._finer]

    @cached_property
    def natural_by_group(self) -> list[StandardForm]:
        """The standard form of each group in the natural units of the step."""
        forms = []
        for i, part, _, _ in self._finer:
            f, A, b = self.program.parts[i]
            forms.append(of_group(StandardForm(self.blocks[i], -f, A, b), part))
        return forms


class FastSolver(BackendSolver):
    """DAQP for steps of one kind; each starts from the answer of the step before.

    Parameters
    ----------
    template : StepData
        A step of that kind, in a polyhedral cone.
    name : str
        ``"daqp"``.
    parts : sequence of Group, optional
        Its groups, where they are known.

    Attributes
    ----------
    program : Program
        Of the groups of the step that was written last.
    written : FormedStep or None
        The step that a simulator has written into the program.
    """

    interface = "native"
    remembers = True
    basic = True
    fixed = ("n_a", "n_u", "cone", "contacts.rows", "extra")

    def __init__(
        self, template: StepData, name: str = DAQP, parts: Sequence[Group] | None = None
    ) -> None:
        super().__init__(template, name)
        self.program = Program(groups(template) if parts is None else parts)
        self.written: FormedStep | None = None
        self._kept: dict[int, Workspaces] = {}
        self._H: Array | None = None
        self._blocks: Sequence[Array] = ()

    def write(self, scaled: ScaledStep) -> None:
        """Write the program, unless a simulator has."""
        if self.written is scaled:
            self._blocks = self.written.blocks
            self._H = None
        else:
            form = scaled.natural
            if not self.program.has_all_of(form):
                self.program = Program(groups(scaled.step))
                self._H = None
            self.program.write(form)
            if self._H is None or not np.array_equal(self._H, form.H):
                self._H = form.H
                self._blocks = self.program.blocks(form.H)
        self.written = None

    def reply(self, options: Options, scaled: ScaledStep) -> Reply:
        """One attempt, in the kept workspaces if the groups of the step are as before."""
        kept = self._kept.pop(id(options), None)  # what has raised is set up again
        if kept is None or kept.program is not self.program:
            kept = Workspaces(self.program, self._blocks, options)
        reply = kept.reply(self._blocks)
        self._kept[id(options)] = kept
        return reply

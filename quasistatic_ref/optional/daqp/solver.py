"""DAQP called by its own interface, group by group, in workspaces that are kept between steps.

Its matrices are dense, and so are those of a group; each step starts from the active set of the
step before. What it answers then depends on that step in its last bits, unless it is proved.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import daqp
import numpy as np

from quasistatic_ref.numbers.arrays import all_finite
from quasistatic_ref.solve.backends import DAQP, Options
from quasistatic_ref.solve.by_group import GroupLayout, Programs
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip


class Workspace:
    """DAQP's workspace of one group, whose active set is kept.

    Parameters
    ----------
    form : StandardForm
        Of the first step, in natural units [-]; the next ones have its sizes.
    options : dict
        DAQP's own.
    """

    def __init__(self, form: StandardForm, options: Options) -> None:
        self._cold = np.zeros(len(form.b), np.int32)
        self._warm = False
        self._options = options
        if len(form.b):
            self._set_up(form)

    def _set_up(self, form: StandardForm) -> None:
        """Prepare a new workspace."""
        self._H = form.H
        self._model: Any = daqp.Model()
        self._model.settings = self._options
        above = np.full(len(form.b), np.inf)
        # DAQP reads them where they are.
        self._held = {"f": -form.g, "A": form.A, "bupper": above, "blower": form.b}
        self._model.setup(form.H, *self._held.values(), self._cold)

    def reply(self, form: StandardForm) -> Reply:
        """Solve a program: from the answer before, if there is one, then cold.

        A workspace that has had no finite answer may have none for ever: it is set up again.
        """
        if not len(form.b):
            return Reply(form.free(), np.zeros(0), True, "optimal", 0)
        reply = self._solved(form, warm=True) if self._warm else None
        if reply is None or not reply.solved:
            reply = self._solved(form, warm=False)
        if not all_finite(reply.answer[0]):
            self._set_up(form)
            reply = self._solved(form, warm=False)
        self._warm = reply.solved
        return reply

    def _solved(self, form: StandardForm, *, warm: bool) -> Reply:
        changes: dict[str, Any] = {"f": -form.g, "A": form.A, "blower": form.b}
        if not warm or form.H is not self._H:  # else DAQP keeps its factor, with the same bits
            changes["H"] = self._H = form.H
        if not warm:
            changes["sense"] = self._cold
        self._model.update(**changes)
        self._held |= changes
        x, _, flag, info = self._model.solve()
        lam = 0.0 - info["lam"]  # those of lower bounds are negative
        status = STATUS.get(flag) or str(flag)
        return Reply(x, lam, flag == 1, status, info["iterations"], info["solve_time"])


class Workspaces:
    """The workspaces of all groups of a layout.

    Parameters
    ----------
    programs : Programs
        Of a step.
    options : dict
        DAQP's own.
    """

    def __init__(self, programs: Programs, options: Options) -> None:
        self.layout: GroupLayout = programs.layout
        self._each = [Workspace(form, options) for form in programs.forms]

    def reply(self, programs: Programs) -> Reply:
        """Solve the programs of a step."""
        both = zip(self._each, programs.forms, strict=True)
        return joined(programs, [one.reply(form) for one, form in both])


def joined(programs: Programs, replies: Sequence[Reply]) -> Reply:
    """The reply to a step from the replies to its groups: solved if all are."""
    if len(replies) == 1:
        return replies[0]
    each = [reply.answer for reply in replies]
    x = programs.joined([x for x, _ in each])
    lam = np.zeros(len(programs.b))
    lam[programs.layout.rows] = np.concatenate([lam_of for _, lam_of in each])
    worst = min(replies, key=lambda reply: reply.solved)
    iterations = sum(reply.iterations or 0 for reply in replies)
    seconds = sum(reply.seconds or 0.0 for reply in replies)
    return Reply(x, lam, worst.solved, worst.status, iterations, seconds)


class DaqpSolver(BackendSolver):
    """DAQP for steps of one kind; each starts from the answer of the step before.

    Parameters
    ----------
    template : StepData
        A step of that kind, in a polyhedral cone.
    name : str
        ``"daqp"``.
    """

    interface = "native"
    remembers = True
    basic = True
    fixed = ("n_a", "n_u", "cone", "contacts.rows", "extra")

    def __init__(self, template: StepData, name: str = DAQP) -> None:
        super().__init__(template, name)
        self._kept: dict[int, Workspaces] = {}

    def write(self, scaled: ScaledStep) -> None:
        """Form the programs of the step's groups; StepDataError if a number is not finite."""
        scaled.check_range()

    def reply(self, options: Options, scaled: ScaledStep) -> Reply:
        """One attempt, in the kept workspaces if the groups of the step are as before."""
        kept = self._kept.pop(id(options), None)  # what has raised is set up again
        if kept is None or kept.layout is not scaled.layout:
            kept = Workspaces(scaled.programs, options)
        reply = kept.reply(scaled.programs)
        self._kept[id(options)] = kept
        return reply

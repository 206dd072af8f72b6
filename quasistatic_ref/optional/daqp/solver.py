"""DAQP called by its own interface, group by group, in workspaces that are kept between steps.

Its matrices are dense, and so are those of a group; each step starts from the active set of the
step before. What it answers then depends on that step in its last bits, unless it is proved.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import daqp
import numpy as np

from quasistatic_ref.numbers.arrays import Array, all_finite
from quasistatic_ref.solve.backends import DAQP, Options
from quasistatic_ref.solve.by_group import GroupLayout, Programs
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.data import StepData

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip


class Answer(NamedTuple):
    """DAQP's answer to the program of a group.

    Parameters
    ----------
    x, lam : ndarray, shapes (n,) and (m,)
        The minimiser and the multipliers, in natural units [-].
    flag : int
        DAQP's word, 1 where it claims a solution.
    iterations : int
    seconds : float
    """

    x: Array
    lam: Array
    flag: int
    iterations: int
    seconds: float


class Workspace:
    """DAQP's workspace of one group, whose active set is kept.

    Parameters
    ----------
    H : ndarray, shape (n, n)
        Of the first step, in natural units [-], as all of these.
    f, A, b : ndarray, shapes (n,), (m, n) and (m,)
        f = -g. DAQP reads them where they are: they are written again for each step.
    options : dict
        DAQP's own.
    """

    def __init__(self, H: Array, f: Array, A: Array, b: Array, options: Options) -> None:
        self._program = {"f": f, "A": A, "blower": b}
        self._above = np.full(len(b), np.inf)
        self._cold = np.zeros(len(b), np.int32)
        self._warm = False
        self._options = options
        if len(b):
            self._set_up(H)

    def _set_up(self, H: Array) -> None:
        """Prepare a new workspace for the matrix H."""
        self._H = H
        self._model: Any = daqp.Model()
        self._model.settings = self._options
        f, A, b = self._program.values()
        self._model.setup(H, f, A, self._above, b, self._cold)

    def answer(self, H: Array) -> Answer:
        """Solve the program as it stands: from the answer before, if there is one, then cold.

        A workspace that has had no finite answer may have none for ever: it is set up again.
        """
        if not len(self._cold):
            x = np.asarray(np.linalg.solve(H, -self._program["f"]), dtype=np.float64)
            return Answer(x, np.zeros(0), 1, 0, 0.0)
        answer = self._solved(H, warm=True) if self._warm else None
        if answer is None or answer.flag != 1:
            answer = self._solved(H, warm=False)
        if not all_finite(answer.x):
            self._set_up(H)
            answer = self._solved(H, warm=False)
        self._warm = answer.flag == 1
        return answer

    def _solved(self, H: Array, *, warm: bool) -> Answer:
        if warm and H is self._H:  # DAQP keeps its factor, with the same bits
            self._model.update(**self._program)
        elif warm:
            self._model.update(H=H, **self._program)
        else:
            self._model.update(H=H, sense=self._cold, **self._program)
        self._H = H
        x, _, flag, info = self._model.solve()
        lam = 0.0 - info["lam"]  # those of lower bounds are negative
        return Answer(x, lam, flag, info["iterations"], info["solve_time"])


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
        f, A, b = map(np.zeros_like, (programs.g, programs.A, programs.b))
        self._program = programs._replace(g=f, A=A, b=b)
        forms = zip(self._program.forms, programs.blocks, strict=True)
        self._each = [Workspace(H, form.g, form.A, form.b, options) for form, H in forms]

    def reply(self, programs: Programs) -> Reply:
        """Solve the programs of a step: solved if all are."""
        np.negative(programs.g, out=self._program.g)
        self._program.A[:] = programs.A
        self._program.b[:] = programs.b
        both = zip(self._each, programs.blocks, strict=True)
        answers = [one.answer(H) for one, H in both]
        flag = next((one.flag for one in answers if one.flag != 1), 1)
        x = programs.joined([one.x for one in answers])
        lam = np.zeros(len(programs.b))
        lam[self.layout.rows] = np.concatenate([one.lam for one in answers])
        iterations = sum(one.iterations for one in answers)
        seconds = sum(one.seconds for one in answers)
        return Reply(x, lam, flag == 1, STATUS.get(flag) or str(flag), iterations, seconds)


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

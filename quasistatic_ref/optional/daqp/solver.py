"""DAQP called by its own interface, group by group, in workspaces that are kept between steps.

Its matrices are dense, and so are those of a group; each step starts from the active set of the
step before. What it answers then depends on that step in its last bits, unless it is proved.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import daqp
import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, all_finite
from quasistatic_ref.solve.backends import DAQP, Options
from quasistatic_ref.solve.by_group import GroupIndex, GroupPrograms
from quasistatic_ref.solve.many import ManyReplies
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.step.data import StepData

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip


class Answer(NamedTuple):
    """DAQP's answer to the program of a group.

    `seconds` is the time of the calls [s].

    Parameters
    ----------
    x, lam : ndarray, shapes (n,) and (m,)
        The minimiser, and the multipliers as DAQP has them, those of lower bounds negative: in
        natural units [-].
    flag : int
        DAQP's word, 1 where it claims a solution.
    iterations : int
    seconds : float [s]
    """

    x: Array
    lam: Array
    flag: int
    iterations: int
    seconds: float


class Workspace:
    """DAQP's workspace of one group, whose active set is kept.

    `f` is the linear term, in natural units [-].

    Parameters
    ----------
    H : ndarray, shape (n, n)
        Of the first step, in natural units [-], as all of these.
    f, A, b : ndarray, shapes (n,), (m, n) and (m,) [-]
        f = -g. DAQP reads them where they are: they are written again for each step.
    options : dict
        DAQP's own.
    """

    def __init__(self, H: Array, f: Array, A: Array, b: Array, options: Options) -> None:
        self._program = f, A, None, b
        self._above = np.full(len(b), np.inf)
        self._cold = np.zeros(len(b), np.int32)
        self._warm = False
        self._options = options
        self._H = H
        if len(b):
            self._set_up(H)

    def _set_up(self, H: Array) -> None:
        """Prepare a new workspace for the matrix H."""
        self._H = H
        self._model: Any = daqp.Model()
        self._model.settings = self._options
        f, A, _, b = self._program
        self._model.setup(H, f, A, self._above, b, self._cold)

    def answer(self, H: Array) -> Answer:
        """Solve the program as it stands: from the answer before, if there is one, then cold.

        A workspace that has had no finite answer may have none for ever: it is set up again.
        """
        if not len(self._cold):
            x = np.asarray(np.linalg.solve(H, -self._program[0]), dtype=np.float64)
            return Answer(x, np.zeros(0), 1, 0, 0.0)
        if self._warm:
            answer = self._solved(H, warm=True)
            if answer.flag == 1 and all_finite(answer.x):
                return answer
        answer = self._solved(H, warm=False)
        if not all_finite(answer.x):
            self._set_up(H)
            answer = self._solved(H, warm=False)
        self._warm = answer.flag == 1
        return answer

    def cold(self, f: Array, b: Array, sizes: Array) -> tuple[Array, Array, Indices, Indices]:
        """Solve N programs with the H and A that it was set up for, each from no active set.

        `f` is the linear term, in natural units [-].

        Parameters
        ----------
        f : ndarray, shape (N, n) [-]
        b : ndarray, shape (m,)
            Times the size of a step [(N m s)^0.5].
        sizes : ndarray, shape (N,)
            Of each [(N m s)^0.5].

        Returns
        -------
        x, lam, flag, iterations : ndarray, shapes (N, n), (N, m), (N,) and (N,)
        """
        N = len(f)
        x = np.zeros(f.shape)
        lam = np.zeros((N, len(b)))
        flags = np.ones(N, np.int64)
        iterations = np.zeros(N, np.int64)
        if not len(b):
            x[:] = np.linalg.solve(self._H, -f[..., None])[..., 0]  # one right side a call
            return x, lam, flags, iterations
        f_now, _, _, b_now = self._program
        update, solve = self._model.update, self._model.solve
        last = None
        for i, size in enumerate(sizes.tolist()):
            f_now[:] = f[i]
            if size != last:
                np.divide(b, size, out=b_now)
                last = size
            update(f=f_now, blower=b_now, sense=self._cold)
            x[i], _, flags[i], info = solve()
            lam[i] = info["lam"]
            iterations[i] = info["iterations"]
        return x, 0.0 - lam, flags, iterations

    def _solved(self, H: Array, *, warm: bool) -> Answer:
        changed = None if warm and H is self._H else H  # DAQP keeps its factor, with the same bits
        self._model.update(changed, *self._program, sense=None if warm else self._cold)
        self._H = H
        x, _, flag, info = self._model.solve()
        return Answer(x, info["lam"], flag, info["iterations"], info["solve_time"])


class Workspaces:
    """The workspaces of all groups of a layout.

    Parameters
    ----------
    programs : GroupPrograms
        Of a step. DAQP reads A and b where they are: those of the next step are written there.
    options : dict
        DAQP's own.

    Attributes
    ----------
    each : list of Workspace
    """

    def __init__(self, programs: GroupPrograms, options: Options) -> None:
        self.layout: GroupIndex = programs.layout
        self._f = -programs.g
        self._of_coordinate = np.argsort(self.layout.coordinates)
        self._of_row = np.argsort(self.layout.rows)
        forms = programs._replace(g=self._f).forms
        self.each = [Workspace(form.H, form.g, form.A, form.b, options) for form in forms]

    def reply(self, programs: GroupPrograms) -> Reply:
        """Solve what has been written where it reads: solved if the programs of all groups are."""
        np.negative(programs.g, out=self._f)
        answers = [one.answer(H) for one, H in zip(self.each, programs.blocks, strict=True)]
        each_x, each_lam, flags, iterations, seconds = zip(*answers, strict=True)
        flag = next((flag for flag in flags if flag != 1), 1)
        x = np.concatenate(each_x).take(self._of_coordinate)
        lam = (0.0 - np.concatenate(each_lam)).take(self._of_row)
        status = STATUS.get(flag) or str(flag)
        return Reply(x, lam, flag == 1, status, sum(iterations), sum(seconds))


def cold_replies(natural: NaturalStep, g: Array, sizes: Array, options: Options) -> ManyReplies:
    """Answers to N programs that differ from a step's in g alone, each from a cold start.

    So that none depends on the order in which they are asked for.

    Parameters
    ----------
    natural : NaturalStep
    g : ndarray, shape (N, n_v)
        [N s, N m s]
    sizes : ndarray, shape (N,)
        Their natural sizes [(N m s)^0.5].
    options : dict
        DAQP's own.
    """
    programs = natural.programs
    workspaces = Workspaces(programs, options)
    N = len(g)
    x = np.zeros((N, len(programs.g)))
    lam = np.zeros((N, len(programs.b)))
    worst = np.ones(N, np.int64)
    iterations = np.zeros(N, np.int64)
    f = -(g * natural.units.coordinate / sizes[:, None])
    b = programs.b * natural.units.size
    both = zip(workspaces.each, programs.layout.groups, programs.layout.slices, strict=True)
    for one, group, (_, _, m) in both:
        of_group = one.cold(f[:, group.coordinates], b[m], sizes)
        x[:, group.coordinates], lam[:, group.rows], flags, count = of_group
        worst = np.where(worst == 1, flags, worst)
        iterations += count
    status = [STATUS.get(flag) or str(flag) for flag in worst.tolist()]
    return ManyReplies(x, lam, status, iterations)


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
    gives_basic_rows = True
    fixed = ("n_a", "n_u", "cone", "contacts.rows", "extra")

    def __init__(self, template: StepData, name: str = DAQP) -> None:
        super().__init__(template, name)
        self._kept: dict[int, Workspaces] = {}
        self._programs: GroupPrograms | None = None

    def write(self, natural: NaturalStep) -> None:
        """Write the programs of the step's groups; StepDataError if a number is not finite."""
        layout = natural.layout
        programs = self._programs
        if programs is None or programs.layout is not layout:
            programs = layout.empty_programs(layout.natural_hessian_of(natural.step))
            self._kept.clear()
        self._programs = natural.write(programs)

    def reply_with(self, options: Options, natural: NaturalStep) -> Reply:
        """One attempt, in the kept workspaces if there are any."""
        assert self._programs is not None
        kept = self._kept.pop(id(options), None)  # what has raised is set up again
        if kept is None:
            kept = Workspaces(self._programs, options)
        reply = kept.reply(self._programs)
        self._kept[id(options)] = kept
        return reply

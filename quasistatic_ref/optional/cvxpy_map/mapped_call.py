"""Calls of a backend by the compiled map of a step's problem, and of CVXPY where that fails."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.formats.plain import bits
from quasistatic_ref.solve.backends import DEFAULT, Options
from quasistatic_ref.solve.problem_data import is_large, problem_data
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.step_problem import StepProblem
from quasistatic_ref.solve.through_cvxpy import cvxpy_reply
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from quasistatic_ref.optional.cvxpy_map.compiled import ClarabelCall, CompiledMap


class MappedCall:
    """What calls a backend with the data of a problem by its compiled map.

    Parameters
    ----------
    page : StepProblem
    name : str
        Of the backend.
    compiled : CompiledMap
        Of its problem.
    direct : ClarabelCall or None
        In place of CVXPY's own call.
    """

    def __init__(
        self, page: StepProblem, name: str, compiled: CompiledMap, direct: ClarabelCall | None
    ) -> None:
        self.page = page
        self.name = name
        self.compiled = compiled
        self.direct = direct
        self._compared = False

    def reply(self, options: Options) -> Reply:
        """What the backend says to the problem as its parameters stand, from a cold start."""
        direct = None
        if self.direct is not None:
            try:
                direct = self.direct.reply(options)
            except Exception:  # CVXPY's own call says what is wrong, if anything is
                self.direct = None
        if direct is not None and self._compared:
            return direct
        data = self.compiled.data(options)
        reply = cvxpy_reply(self.page, self.name, options, False, data)
        if direct is not None:  # the first one: each bit has to be CVXPY's
            self._compared = bits((direct.x, direct.lam)) == bits((reply.x, reply.lam))
            if not self._compared:
                self.direct = None
        return reply


def mapped_call(page: StepProblem, name: str) -> MappedCall | None:
    """The call of a backend for a problem that is filled.

    None where its map does not serve, or where CVXPY has moved what is private to it.
    """
    if is_large(page.problem):
        return None
    template = problem_data(page.problem, name, {})
    try:
        from quasistatic_ref.optional.cvxpy_map.compiled import ClarabelCall, CompiledMap

        if not CompiledMap.serves(template):
            return None
        compiled = CompiledMap(page.problem, template)
        called = name == DEFAULT and cone(page.template.cone).polyhedral
        return MappedCall(page, name, compiled, ClarabelCall(page, compiled) if called else None)
    except Exception:
        return None

"""The ellipsoid natively: one second-order cone a contact, gap >= ||(slip_1, slip_2, spin)||."""

import numpy as np

from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solver import OptionSet
from quasistatic_ref.solve.units import StepInBothUnits
from quasistatic_ref.step.data import Array, Mask, StepData


def coefficients(step: StepData) -> Array:
    """What each row of A is multiplied by in its cone, shape (m,): 1, mu_v, mu_v, mu_omega [-, m].

    A row of the user's own stays as it is.
    """
    mu = np.insert(step.contacts.mu, 0, 1.0, axis=1)
    return np.append(mu, np.ones(len(step.extra.names)))


class ConeSolver(NativeSolver):
    """The arrays of steps in the ellipsoid, and a backend that takes second-order cones.

    Parameters
    ----------
    template : StepData
        In the ellipsoid.
    name : str
        Of a backend with an adapter that takes cones.
    """

    def empty(self) -> Program:
        """A program whose first rows are cones, four of each contact."""
        program = super().empty()
        assert isinstance(program, Program)
        return Program(program.H, program.f, program.A, program.b, self.template.contacts.n_c)

    def write(self, both: StepInBothUnits) -> Mask | None:
        """Write the program in natural units; a contact out of reach bears no impulse at all."""
        out_of_reach = super().write(both)
        self.mu = coefficients(both.si_step)
        assert isinstance(self.program, Program)
        self.program.A[:] *= self.mu[:, None]
        if out_of_reach is not None:
            contacts = out_of_reach[: 4 * both.si_step.contacts.n_c].reshape(-1, 4)
            contacts[:] = contacts[:, :1]
        return out_of_reach

    def reply(self, option_set: OptionSet, both: StepInBothUnits) -> Reply:
        """One attempt, its multipliers those of the unscaled rows: impulses (n, d1, d2, spin)."""
        reply = super().reply(option_set, both)
        if reply.lam is not None:
            reply.lam = self.mu * reply.lam
        return reply

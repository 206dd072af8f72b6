"""A step handed to a backend's own interface, without CVXPY.

What CVXPY would make of a step is its standard form (a test holds them equal); the matrices are
written into arrays that are kept, in natural units, and the backend is updated in place. Where it
can, it starts from its answer to the step before.
"""

from dataclasses import dataclass
from importlib import import_module

import numpy as np

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program, SparseProgram
from quasistatic_ref.solve.backends import BACKENDS, installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solver import BackendSolver, OptionSet
from quasistatic_ref.solve.units import (
    DenseStepInBothUnits,
    HessianInBothUnits,
    StepInBothUnits,
    Units,
    reach,
)
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.tolerances import FAR


def native_backends(cone_name: str) -> tuple[str, ...]:
    """Backends with an interface of their own here for steps in a cone of that name."""
    rows = cone(cone_name).polyhedral
    return tuple(name for name in installed("native") if rows or BACKENDS[name].cones)


class NativeSolver(BackendSolver):
    """The arrays of steps of one kind, and a backend that is updated from them in place.

    Parameters
    ----------
    template : StepData
        A step of that kind.
    name : str
        Of one of the :func:`native_backends`.
    """

    interface = "native"
    remembers = True
    fixed = ("n_a", "n_u", "cone", "contacts.rows", "extra")

    def __init__(self, template: StepData, name: str) -> None:
        super().__init__(template, name)
        # Needs its package.
        module = import_module(f"quasistatic_ref.optional.fast.adapters.{name}")
        self.adapter: type[Adapter] = getattr(module, BACKENDS[name].adapter)
        self.sizes = sizes(template)
        self.hessian: HessianInBothUnits | None = None
        self.program: Program | SparseProgram = self.empty()

    def empty(self) -> Program | SparseProgram:
        """A program of the right size."""
        template = self.template
        order = self.adapter.ORDER
        n = template.n_v
        m = template.m
        return Program(
            np.zeros((n, n), order=order), np.zeros(n), np.zeros((m, n), order=order), np.zeros(m)
        )

    def fits(self, step: StepData) -> bool:
        """Whether a step can be written into the same arrays."""
        # Steps of one run share their layout of rows: an identity test, which takes no time.
        alike = step.row_layout is self.template.row_layout and sizes(step) == self.sizes
        return alike or super().fits(step)

    def write(self, both: StepInBothUnits) -> Mask | None:
        """Write the program in natural units; tell which rows, (m,), are out of reach."""
        self.write_program(both)
        program = self.program
        if not self.adapter.NEAR or program.b.min(initial=0.0) >= -FAR:
            return None
        least = -reach_of_rows(both.si_step, both.units)
        np.maximum(program.b, least, out=program.b)
        return np.asarray(program.b == least)

    def write_program(self, both: StepInBothUnits) -> None:
        """Write the program in natural units as it is; H only where it is another array."""
        assert isinstance(both, DenseStepInBothUnits)
        form = both.si_form
        program = self.program
        S = both.units.coordinate
        ell = both.units.length
        rho = both.units.size
        if self.hessian is None or self.hessian.H is not both.hessian.H:
            program.H[:] = both.hessian.natural_H
            self.hessian = both.hessian
        np.multiply(form.g, S / -rho, out=program.f)
        np.multiply(form.A, S / ell, out=program.A)
        np.multiply(form.b, 1 / (rho * ell), out=program.b)

    def reply(self, option_set: OptionSet, both: StepInBothUnits) -> Reply:
        """One attempt: from the answer before, if there is one; cold if not, or if that fails."""
        program = self.program
        if isinstance(program, Program) and not program.b.size:
            return program.unconstrained()
        held = option_set.kept
        option_set.kept = None  # an adapter that raises is set up again
        if not isinstance(held, _SetUpAdapter):
            held = _SetUpAdapter(self.adapter(program, option_set.options), self.hessian)
        warm = self.adapter.WARM and held.warm
        reply = held.adapter.reply(held.hessian is self.hessian, warm)
        if warm and not reply.solved:
            reply = held.adapter.reply(False, False)
        held.hessian = self.hessian
        held.warm = reply.solved
        option_set.kept = held
        return reply


def reach_of_rows(step: StepData, units: Units) -> Array:
    """How far each row may be in natural units before it is out of reach, shape (m,)."""
    of_contacts = reach(step.contacts.J * (units.coordinate / units.length))
    own = reach((step.extra.A * (units.coordinate / units.length))[:, None])
    return np.concatenate([np.repeat(of_contacts, step.counts), own])


def sizes(step: StepData) -> tuple[int, int, int]:
    """n_a, n_u and the number of rows of the user's own."""
    return step.tau_a.size, step.tau_u.size, len(step.extra.names)


@dataclass(eq=False)
class _SetUpAdapter:
    """An adapter, the H that it has, and whether it can start from its answer."""

    adapter: Adapter
    hessian: HessianInBothUnits | None
    warm: bool = False

"""A step's program in natural units, written into the arrays of its solver."""

import numpy as np

from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.scene import Scene
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.solve.units import HessianInBothUnits, Units
from quasistatic_ref.step.data import StepData

MOST = 1024
"""Most coordinates for which ``OFF`` in natural.c is enough."""


class NaturalProgram:
    """The arrays of one solver, for steps of one H.

    Parameters
    ----------
    scene : Scene
        Holds the steps' g, A and b.
    solver : FastSolver
    program : Program
        That of the solver.
    hessian : HessianInBothUnits
        Of H.

    Attributes
    ----------
    units : ndarray, shape (2,)
        {length, size}, as of :class:`~quasistatic_ref.solve.units.Units`, which C writes.
    address : int
        Of ``Natural`` of natural.c.
    """

    def __init__(
        self, scene: Scene, solver: FastSolver, program: Program, hessian: HessianInBothUnits
    ) -> None:
        self._write = library().natural_program
        self._solver = solver
        self.hessian = hessian
        self._structure = s = Structure("natural.c", "Natural")
        m, n = program.A.shape
        row, column = (stride // program.A.itemsize for stride in program.A.strides)
        s.put(
            {
                "n": n, "m": m, "row": row, "column": column,
                **{name: scene[name] for name in ("g", "A", "b")},
                "coordinate": hessian.coordinate, "squared": hessian.squared,
                "inverse": hessian.H_inverse,
                "squares": np.zeros(m), "scale": np.zeros(n), "units": np.zeros(2),
                "f": program.f, "natural_b": program.b,
                # In either order of memory; `row` and `column` say in which:
                "natural_A": program.A.ravel(order="K"),
            }
        )  # fmt: skip
        self.units = s["units"]
        self.address = s.address
        same = [np.shares_memory(s[f"natural_{k}"], getattr(program, k)) for k in ("A", "b")]
        assert all(same) or not m  # without rows there is no memory

    def fits(self, solver: FastSolver, step: StepData) -> bool:
        """Whether a step can be written into a solver's arrays: both have the H of this program."""
        own = self._solver
        hessian = self.hessian
        return solver is own and own.hessian is hessian and hessian.H is step.H

    def written(self) -> Units | None:
        """Write the program of the step that the scene holds, and return its natural units.

        Returns
        -------
        Units or None
            None where the rounding of a sum, which depends on its order, decides on a unit.
        """
        if not self._write(self._structure.address):
            return None
        units = Units(self.hessian.coordinate, *self.units.tolist())
        self._solver.written = units
        return units


def natural_program(scene: Scene, solver: FastSolver, step: StepData) -> NaturalProgram | None:
    """What writes the steps of a scene that are like one into the arrays of a solver, or None."""
    program = solver.program
    hessian = solver.hessian
    if not isinstance(program, Program) or hessian is None or step.n_v > MOST:
        return None
    return NaturalProgram(scene, solver, program, hessian) if hessian.H is step.H else None

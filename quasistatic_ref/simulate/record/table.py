"""The arrays of a record of a run: one table, which reads them of results."""

from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.numbers.arrays import Indices
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.simulate.record.block import Block
from quasistatic_ref.simulate.record.header import Header
from quasistatic_ref.simulate.result import StepArrays
from quasistatic_ref.step.cones import cone

EVERY: Final = "every"
FULL: Final = "full"
FORCES: Final = "forces"
OWN_ROWS: Final = "own rows"
OWN_ROWS_IN_FULL: Final = "own rows, full"
OWN_COST: Final = "own cost, full"


class Recorded(NamedTuple):
    """One array that a trajectory may hold: its name, its shape and how it is read.

    Parameters
    ----------
    shape : str
        In letters: T steps, T+1 configurations, n_c contacts, m and M multipliers and rows, e own
        rows, n_q, n_v and n_a as in the notation, N and N_u coordinates of the program.
    says : str
        What it is, with its unit.
    of : str
        Which records have it.
    read : str
        Where a :class:`Block` has it, or each of its results; empty of what the recorder itself
        knows.
    dtype : type
    nan : bool
        Whether NaN stands for what is not known.
    """

    shape: str
    says: str
    of: str = EVERY
    read: str = ""
    dtype: type = np.float64
    nan: bool = False


ARRAYS: Final[dict[str, Recorded]] = {
    "q": Recorded("T+1 n_q", "configuration, from the start on [m, rad, -]"),
    "t": Recorded("T", "end of the step [s]"),
    "delta_q": Recorded("T n_v", "displacement [m, rad]", read="delta_q"),
    "q_bar_a": Recorded("T n_q_a", "target of the actuated coordinates [m, rad, -]"),
    "phi": Recorded("T n_c", "signed distance before the step [m]", read="points.phi"),
    "alpha": Recorded("T n_c 3", "closest point on alpha's body [m]", read="points.alpha"),
    "beta": Recorded("T n_c 3", "closest point on beta's body [m]", read="points.beta"),
    "n": Recorded("T n_c 3", "normal from alpha's body to beta's [-]", read="points.n"),
    "d1": Recorded("T n_c 3", "first tangent [-]", read="step.contacts.d1"),
    "d2": Recorded("T n_c 3", "second tangent [-]", read="step.contacts.d2"),
    "point": Recorded("T n_c", "number of the cloud's point", read="points.point", dtype=np.int64),
    "lam": Recorded("T m", "multipliers of the contacts [N s]", read="lam"),
    "wrench": Recorded("T n_c 4", "f_d1, f_d2, f_n, tau_n of lam [N, N m]", read="wrench"),
    "certificate": Recorded("T", "its kind", read="solution.certificate.kind", dtype=np.str_),
    "worst_residual": Recorded("T", "in natural units [-]", read="worst_residual", nan=True),
    "digits": Recorded("T", "correct digits of the backend", read="solution.statistics.digits",
                   nan=True),
    "H": Recorded("T N N", "of the quadratic program", FULL, "step.H"),
    "g": Recorded("T N", "of the quadratic program", FULL, "g"),
    "A": Recorded("T M N", "of the quadratic program", FULL, "A"),
    "b": Recorded("T M", "of the quadratic program", FULL, "b"),
    "J": Recorded("T n_c 4 N", "contact Jacobian [m, m, m, rad]", FULL, "J"),
    "K_q": Recorded("T n_a n_a", "stiffness [N/m, N m/rad]", FULL, "step.K_q"),
    "M_u": Recorded("T N_u N_u", "un-actuated block of M [kg, kg m, kg m^2]", FULL, "step.M_u"),
    "tau_a": Recorded("T n_a", "force on the actuated coordinates [N, N m]", FULL, "step.tau_a"),
    "tau_u": Recorded("T N_u", "force on the others [N, N m]", FULL, "step.tau_u"),
    "delta_q_bar_a": Recorded("T n_a", "target (-) q_a [m, rad]", FULL, "step.delta_q_bar_a"),
    "forces": Recorded("T n_c 4", "forces of single contacts [N, N m]", FORCES, "forces", nan=True),
    "imbalance": Recorded("T", "share of load that they leave [-]", FORCES, "imbalance", nan=True),
    "motion": Recorded("T n_c 4", "J delta_q [m, m, m, rad]", FORCES, "motion"),
    "lam_extra": Recorded("T e", "multipliers of own rows [N s]", OWN_ROWS, "solution.lam_extra"),
    "extra_A": Recorded("T e N", "own rows", OWN_ROWS_IN_FULL, "step.extra.A"),
    "extra_b": Recorded("T e", "own rows", OWN_ROWS_IN_FULL, "step.extra.b"),
    "extra_H": Recorded("T N N", "own quadratic cost", OWN_COST, "step.extra.H"),
    "extra_g": Recorded("T N", "own quadratic cost", OWN_COST, "step.extra.g"),
    "s": Recorded("T n_c", "by how much phi was raised [m]", COULOMB, "solution.s"),
    "s_residual": Recorded("T", "what of s is not its own [m]", COULOMB, "solution.s_residual"),
    "s_iterations": Recorded("T", "convex steps solved", COULOMB, "solution.s_iterations",
                         dtype=np.int64),
    "mu_v": Recorded("n_c", "tangential friction [-]"),
    "mu_omega": Recorded("n_c", "torsional friction [m]"),
    "rows": Recorded("n_c", "6, or 4 without torsion", dtype=np.int64),
}  # fmt: skip
"""All arrays, in the order of files."""


def names_of(record: str, law: str, own_rows: bool, own_cost: bool) -> list[str]:
    """Names of the arrays that a record of this kind has."""
    kinds = {EVERY, record, law}
    if own_rows:
        kinds |= {OWN_ROWS, f"{OWN_ROWS}, {record}"}
    if own_cost:
        kinds |= {f"own cost, {record}"}
    return [name for name, kept in ARRAYS.items() if kept.of in kinds]


def arrays_of(block: Block, names: Sequence[str]) -> StepArrays:
    """Arrays over consecutive steps, of the names that the steps' results hold."""
    arrays = StepArrays()
    for name in names:
        kept = ARRAYS[name]
        if kept.read:
            of_results = "." in kept.read
            array = block.of_each(kept.read) if of_results else getattr(block, kept.read)
            arrays[name] = array.astype(np.float64) if kept.nan else array
    return arrays


def no_steps(header: Header, rows: Indices, n_q_a: int = 0) -> dict[str, NDArray[Any]]:
    """All arrays of a run without steps, each of its shape in the table with steps = 0.

    Parameters
    ----------
    header : Header
    rows : ndarray of int, shape (n_c,)
        Of the contacts.
    n_q_a : int
        Length of a target.
    """
    m = int(cone(header.cone).counts(rows).sum())
    lengths = lengths_of(header) | {"n_q_a": n_q_a, "m": m, "M": m}
    lengths |= {"N": header.n_a + header.n_u, "N_u": header.n_u}
    names = names_of(header.record, header.law, False, False)
    shapes = {name: shape_of(ARRAYS[name].shape, lengths) for name in names}
    return {name: np.zeros(shape, ARRAYS[name].dtype) for name, shape in shapes.items()}


def lengths_of(header: Header) -> dict[str, int]:
    """Lengths of the axes that the header knows, by the letters of the table of arrays."""
    return {
        "T": header.steps,
        "T+1": header.steps + 1,
        "n_v": header.n_a + header.n_u,
        "n_a": header.n_a,
        "n_c": len(header.slots),
        "n_q": len(header.positions),
        "e": len(header.extra),
    }


def shape_of(letters: str, lengths: Mapping[str, int]) -> tuple[int, ...]:
    """The shape of an array by its letters; -1 where a letter's length is not known."""
    return tuple(int(x) if x.isdecimal() else lengths.get(x, -1) for x in letters.split())

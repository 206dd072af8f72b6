"""Limits and equalities of a MuJoCo state as rows of a step, and joints that are one coordinate."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.fates import kind_of
from quasistatic_ref.optional.guests.still import Still
from quasistatic_ref.solve.units import coordinate_units
from quasistatic_ref.step.arrays import Array, Indices
from quasistatic_ref.step.data import Extra
from quasistatic_ref.tolerances import FULL_RANK


class Tied(NamedTuple):
    """Joints of which equalities make fewer coordinates.

    Parameters
    ----------
    dofs : ndarray of int, shape (n,)
        The joints that remain, by their places among MuJoCo's velocities.
    T : ndarray, shape (nv, n)
        MuJoCo's displacement, per unit of the coordinates that remain [-].
    eliminated : tuple of int
        Numbers of the constraints of MuJoCo that T satisfies.
    """

    dofs: Indices
    T: Array
    eliminated: tuple[int, ...]


def tied_joints(state: Still, kinds: Collection[str], heavy: Array) -> Tied:
    """The joints that remain if equalities of some kinds each take one away.

    An equality of joints takes its first joint. Others take the lightest coordinate that they move:
    the one with the largest entry in natural units.

    Parameters
    ----------
    state : Still
    kinds : collection of str
        Such as ``("JOINT",)``.
    heavy : ndarray, shape (nv,)
        Diagonal of H of all joints, for natural units [N s/m, N m s/rad].

    Raises
    ------
    ModelError
        Naming an equality that holds what others hold already.
    """
    model = state.model
    units = coordinate_units(heavy)
    T = np.eye(model.nv)
    gone: list[int] = []
    eliminated: list[int] = []
    J, rows = state.rows("EQUALITY")
    for gradient, row in zip(J, rows.tolist(), strict=True):
        number = int(state.data.efc_id[row])
        kind = kind_of(state, "eq_type", number)
        if kind not in kinds:
            continue
        along = gradient @ T  # zero times the displacement of those that remain
        dof = int(np.abs(along * units).argmax())
        if kind == "JOINT":
            dof = int(model.jnt_dofadr[model.eq_obj1id[number]])
        if abs(along[dof]) * units[dof] <= FULL_RANK * np.abs(gradient * units).max():
            problem = "holds what other equalities hold already; leave one of them out"
            raise ModelError(problem, field=state.words("equality", number))
        T -= np.outer(T[:, dof], along / along[dof])
        T[:, dof] = 0.0
        gone.append(dof)
        eliminated.append(row)
    dofs = np.setdiff1d(np.arange(model.nv), gone)
    return Tied(dofs, T[:, dofs], tuple(eliminated))


def limits(state: Still, T: Array, as_is: bool) -> Extra:
    """All limits of joints and tendons: T' of the gradient of a gap, times delta_q, >= -gap.

    Gaps below zero count as zero unless `as_is`. T has the shape (nv, n) [-].
    """
    found = []
    for kind, margins in (("JOINT", state.model.jnt_margin), ("TENDON", state.model.tendon_margin)):
        J, rows = state.rows(f"LIMIT_{kind}")
        of = state.data.efc_id[rows]
        gaps = state.data.efc_pos[rows] - margins[of]
        names = [f"limit of {state.words(kind.lower(), i)}" for i in of]
        found.append((names, J @ T, -(gaps if as_is else np.maximum(gaps, 0.0))))
    return _rows(found, T.shape[1])


def equalities(state: Still, tied: Tied, diagonal: Array, as_is: bool) -> Extra:
    """The equalities that T does not satisfy, each as two rows.

    Parameters
    ----------
    state : Still
    tied : Tied
    diagonal : ndarray, shape (n,)
        Of H of the coordinates that remain, for natural units [N s/m, N m s/rad].
    as_is : bool
        Whether their residuals are closed in the step.

    Raises
    ------
    ModelError
        Naming equalities that depend on each other: their rows have not full rank.
    """
    J, rows = state.rows("EQUALITY")
    rest = ~np.isin(rows, tied.eliminated)
    A = J[rest] @ tied.T
    b = -state.data.efc_pos[rows[rest]] * as_is
    names = [state.words("equality", i) for i in state.data.efc_id[rows[rest]]]
    natural = A * coordinate_units(diagonal)
    lengths = np.linalg.norm(natural, axis=1, keepdims=True)
    left, values, _ = np.linalg.svd(natural / np.where(lengths > 0, lengths, 1.0))
    rank = np.count_nonzero(values >= FULL_RANK)
    if rank < len(names):
        tied_by = [names[k] for k in np.flatnonzero(np.abs(left[:, rank:]).max(axis=1) > 0.1)]
        problem = (
            f"its rows and those of other equalities have rank {rank}, and not {len(names)}; leave "
            "out what is held already, or say it as an equality of joints"
        )
        raise ModelError(problem, field=", ".join(dict.fromkeys(tied_by)))
    return _rows([(names, A, b), (names, -A, -b)], A.shape[1])


def together(*parts: Extra) -> Extra:
    """The rows of all parts, in their order, with a number in each name."""
    names = tuple(name for part in parts for name in part.names)
    A = np.concatenate([part.A for part in parts])
    b = np.concatenate([part.b for part in parts])
    return Extra(tuple(f"{name} ({k})" for k, name in enumerate(names)), A, b)


def _rows(parts: Sequence[tuple[list[str], Array, Array]], n: int) -> Extra:
    names = [name for part in parts for name in part[0]]
    A = np.concatenate([part[1] for part in parts])
    return Extra(tuple(names), A.reshape(-1, n), np.concatenate([part[2] for part in parts]))

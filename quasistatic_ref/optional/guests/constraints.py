"""Limits and equalities of a MuJoCo state as rows of a step, and joints that are one coordinate."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.fates import kind_of
from quasistatic_ref.optional.guests.mujoco_state import MujocoState, Natural
from quasistatic_ref.solve.units import coordinate_units
from quasistatic_ref.step.arrays import Array, Indices, Mask
from quasistatic_ref.step.data import Extra
from quasistatic_ref.tolerances import FULL_RANK

HELD = "left out, in part or whole: joints or other equalities hold already what it holds"


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


class Held(NamedTuple):
    """The equalities of a step, and what of them it leaves out.

    Parameters
    ----------
    rows : Extra
        Two of each.
    basis : ndarray, shape (r, n)
        Orthonormal rows that span theirs, in natural units [-].
    left_out : tuple of str
    """

    rows: Extra
    basis: Array
    left_out: tuple[str, ...]


def tied_joints(state: MujocoState, kinds: Collection[str], heavy: Array) -> Tied:
    """The joints that remain if equalities of some kinds each take one away.

    An equality of joints takes its first joint. Others take the lightest coordinate that they move:
    the one with the largest entry in natural units.

    Parameters
    ----------
    state : MujocoState
    kinds : collection of str
        Such as ``("JOINT",)``.
    heavy : ndarray, shape (nv,)
        Diagonal of H of all joints, for natural units [N s/m, N m s/rad].

    Raises
    ------
    ModelError
        If none remains.
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
        scale = Natural(state, T, units)
        (along,) = scale.rows(gradient[None])  # zero times the displacement of those that remain
        least = FULL_RANK * scale.sizes(gradient[None])[0]
        if np.abs(along).max() <= least:
            continue  # held already
        dof = int(np.abs(along).argmax())
        if kind == "JOINT":
            first = int(model.jnt_dofadr[model.eq_obj1id[number]])
            dof = first if abs(along[first]) > least else dof
        T = T - np.outer(T[:, dof], along / along[dof] / units * units[dof])
        T[:, dof] = 0.0
        gone.append(dof)
        eliminated.append(row)
    dofs = np.setdiff1d(np.arange(model.nv), gone)
    if not len(dofs):
        last = state.words("equality", int(state.data.efc_id[eliminated[-1]]))
        raise ModelError("leaves no joint that can move; leave it out", field=last)
    return Tied(dofs, T[:, dofs], tuple(eliminated))


def limits(
    state: MujocoState, scale: Natural, basis: Array, as_is: bool, in_place: bool = False
) -> tuple[Extra, tuple[str, ...]]:
    """All limits of joints and tendons: T' of the gradient of a gap, times delta_q, >= -gap.

    Gaps below zero count as zero unless `as_is`. `basis` is that of the equalities, (r, n) [-]. The
    second result says which limits are left out, since nothing moves what they limit; `in_place`
    has rows in their places that hold nothing, so that their number is the same at every q.
    """
    parts = []
    left_out: list[str] = []
    model = state.model
    for kind, margins, limited in (
        ("JOINT", model.jnt_margin, model.jnt_limited),
        ("TENDON", model.tendon_margin, model.tendon_limited),
    ):
        J, rows = state.rows(f"LIMIT_{kind}")
        of = state.data.efc_id[rows]
        gaps = state.data.efc_pos[rows] - margins[of]
        names = [f"limit of {state.words(kind.lower(), i)}" for i in of]
        empty = scale.empty(J, basis)
        held = {*of[empty]}
        if not (state.disables("LIMIT") or state.disables("CONSTRAINT")):
            held |= {*np.flatnonzero(limited)} - {*of}  # MuJoCo has no row if all of it is zero
        left_out += [f"limit of {state.words(kind.lower(), i)}: {HELD}" for i in sorted(held)]
        b = -(gaps if as_is else np.maximum(gaps, 0.0))
        parts.append(_of_places(names, J @ scale.T, b, ~empty, in_place))
    return _rows(parts, scale.T.shape[1]), tuple(left_out)


def equalities(
    state: MujocoState, tied: Tied, scale: Natural, as_is: bool, in_place: bool = False
) -> Held:
    """The equalities that T does not satisfy, each as two rows.

    Parameters
    ----------
    state : MujocoState
    tied : Tied
    scale : Natural
        Of the coordinates that remain.
    as_is : bool
        Whether their residuals are closed in the step.
    in_place : bool
        As of :func:`limits`.

    Raises
    ------
    ModelError
        With `as_is`, naming an equality whose residual no step closes together with the others'.

    Notes
    -----
    A row is left out if no more than FULL_RANK of it is independent of those before it: it is then
    off by rounding from what they hold, and would hold a direction of its own.
    """
    J, rows = state.rows("EQUALITY")
    A = J @ tied.T
    natural = scale.rows(J)
    least = FULL_RANK * scale.sizes(J)
    basis = np.zeros((0, len(scale.units)))
    kept: list[int] = []
    left_out = []
    residuals = state.data.efc_pos[rows] * as_is
    for k in np.flatnonzero(~np.isin(rows, tied.eliminated)).tolist():
        rest = natural[k]
        for _ in range(2):  # the second takes away what rounding left in the first
            rest = rest - rest @ basis.T @ basis
        length = np.linalg.norm(rest)
        if length > least[k]:
            basis = np.vstack([basis, rest / length])
            kept.append(k)
            continue
        name = state.words("equality", state.data.efc_id[rows[k]])
        of_others = np.linalg.lstsq(natural[kept].T, natural[k])[0]
        if abs(residuals[k] - of_others @ residuals[kept]) > FULL_RANK * state.reach.max():
            problem = 'contradicts other equalities, which depth = "closed" takes as they stand'
            raise ModelError(problem, field=name, value=float(residuals[k]))
        left_out.append(f"{name}: {HELD}")
    rest = np.flatnonzero(~np.isin(rows, tied.eliminated))
    names = [state.words("equality", i) for i in state.data.efc_id[rows[rest]]]
    kept_here = np.isin(rest, kept)
    both = _rows(
        [_of_places(names, side * A[rest], -side * residuals[rest], kept_here, in_place)
         for side in (1.0, -1.0)],
        A.shape[1],
    )  # fmt: skip
    return Held(both, basis, tuple(dict.fromkeys(left_out)))


def together(*parts: Extra) -> Extra:
    """The rows of all parts, in their order, with a number in each name."""
    names = tuple(name for part in parts for name in part.names)
    A = np.concatenate([part.A for part in parts])
    b = np.concatenate([part.b for part in parts])
    return Extra(tuple(f"{name} ({k})" for k, name in enumerate(names)), A, b)


def _of_places(
    names: list[str], A: Array, b: Array, kept: Mask, in_place: bool
) -> tuple[list[str], Array, Array]:
    """The rows that are kept; or all, those that are not as 0 >= -1."""
    if in_place:
        return names, np.where(kept[:, None], A, 0.0), np.where(kept, b, -1.0)
    return [name for name, holds in zip(names, kept, strict=True) if holds], A[kept], b[kept]


def _rows(parts: Sequence[tuple[list[str], Array, Array]], n: int) -> Extra:
    names = [name for part in parts for name in part[0]]
    A = np.concatenate([part[1] for part in parts])
    return Extra(tuple(names), A.reshape(-1, n), np.concatenate([part[2] for part in parts]))


def followers(state: MujocoState, tied: Tied) -> Sequence[tuple[int, int, tuple[float, float]]]:
    """Joints that follow others: their entries of qpos, the other's (-1: none), and a line.

    Raises
    ------
    ModelError
        Naming an equality of higher order, or one that takes another joint than its first.
    """
    model = state.model
    parts = []
    for row in tied.eliminated:
        i = int(state.data.efc_id[row])
        a, b, *higher = model.eq_data[i, :5].tolist()
        if any(higher):
            problem = "couples joints by more than a line; a run has a and b of polycoef"
            raise ModelError(problem, field=f"{state.words('equality', i)}.polycoef", value=higher)
        first, second = int(model.eq_obj1id[i]), int(model.eq_obj2id[i])
        of_second = int(model.jnt_qposadr[second]) if second >= 0 else -1
        parts.append((int(model.jnt_qposadr[first]), of_second, (a, b)))
    taken = {int(model.jnt_dofadr[model.eq_obj1id[state.data.efc_id[r]]]) for r in tied.eliminated}
    if taken & set(tied.dofs.tolist()):
        raise ModelError("of joints tie a joint twice; leave one out", field="equality")
    return parts

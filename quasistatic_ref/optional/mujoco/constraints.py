"""Limits and equalities of a MuJoCo state as rows of a step, and joints that are one coordinate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.mujoco.fates import kind_of
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState, Natural
from quasistatic_ref.optional.mujoco.tolerances import FULL_RANK
from quasistatic_ref.solve.by_group import coordinate_units
from quasistatic_ref.step.data import Extra

HELD = "left out, in part or whole: joints or other equalities hold already what it holds"


class Tied(NamedTuple):
    """The coordinates that remain where equalities tie joints to others.

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


class Row(NamedTuple):
    """A limit, or one side of an equality: A delta_q >= b.

    Parameters
    ----------
    name : str
    A : ndarray, shape (n_v,)
    b : float
    holds : bool
        Whether more than rounding is left of it next to what holds already.
    """

    name: str
    A: Array
    b: float
    holds: bool


class Held(NamedTuple):
    """The equality constraints that a step takes over from MuJoCo, and those that it leaves out.

    Parameters
    ----------
    rows : tuple of Row
        Two of each.
    basis : ndarray, shape (r, n)
        Orthonormal rows that span theirs, in natural units [-].
    left_out : tuple of str
    """

    rows: tuple[Row, ...]
    basis: Array
    left_out: tuple[str, ...]


CONNECT, WELD = 0, 1
"""MuJoCo's numbers of two kinds of equalities, the first three rows of which are lengths."""
OPEN = 1e-3
"""Length by which one may be violated before it is said [m]."""


def tied_joints(state: MujocoState, heavy: Array) -> Tied:
    """The joints that remain if equalities of joints each take one away.

    It is its first joint, or where that cannot move, the lightest coordinate that it moves: the one
    with the largest entry in natural units.

    Parameters
    ----------
    state : MujocoState
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
        if kind_of(state, "eq_type", number) != "JOINT":
            continue
        scale = Natural(state, T, units)
        (along,) = scale.rows(gradient[None])  # zero times the displacement of those that remain
        least = FULL_RANK * scale.sizes(gradient[None])[0]
        if np.abs(along).max() <= least:
            continue  # held already
        dof = int(model.jnt_dofadr[model.eq_obj1id[number]])
        if abs(along[dof]) <= least:
            dof = int(np.abs(along).argmax())
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
    state: MujocoState, scale: Natural, basis: Array, as_is: bool
) -> tuple[list[Row], list[str]]:
    """All limits of joints and tendons: T' of the gradient of a gap, times delta_q, >= -gap.

    Gaps below zero count as zero unless `as_is`. `basis` is that of the equalities, (r, n) [-]. The
    second result says which limits are left out, since nothing moves what they limit.
    """
    rows: list[Row] = []
    left_out: list[str] = []
    model = state.model
    for kind, margins, limited in (
        ("JOINT", model.jnt_margin, model.jnt_limited),
        ("TENDON", model.tendon_margin, model.tendon_limited),
    ):
        J, numbers = state.rows(f"LIMIT_{kind}")
        of = state.data.efc_id[numbers]
        gaps = state.data.efc_pos[numbers] - margins[of]
        empty = scale.empty(J, basis)
        held = {*of[empty]}
        if not (state.disables("LIMIT") or state.disables("CONSTRAINT")):
            held |= {*np.flatnonzero(limited)} - {*of}  # MuJoCo has no row if all of it is zero
        left_out += [f"limit of {state.words(kind.lower(), i)}: {HELD}" for i in sorted(held)]
        b = -(gaps if as_is else np.maximum(gaps, 0.0))
        names = [f"limit of {state.words(kind.lower(), i)}" for i in of]
        rows += map(Row, names, J @ scale.T, b.tolist(), (~empty).tolist())
    return rows, left_out


def equalities(state: MujocoState, tied: Tied, scale: Natural, as_is: bool) -> Held:
    """The equalities that T does not satisfy, each as two rows.

    Parameters
    ----------
    state : MujocoState
    tied : Tied
    scale : Natural
        Of the coordinates that remain.
    as_is : bool
        Whether their residuals are closed in the step.

    Raises
    ------
    ModelError
        With `as_is`, naming an equality whose residual no step closes together with the others'.

    Notes
    -----
    A row is left out if no more than FULL_RANK of it is independent of those before it: it is then
    off by rounding from what they hold, and would hold a direction of its own.
    """
    J, numbers = state.rows("EQUALITY")
    free = ~np.isin(numbers, tied.eliminated)
    A = (J @ tied.T)[free]
    natural = scale.rows(J)[free]
    least = FULL_RANK * scale.sizes(J)[free]
    residuals = state.data.efc_pos[numbers[free]] * as_is
    names = [state.words("equality", i) for i in state.data.efc_id[numbers[free]]]
    basis = np.zeros((0, len(scale.units)))
    kept: list[int] = []
    left_out = []
    for k, name in enumerate(names):
        rest = natural[k]
        for _ in range(2):  # the second takes away what rounding left in the first
            rest = rest - rest @ basis.T @ basis
        length = np.linalg.norm(rest)
        if length > least[k]:
            basis = np.vstack([basis, rest / length])
            kept.append(k)
            continue
        of_others = np.linalg.lstsq(natural[kept].T, natural[k])[0]
        if abs(residuals[k] - of_others @ residuals[kept]) > FULL_RANK * state.reach.max():
            problem = 'contradicts other equalities, which depth = "closed" closes; leave one out'
            raise ModelError(problem, field=name, value=float(residuals[k]))
        left_out.append(f"{name}: {HELD}")
    rows = tuple(
        Row(name, side * A[k], -side * residuals[k], k in kept)
        for side in (1.0, -1.0)
        for k, name in enumerate(names)
    )
    return Held(rows, basis, tuple(dict.fromkeys(left_out)))


def violated(state: MujocoState) -> tuple[str, ...]:
    """Sentences on connects and welds that a state leaves open: the first step closes them."""
    _, numbers = state.rows("EQUALITY")
    sentences = []
    for i in dict.fromkeys(state.data.efc_id[numbers].tolist()):
        if int(state.model.eq_type[i]) not in (CONNECT, WELD):
            continue
        offset = state.data.efc_pos[numbers[state.data.efc_id[numbers] == i][:3]]
        if (gap := float(np.linalg.norm(offset))) > OPEN:
            name = state.words("equality", i)
            sentences.append(
                f"{name} is violated by {1e3 * gap:.3g} mm at the start, and the first step closes "
                "it; without a relpose, a weld keeps the pose of the model's first state"
            )
    return tuple(sentences)


def extra_of(rows: Sequence[Row], n: int) -> Extra:
    """Limits and equalities as rows of n coordinates; an inactive one becomes 0 >= -1."""
    return Extra(
        names=tuple(f"{row.name} ({k})" for k, row in enumerate(rows)),
        A=np.array([row.A if row.holds else np.zeros(n) for row in rows]).reshape(-1, n),
        b=np.array([row.b if row.holds else -1.0 for row in rows]),
    )


def followers(state: MujocoState, tied: Tied) -> Sequence[tuple[int, int, tuple[float, float]]]:
    """Joints that follow others: their qpos entries, their leaders' (-1: none), and a line.

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

"""M_u and the force of gravity on a mechanism, in exact numbers."""

from collections.abc import Sequence

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.algebra import (
    Matrix,
    Vector,
    dot,
    moved,
    scaled,
    times,
    transposed,
)
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism, Poses
from quasistatic_ref.lab.vectors.exact.precision import number, numbers


def mass_matrix_u(mechanism: Mechanism, at: Poses) -> Matrix:
    """M_u, the un-actuated block of M = sum J' I J, rows of numbers [kg, kg m, kg m^2]."""
    n_a = mechanism.n_a
    size = mechanism.n_v - n_a
    M = [[fmpq(0)] * size for _ in range(size)]
    for k, body in enumerate(mechanism.bodies):
        if "mass" not in body.table:
            continue
        mass = number(body.table["mass"])
        moves = at.point_columns(k, moved(at.R[k], at.t[k], numbers(body.table["com"])))
        own = {v - n_a: move for v, move in moves.items() if v >= n_a}
        R, inertia = at.R[k], [numbers(row) for row in body.table["inertia"]]
        for i, (nu, w) in own.items():
            momentum = scaled(nu, mass), times(R, times(inertia, times(transposed(R), w)))
            for j, (nu_j, w_j) in own.items():
                M[j][i] += dot(nu_j, momentum[0])
                M[j][i] += dot(w_j, momentum[1])
    return M


def gravity_force(mechanism: Mechanism, at: Poses, gravity: Sequence[float]) -> Vector:
    """Generalised force of gravity on all coordinates, length n_v [N, N m]."""
    acceleration = numbers(gravity)
    force = [fmpq(0)] * mechanism.n_v
    for k, body in enumerate(mechanism.bodies):
        if "mass" not in body.table:
            continue
        weight = scaled(acceleration, number(body.table["mass"]))
        centre = moved(at.R[k], at.t[k], numbers(body.table["com"]))
        for v, (nu, _) in at.point_columns(k, centre).items():
            force[v] += dot(nu, weight)
    return force

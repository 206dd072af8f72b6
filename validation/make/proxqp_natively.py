"""ProxQP by its own object: the only interface that takes every one of its documented settings."""

from typing import Any

import numpy as np
import proxsuite

from quasistatic_ref.step.data import Array


def solve(P: Array, q: Array, G: Array, h: Array, **options: Any) -> tuple[Array, Array] | str:
    """Minimise 1/2 x'Px + q'x subject to Gx <= h, as a study asks a callable; else the status."""
    m, n = G.shape
    qp = proxsuite.proxqp.dense.QP(n, 0, m)
    for name, value in options.items():
        setattr(qp.settings, name, value)
    qp.init(P, q, None, None, G, np.full(m, -np.inf), h)
    qp.solve()
    status = qp.results.info.status
    if status == proxsuite.proxqp.QPSolverOutput.PROXQP_SOLVED:
        return qp.results.x, qp.results.z
    return str(status).rpartition(".")[2]

"""A certificate that somebody else gives with an answer, re-verified without any solver."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.expected import Json


def certificate_problem(case: Json, answer: Json) -> str | None:
    """Why a certificate does not hold; None if it does.

    Parameters
    ----------
    case : dict
        Input of the layer ``qp``.
    answer : dict
        ``delta_q``, ``lam`` and ``certificate``; it claims the correctly rounded optimum.
    """
    from quasistatic_ref.certify.certificate import verify
    from quasistatic_ref.lab.vectors.layers.qp import claimed, step_of

    if "second_order" in case:
        return "in second-order cones only the expected one is known"
    try:
        certificate = claimed(case, answer)
        delta_q, lam = (np.array(answer[name], dtype=np.float64) for name in ("delta_q", "lam"))
        verdict = verify(step_of(case), delta_q, certificate.active, lam, certificate)
    except (InputError, KeyError, TypeError, ValueError, IndexError) as error:
        return f"it cannot be read: {error}"
    return None if verdict else str(verdict.reason)

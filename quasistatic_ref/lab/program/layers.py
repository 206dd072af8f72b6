"""The layers that the program answers, by name."""

import numpy as np

from .candidates import selection
from .derivative import derivative
from .distance import distance
from .integration import integrate
from .mechanism import jacobian
from .optimum import qp
from .rows import rows
from .step import step
from .wrench import wrench

LAYERS = {
    "distance": distance,
    "selection": selection,
    "jacobian": jacobian,
    "rows": rows,
    "qp": qp,
    "wrench": wrench,
    "integrate": integrate,
    "step": step,
}
TO_SIX_DIGITS = {"derivative": derivative}
"""What is answered only if it is asked for by name."""


def plain(value):
    """Arrays as lists."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value

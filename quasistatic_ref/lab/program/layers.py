"""The layers that the program answers, by name."""

import numpy as np

from .candidates import selection
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


def plain(value):
    """Arrays as lists."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value

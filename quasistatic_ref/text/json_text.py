"""Values as JSON: one line, the same for the same bits."""

import json
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """NumPy arrays and numbers as lists and numbers that JSON holds; -0.0 becomes 0.0."""
    if isinstance(value, np.ndarray):
        return (value + 0.0).tolist() if value.dtype.kind == "f" else value.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value + 0.0
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value


def json_text(value: object) -> str:
    """One line of JSON; floats in shortest round-trip decimal. NaN and infinity are refused."""
    return json.dumps(plain(value), allow_nan=False, ensure_ascii=False)

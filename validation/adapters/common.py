"""What every adapter needs: the cases, and a report on an engine's answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.folder import layer_report
from quasistatic_ref.lab.vectors.check.report import LayerReport
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from quasistatic_ref.resources import vectors_folder


class Unsupported(Exception):
    """A case that an engine does not take."""


def engine_report(
    layer: str, engine: str, answer: Callable[[Any], Any]
) -> tuple[LayerReport, dict[str, str]]:
    """The report on an engine, and why it leaves cases out.

    Parameters
    ----------
    layer : str
    engine : str
        Name and version.
    answer : callable
        Input of a case -> output; :class:`Unsupported` where the engine does not take it.
    """
    cases, expected = inputs_read(vectors_folder(), layer), expected_read(vectors_folder(), layer)
    outputs, left_out = {}, {}
    for case in cases:
        try:
            outputs[case.id] = plain(answer(case.input))
        except Unsupported as reason:
            left_out[case.id] = str(reason)
    return layer_report(layer, cases, expected, Answers(outputs, engine)), left_out


def plain(value: Any) -> Any:
    """Arrays as lists."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def rotation(quaternion: Any) -> np.ndarray:
    """Rotation of q/|q|, q = [x, y, z, w]."""
    x, y, z, w = np.array(quaternion) / np.linalg.norm(quaternion)
    V = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * V + 2 * V @ V

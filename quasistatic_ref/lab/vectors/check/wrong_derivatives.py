"""Mistakes about derivatives that are no patch of the program: other tangent spaces, and kinks."""

from collections.abc import Iterable
from typing import Final

import numpy as np

from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.check.table import Mistake, Prediction
from quasistatic_ref.lab.vectors.converters import tangent_map
from quasistatic_ref.lab.vectors.expected import Json


def world_frame(case: Json, output: Json) -> Iterable[Json]:
    """Rows, columns or both along the world's axes."""
    q_next = program()("step", case)["q_next"]
    D = np.array(output["dq_dq"])
    for tangent in ("world", "mujoco"):
        inside, outside = (tangent_map(case["mechanism"], q, tangent) for q in (case["q"], q_next))
        yield {"dq_dq": (outside.T @ D @ inside).tolist()}
        yield {"dq_dq": (outside.T @ D).tolist()}
        yield {"dq_dq": (D @ inside).tolist()}


def number_at(*kinds: str) -> Prediction:
    """Any numbers where there is no derivative for a reason of one of these kinds."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        if {reason["kind"] for reason in output["reasons"]} & set(kinds):
            yield {"differentiable": True}

    return prediction


DERIVATIVES: Final = (
    Mistake(
        "derivative in the world instead of the body frame",
        "columns are in the tangent space at q, rows in that at q+: a floating base's own axes",
        {"derivative": world_frame},
    ),
    Mistake(
        "sub-gradient at a tie",
        "where q+ has a kink there is no derivative: say so, and why",
        {"derivative": number_at("row", "selection", "feature", "tangents", "touching")},
    ),
    Mistake(
        "sensitivity of a multiplier that is not unique",
        "where rows are dependent and a change makes them contradict, which of them press changes: "
        "there is no derivative",
        {"derivative": number_at("multipliers")},
    ),
)

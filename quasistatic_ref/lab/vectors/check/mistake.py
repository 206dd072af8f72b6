"""One classic mistake: its name, what is right, and what would be answered."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from quasistatic_ref.lab.vectors.expected import Json

Prediction = Callable[[Json, Json], Iterable[Json]]
"""(input, expected output) -> parts of outputs; several where the mistake comes in variants."""


@dataclass(frozen=True)
class Mistake:
    """One mistake.

    Parameters
    ----------
    name : str
    sentence : str
        What is wrong, and what is right.
    predictions : mapping
        By layer: what would be answered.
    """

    name: str
    sentence: str
    predictions: Mapping[str, Prediction]

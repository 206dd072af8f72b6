"""One classic mistake: its name, what is right, and what would be answered."""

from collections.abc import Mapping
from dataclasses import dataclass

from quasistatic_ref.lab.vectors.check.predictions import Prediction


@dataclass(frozen=True)
class Hypothesis:
    """One mistake.

    Parameters
    ----------
    name : str
    sentence : str
        What is wrong, and what is right.
    predictions : mapping
        By layer: (input, expected output) -> what would be answered.
    first : tuple of str
        Fields of a step; where given, one of them has to be the first that fails. What a step
        would be takes long to predict.
    """

    name: str
    sentence: str
    predictions: Mapping[str, Prediction]
    first: tuple[str, ...] = ()

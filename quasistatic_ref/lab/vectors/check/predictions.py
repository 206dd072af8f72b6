"""What a program with a classic mistake answers, from a case and its right answer.

A prediction is a part of an output, or several where a mistake comes in variants. Of a whole step
only the field that fails first is compared, so that what follows from it need not be predicted.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Final

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import layer

Prediction = Callable[[Json, Json], Iterable[Json]]

TIME_STEPS: Final = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
"""h [s] that are tried where a layer does not know it."""


def again(name: str, case: Json) -> Json:
    """The right answer to a changed input; nothing where the layer refuses that input."""
    try:
        return layer(name).expected(case).output
    except (QuasistaticError, ValueError, KeyError, IndexError, ArithmeticError):
        return {}


def scaled(output: Json, factor: float, *names: str) -> Json:
    """Some fields of an output, multiplied by a factor [-]."""
    return {name: times(output[name], factor) for name in names if name in output}


def times(value: Json, factor: float) -> Json:
    """All numbers of a value, multiplied by a factor [-]."""
    if isinstance(value, dict):
        return {name: times(v, factor) for name, v in value.items()}
    if isinstance(value, list):
        return [times(v, factor) for v in value]
    return factor * value


def each(contacts: Json, change: Callable[[Json], Json]) -> Json:
    """Contacts with some of their entries changed."""
    return [{**contact, **change(contact)} for contact in contacts]


def opposite(*names: str) -> Prediction:
    """Some fields with the other sign."""
    return lambda case, output: [scaled(output, -1.0, *names)]


def contacts_changed(change: Callable[[Json], Json]) -> Prediction:
    """Fields of the contacts of a step; each prediction holds one of them."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        return [{"contacts": [change(contact) for contact in output["contacts"]]}]

    return prediction


def by_h(*names: str, powers: Sequence[int] = (1, -1)) -> Prediction:
    """Multiplied by h, or divided by it."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        known = (case["h"],) if "h" in case else TIME_STEPS
        return [scaled(output, h**power, *names) for h in known for power in powers]

    return prediction


def both(*predictions: Prediction) -> Prediction:
    """The variants of several predictions."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        for one in predictions:
            yield from one(case, output)

    return prediction


def of_q_next(prediction: Prediction) -> Prediction:
    """A mistake of the layer `integrate` in a whole step."""

    def of_step(case: Json, output: Json) -> Iterable[Json]:
        given = {name: case[name] for name in ("mechanism", "q")}
        given["delta_q"] = output["delta_q"]
        for answer in prediction(given, {"q": output["q_next"]}):
            if "q" in answer:
                yield {"q_next": answer["q"]}

    return of_step

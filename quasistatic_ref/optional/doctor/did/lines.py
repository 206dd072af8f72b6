"""How the most telling numbers of a run are printed."""

from collections.abc import Iterator, Mapping

from quasistatic_ref.optional.doctor.did.numbers import (
    BEYOND,
    CARRIED,
    CARRIED_FROM,
    FROM_START,
    FROM_TARGET,
    IN_HAND,
    LEFT,
    RISE,
    ROTATION,
    SPRING,
    Numbers,
)
from quasistatic_ref.optional.doctor.texts import amount, distance
from quasistatic_ref.simulate.record.header import Header

PRINTED = 4
"""Bodies and joints that are printed, unless all are asked for."""
HANDS = 2
"""And hands in which a body turned."""
UNITS = ("m", "mm", "s", "deg", "rad", "N", "Nm")
"""Units at the end of a word."""


def in_words(word: str, value: float) -> str:
    """A number with its name and unit: ``slip 2.462 m`` for ``slip_m``.

    Parameters
    ----------
    word : str
        Its name in records, which ends in its unit.
    value : float
        In that unit [any].
    """
    name, _, unit = word.rpartition("_")
    if unit not in UNITS:
        return f"{word.replace('_', ' ')} {value:.4g}"
    return f"{name.replace('_', ' ')} {value:.4g} {unit.replace('Nm', 'N m')}"


def lines(numbers: Numbers, every: bool = False) -> Iterator[str]:
    """A few numbers as text: a line for each of the first bodies and joints, the others counted.

    Parameters
    ----------
    numbers : mapping
    every : bool
        Whether none is left out.
    """
    for kind, names in numbers.items():
        if kind not in ("bodies", "joints"):
            continue
        for name, each in list(names.items())[: None if every else PRINTED]:
            line = body_line(each, every) if kind == "bodies" else joint_line(each, name)
            yield f"{name}: {line}"
        if len(names) > PRINTED and not every:
            yield f"{len(names) - PRINTED} more {kind}: see --numbers"


def artifact_line(header: Header) -> str:
    """The quasi-dynamic number and the boundary layer of a run."""
    Pi = header.quasi_dynamic_number
    number = "none, no un-actuated body bears friction" if Pi is None else f"{Pi:.2g}"
    drag = getattr(header, "drag", "") if Pi else ""  # of a run that is at hand
    layer = distance(header.largest_boundary_layer or 0.0)
    artifacts = f"largest quasi-dynamic number (drag over friction): {number}{drag}"
    return f"{artifacts}; largest boundary layer: {layer}"


def body_line(numbers: Mapping[str, float], every: bool = False) -> str:
    """How far an un-actuated body or joint turned, in hands and outside, moved and rose.

    Parameters
    ----------
    numbers : mapping of str to float
        Of the run, by names that end in their units [deg, mm, N].
    every : bool
        Whether no hand is left out.
    """
    start = numbers.get(FROM_START)
    if not any(numbers.get(word) for word in (ROTATION, FROM_START, RISE)):
        return "does not move" if start is not None else "does not turn"
    line = f"turns by {turn(numbers[ROTATION])}{_in_hands(numbers, every)}"
    if CARRIED in numbers:
        line += f", {numbers[CARRIED]:.2g} after t = {numbers[CARRIED_FROM]:.4g} s"
    if not numbers[ROTATION]:
        line = "does not turn"
    if start is not None:
        line += f"; ends {distance(start)} from its start" if start else "; ends where it started"
    if numbers.get(RISE):
        line += f", rises by {distance(1e-3 * numbers[RISE])}"
    return line


def _in_hands(numbers: Mapping[str, float], every: bool) -> str:
    """How far a body turned in each hand, in brackets."""
    turns = [
        f"{angle:.2g} in the {word.removeprefix(IN_HAND).removesuffix('_deg')}"
        for word, angle in numbers.items()
        if word.startswith(IN_HAND)
    ]
    if len(turns) > HANDS and not every:
        turns = [*turns[:HANDS], f"{len(turns) - HANDS} more: see --numbers"]
    return f" ({', '.join(turns)})" if turns else ""


def turn(degrees: float) -> str:
    """An angle to two digits, or to a degree: `degrees` is one number [deg]."""
    return f"{degrees:.2g} deg" if degrees < 100.0 else f"{degrees:.0f} deg"


def joint_line(numbers: Mapping[str, float], name: str = "") -> str:
    """Where an actuated joint or base stops, and how its spring pressed.

    Parameters
    ----------
    numbers : mapping of str to float
        Of the run, by names that end in their units [deg, mm, N].
    name : str
        The joint's or the base's.
    """
    word = next(word for word in numbers if word.startswith(FROM_TARGET))
    left = amount(numbers[word], word.removeprefix(FROM_TARGET))
    share = numbers.get(LEFT, 1.0)
    way = f" ({100 * round(1.0 - share, 9):.3g} % of the way)" if share < 1.0 else ""
    if not numbers[word]:
        line = "reaches its target"
    elif any(one.startswith(BEYOND) for one in numbers):
        line = f"stops {left} beyond its target"
    elif way and not name.endswith("/base"):
        line = f"stops {left} before its target{way}"
    else:
        line = f"ends {left} from its target{way}"
    for one, force in numbers.items():
        if one.startswith(SPRING) and force:
            unit = one.removeprefix(SPRING).replace("Nm", "N m")
            line += f"; its spring presses with up to {force:.3g} {unit}"
    return line


def pair_rows(numbers: Numbers) -> list[tuple[str, ...]]:
    """A table of all pairs: a row a pair, a column a number."""
    pairs = numbers["pairs"]
    words = list(dict.fromkeys(word for each in pairs.values() for word in each))
    rows = [("pair", *(in_words(word, 0.0).replace(" 0 ", " [") + "]" for word in words))]
    for name, each in pairs.items():
        rows.append((name, *(f"{each[word]:.4g}" if word in each else "-" for word in words)))
    return rows if pairs else []

"""How the most telling numbers of a run are printed."""

from collections.abc import Iterator

from quasistatic_ref.optional.doctor.did.numbers import IN_HAND, Numbers

PRINTED = 4
"""Bodies and joints that are printed, unless all are asked for."""
HANDS = 2
"""And hands in which a body turned."""
UNITS = ("m", "mm", "s", "deg", "rad", "N", "Nm")
"""Units at the end of a word."""


def in_words(word: str, value: float) -> str:
    """A number with its name and unit: ``largest spring 2.462 N`` for ``largest_spring_N``.

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
    """A few numbers as text: two lines a body at most, one a joint, the others being counted.

    Parameters
    ----------
    numbers : mapping
    every : bool
        Whether none is left out.
    """
    for kind in ("bodies", "joints"):
        names = numbers[kind]
        for name, each in list(names.items())[: None if every else PRINTED]:
            words = {word: in_words(word, value) for word, value in each.items()}
            turns = [said for word, said in words.items() if word.startswith(IN_HAND)]
            yield f"{name}: {', '.join(v for k, v in words.items() if not k.startswith(IN_HAND))}"
            if len(turns) > HANDS and not every:
                turns = [*turns[:HANDS], f"{len(turns) - HANDS} more: see --numbers"]
            if turns:
                yield f"    {', '.join(turns)}"
        if len(names) > PRINTED and not every:
            yield f"{len(names) - PRINTED} more {kind}: see --numbers"


def pair_rows(numbers: Numbers) -> list[tuple[str, ...]]:
    """A table of all pairs: a row a pair, a column a number."""
    pairs = numbers["pairs"]
    words = list(dict.fromkeys(word for each in pairs.values() for word in each))
    rows = [("pair", *(in_words(word, 0.0).replace(" 0 ", " [") + "]" for word in words))]
    for name, each in pairs.items():
        rows.append((name, *(f"{each[word]:.4g}" if word in each else "-" for word in words)))
    return rows if pairs else []

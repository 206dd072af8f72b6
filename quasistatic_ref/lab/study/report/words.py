"""How filters, numbers, options and sentences stand in a report of a study."""

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path


@cache
def _every_sentence() -> dict[str, list[str]]:
    """The sentences, by what they are about: the headings of ``words.md``."""
    text = (Path(__file__).parent / "words.md").read_text("utf-8")
    parts = [part.strip().split("\n\n") for part in text.split("# ")[1:]]
    return {about: [" ".join(one.split()) for one in own] for about, *own in parts}


def sentences(about: str, **numbers: float) -> list[str]:
    """Those about the ``"method"``, the ``"limitations"`` or a ``"sweep"``, with their numbers.

    Parameters
    ----------
    about : str
    **numbers : float
        In the units that the sentences name [-].
    """
    return [words.format(**numbers) for words in _every_sentence()[about]]


def filter_words(where: Mapping[str, object], more: str = "") -> str:
    """A filter as text: ``setting = high, warm = false``."""
    words = [
        f"{name} = {str(value).lower() if isinstance(value, bool) else value}"
        for name, value in where.items()
    ]
    return (", ".join(words) or "all rows") + more


def tenths(value: float) -> str:
    """A number to a tenth.

    Parameters
    ----------
    value : float
        A share [%] or correct digits [-].
    """
    return f"{value:.1f}"


def milliseconds(seconds: float) -> str:
    """A time in milliseconds, to three figures.

    Parameters
    ----------
    seconds : float
        [s].
    """
    return f"{1e3 * seconds:.3g}"


def options_words(options: Mapping[str, object], without: Sequence[str] = ()) -> str:
    """Options as a solver's user writes them: ``eps_abs=1e-09, eps_rel=0``."""
    words = [
        f"{name}={value:g}" if isinstance(value, float) else f"{name}={value}"
        for name, value in options.items()
        if name not in without
    ]
    return ", ".join(words) or "none"

"""What a report is made of: sections of sentences, tables and pictures; as data."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Table:
    """A table, and the rows of the store that it was made from.

    Parameters
    ----------
    title : str
    where : str
        The filter: which rows; the first columns of the table narrow it down further.
    columns : tuple of str
    rows : tuple of tuple of str
    left : int
        How many columns are text; the others are numbers.
    """

    title: str
    where: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    left: int = 1


@dataclass(frozen=True, eq=False)
class Picture:
    """A figure to be drawn.

    Parameters
    ----------
    name : str
        Of its file.
    kind : str
        Which figure of ``lab/figures/study.py``.
    data : mapping
        What that one draws.
    caption : str
    where : str
        The filter: which rows.
    """

    name: str
    kind: str
    data: Mapping[str, Any]
    caption: str
    where: str


Block = str | Table | Picture
"""A string is a paragraph in Markdown without markup but `code`."""


@dataclass(frozen=True)
class Section:
    """A heading and what stands below it."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Report:
    """A whole report."""

    title: str
    sections: tuple[Section, ...]

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """All figures, in order."""
        return tuple(b for s in self.sections for b in s.blocks if isinstance(b, Picture))


def filter_words(where: Mapping[str, object], more: str = "") -> str:
    """A filter as text: ``setting = high, warm = false``."""
    words = [f"{name} = {_word(value)}" for name, value in where.items()]
    return ", ".join(words) + more if words else "all rows" + more


def _word(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def percent(value: float) -> str:
    """A share, to a tenth.

    Parameters
    ----------
    value : float [%]
    """
    return f"{value:.1f}"


def digits(value: float) -> str:
    """Correct digits, to a tenth.

    Parameters
    ----------
    value : float [-]
    """
    return f"{value:.1f}"


def milliseconds(seconds: float) -> str:
    """A time in milliseconds, to three figures.

    Parameters
    ----------
    seconds : float [s]
    """
    return f"{1e3 * seconds:.3g}"


def options_words(options: Mapping[str, object], without: Sequence[str] = ()) -> str:
    """Options as a solver's user writes them: ``eps_abs=1e-09, eps_rel=0``."""
    words = [f"{k}={v:g}" if isinstance(v, float) else f"{k}={v}" for k, v in options.items()
             if k not in without]  # fmt: skip
    return ", ".join(words) or "none"

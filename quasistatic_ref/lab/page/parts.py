"""What a report is made of: sections of sentences, tables and pictures; as data."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Table:
    """A table, and the rows that it was made from.

    Parameters
    ----------
    title : str
    where : str
        The filter: which rows of a store, its first columns narrowing that down further; empty
        for what is made from all that there is.
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
    folder : str
        Where a page in Markdown finds its file.
    ending : str
        Of that file.
    natural : bool
        Whether it is shown in its own size, not in the width of the page.
    """

    name: str
    kind: str
    data: Mapping[str, Any]
    caption: str
    where: str
    folder: str = "figures/"
    ending: str = "png"
    natural: bool = False

    @property
    def file(self) -> str:
        """Its file, as a page in Markdown names it."""
        return f"{self.folder}{self.name}.{self.ending}"


@dataclass(frozen=True)
class Code:
    """Lines of a program."""

    text: str


Block = str | Table | Picture | Code
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

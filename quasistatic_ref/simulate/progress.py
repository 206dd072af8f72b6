"""The progress of long work, on standard error where that is a terminal, and in notebooks."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tqdm import tqdm


class Unseen(AbstractContextManager["Unseen", None]):
    """A progress bar where nothing shows one: tqdm takes as long to import as a short run.

    Parameters
    ----------
    items : iterable
        What is gone through.
    """

    def __init__(self, items: Iterable[Any]) -> None:
        self._items = items

    def __iter__(self) -> Iterator[Any]:
        return iter(self._items)

    def __exit__(self, *raised: object) -> None:
        """Nothing is to be erased."""

    def update(self, count: int = 1) -> None:
        """Count some more."""


def progress_bar(
    items: Iterable[Any] | None = None,
    *,
    unit: str,
    total: int | None = None,
    words: str | None = None,
    shown: bool = True,
) -> tqdm | Unseen:
    """A progress bar that estimates the time left, and is erased at the end.

    Parameters
    ----------
    items : iterable, optional
        What is gone through; without it, ``update`` of the bar counts.
    unit : str
        Of which there are `total`.
    total : int, optional
    words : str, optional
        What is done.
    shown : bool
        Whether a terminal or a notebook is to show it.
    """
    terminal = sys.stderr.isatty()
    if not (shown and (terminal or in_notebook())):
        return Unseen(() if items is None else items)
    from tqdm.auto import tqdm

    # tqdm by itself prints nothing on a terminal that does not know its size.
    columns, lines = shutil.get_terminal_size()
    size = {"ncols": columns, "nrows": lines} if terminal else {}
    return tqdm(items, desc=words, total=total, unit=unit, leave=False, **size)


def in_notebook() -> bool:
    """Whether a Jupyter kernel runs this, whose standard error is no terminal."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")

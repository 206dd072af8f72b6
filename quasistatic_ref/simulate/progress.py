"""The progress of long work, on standard error where that is a terminal."""

import shutil
from collections.abc import Iterable

from tqdm import tqdm


def progress_bar(
    items: Iterable[object] | None = None,
    *,
    unit: str,
    total: int | None = None,
    words: str | None = None,
    shown: bool = True,
) -> tqdm:
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
        Whether a terminal is to show it.
    """
    # tqdm by itself prints nothing on a terminal that does not know its size.
    size = shutil.get_terminal_size()
    return tqdm(items, desc=words, total=total, unit=unit, leave=False,
                ncols=size.columns, nrows=size.lines,
                disable=None if shown else True)  # fmt: skip

"""Records of a long run, kept in a file from which it goes on where it was stopped."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

Record = dict[str, Any]


def logged(record: Callable[[int], Record], log: Path | None) -> Callable[[int], Record]:
    """A function whose i-th record is that of the log; one that is not there is made and added."""
    lines = log.read_text().splitlines() if log and log.exists() else []
    known = {one["i"]: one for one in map(json.loads, lines)}

    def of(i: int) -> Record:
        if i in known:
            return known[i]
        one = record(i)
        if log:
            with log.open("a") as file:
                file.write(json.dumps(one) + "\n")
        return one

    return of

"""Processes that tests start, and wait for."""

import time
from pathlib import Path


def has_ended(pid):
    """Whether a process is not there, or waits to be forgotten by its parent."""
    stat = Path(f"/proc/{pid}/stat")
    return not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] == "Z"


def waited_for(condition, seconds=60.0):
    """Wait until a condition holds; an error if it does not in that time."""
    last = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < last
        time.sleep(0.02)

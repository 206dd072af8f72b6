"""Processes that tests start, and wait for."""

import os
import subprocess
import sys
import time
from pathlib import Path

from tests.pages import ROOT


def python(*arguments, status=0, cwd=ROOT, env=None):
    """An interpreter of its own, once it has ended with the exit status that is expected."""
    done = subprocess.run(
        [sys.executable, *arguments], cwd=cwd, env=env, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == status, done.stdout + done.stderr
    return done


def printed_text(*lines):
    """What these lines print in an interpreter of their own, which must end well."""
    return python("-W", "error", "-c", "\n".join(lines)).stdout.strip()


def started(code, folder, **surroundings):
    """A process that runs Python's code in a folder, with the package of this checkout."""
    return subprocess.Popen(
        [sys.executable, "-c", code],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | surroundings,
        stderr=subprocess.DEVNULL,
    )


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

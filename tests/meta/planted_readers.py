"""Readers with every fault that fuzzing looks for, and one that has none."""

import os

from quasistatic_ref.errors import InputError
from validation.tools.fuzzing.worker import Reader


def numbered(rng, good):
    """The good file with a digit behind it, the same for the same seed."""
    return good + b"%d" % rng.randrange(10)


def plain(path):
    if len(path.read_bytes()) > 1:
        raise InputError("is longer than one character", file=path)


def once_spoilt(fault):
    """A reader that fails where a file is spoilt."""

    def read(path):
        if len(path.read_bytes()) > 1:
            fault()

    return read


def endless():
    while True:
        pass


FAULTS = {
    "plain": None,
    "traceback": lambda: {}["x"],
    "crash": os.abort,
    "hang": endless,
    "memory": lambda: bytearray(2**60),
}


def readers(folder):
    return {
        name: Reader("x.txt", (b"x",), numbered, once_spoilt(fault) if fault else plain)
        for name, fault in FAULTS.items()
    }

"""What a check could not decide, and why."""

from typing import NamedTuple

from quasistatic_ref.quoting import one_line


class Undecided(NamedTuple):
    """A question about a scene or run that was not answered, and the reason.

    Parameters
    ----------
    what, why : str
    """

    what: str
    why: str


LARGE = "the scene is large"
"""Why J is not formed and no step solved again."""


def failure(error: Exception) -> str:
    """The message of an exception, on one line."""
    return one_line(f"{type(error).__name__} {error}".rstrip())

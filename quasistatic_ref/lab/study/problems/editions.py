"""Versions of sets: a name is one content, and a folder that has another is not that set."""

from pathlib import Path

from quasistatic_ref.lab.study.problems.selection import set_identity

FROZEN = {
    "contact-qp-1": "8e1afbb65c99bf8960de581918bd3fa00846080b4f505cff78b99db0af83e9cb",
    "contact-qp-2": "a02844967f852b3318bf1e9cc331c2759c872bb165266ff7c672504b27d5e5a4",
}
"""SHA-256 of the manifest of each set that was released; an entry is never edited."""


def edition_problem(folder: Path) -> str | None:
    """Why a folder is not the set that it says it is; None if it is, or bears a name of its own.

    Parameters
    ----------
    folder : Path
        Its files are checked against its manifest by :func:`~.folder.manifest`.

    Raises
    ------
    InputError
        If it is no set, or a file was changed.
    """
    own = set_identity(str(folder))
    name = own["name"]
    if FROZEN.get(name, own["sha256"]) == own["sha256"]:
        return None
    return f"calls itself {name} and has other problems: give it another name"

"""Where the lab's data are: in the wheel, or in a checkout."""

from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.resources import data_folder
from quasistatic_ref.formats.quoting import suggestion

CONTACT_QP = "contact-qp"
"""The set of quadratic programs that comes with the package."""


def vectors_folder() -> Path:
    """The folder of the reference vectors that come with the package."""
    return data_folder("validation/vectors", "lab/vectors/data")


def reality_folder() -> Path:
    """The folder of measured pushes that come with the package."""
    return data_folder("validation/reality", "lab/reality/data")


def problem_set_folder(source: str) -> Path:
    """The folder of a set of quadratic programs: one that comes along by its name, or a folder.

    Raises
    ------
    InputError
        If there is neither.
    """
    if source == CONTACT_QP:
        return data_folder("validation/contact_qp", "lab/study/problems/contact_qp")
    if source in ("contact-qp-1", "contact-qp-2"):
        words = f"was an edition of the set; its problems are in {CONTACT_QP}, under the same names"
        raise InputError(words, value=source)
    if not Path(source).is_dir():
        hint = suggestion(source, [CONTACT_QP])
        raise InputError(f"is neither a folder nor a set that comes along{hint}", value=source)
    return Path(source)


def clouds_file() -> Path:
    """The rows of the study of clouds that come with the package."""
    return data_folder("validation/results", "lab/figures/data") / "clouds.jsonl"

"""Where the lab's data are: in the wheel, or in a checkout."""

from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.resources import data_folder
from quasistatic_ref.quoting import suggestion

CONTACT_QP = "contact-qp"
"""The set of quadratic programs that comes with the package."""


def vectors_folder() -> Path:
    """The folder of the reference vectors that come with the package."""
    return data_folder("validation/vectors", "lab/vectors/data")


def reality_folder() -> Path:
    """The folder of measured pushes that come with the package."""
    return data_folder("validation/reality", "lab/reality/data")


def contact_qp_folder(source: str = CONTACT_QP) -> Path:
    """The folder of contact-qp, the quadratic programs that come with the package; or another.

    Raises
    ------
    InputError
        If there is no such folder.
    """
    if source == CONTACT_QP:
        return data_folder("validation/contact_qp", "lab/study/problems/contact_qp")
    if not Path(source).is_dir():
        hint = suggestion(source, [CONTACT_QP])
        raise InputError(f"is neither a folder nor a set that comes along{hint}", value=source)
    return Path(source)


def clouds_file() -> Path:
    """The rows of the study of clouds that come with the package."""
    return data_folder("validation/results", "lab/figures/data") / "clouds.jsonl"

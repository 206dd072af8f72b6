"""Where the lab's data are: in the wheel, or in a checkout."""

from pathlib import Path

from quasistatic_ref.formats.resources import data_folder


def vectors_folder() -> Path:
    """The folder of the reference vectors that come with the package."""
    return data_folder("validation/vectors", "lab/vectors/data")


def reality_folder() -> Path:
    """The folder of measured pushes that come with the package."""
    return data_folder("validation/reality", "lab/reality/data")


def problem_set_folder() -> Path:
    """The folder of the set of quadratic programs that comes with the package."""
    return data_folder("validation/contact_qp_1", "lab/study/problems/data")


def clouds_file() -> Path:
    """The rows of the study of clouds that come with the package."""
    return data_folder("validation/results", "lab/clouds/data") / "clouds.jsonl"

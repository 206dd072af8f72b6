"""Where the data that come with the package are: in the wheel, or next to it in a checkout."""

import os
from pathlib import Path

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.quoting import slash_remedy, suggestion


def models_folder() -> Path:
    """The folder of the models that come with the package."""
    return data_folder("models", "models")


def data_folder(next_to: str, inside: str) -> Path:
    """A folder of data by its place in a checkout, or by that in the wheel."""
    package = Path(__file__).parents[1]
    root = package.parent
    in_checkout = (root / "pyproject.toml").is_file() and (root / next_to).is_dir()
    return root / next_to if in_checkout else package / inside


def scenario_names() -> list[str]:
    """Names of the scenarios that come with the package."""
    return sorted(path.stem for path in models_folder().glob("*/*.toml"))


def scenario_path(name: str | os.PathLike[str]) -> Path:
    """A scenario file: a path as it is, or the name of one that comes with the package.

    Raises
    ------
    ScenarioError
        If there is neither such a file nor such a name.
    """
    path = Path(name)
    if path.suffix == ".toml" or os.path.exists(path):  # Path's own raises for a name too long
        return path
    for known in models_folder().glob("*/*.toml"):
        if known.stem == str(path):
            return known
    hint = slash_remedy(str(path)) or suggestion(str(path), scenario_names())
    raise ScenarioError(f"is neither a file nor an installed scenario{hint}", file=name)

"""What bodies ask of readers and parts."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from quasistatic_ref.parts import needing

if TYPE_CHECKING:
    import pinocchio as pin

    from quasistatic_ref.model.tree import Tree


def urdf_tree(source: str | PathLike[str], package_dirs: Sequence[str | Path]) -> Tree:
    """A body's URDF: the tree in a file, or in a text that begins with ``<``.

    Parameters
    ----------
    source : str or Path
    package_dirs : sequence of str or Path
        Where ``package://`` URIs are looked for.
    """
    from quasistatic_ref.files.urdf.file import urdf_tree as tree

    return tree(source, package_dirs)


def described_model(model: pin.Model, geometry: pin.GeometryModel | None) -> tuple[Tree, str]:
    """``Body.of_pinocchio``: the tree of a Model, and the kind of its base."""
    with needing("Body.of_pinocchio"):
        from quasistatic_ref.optional.models.described import described_model as described
    return described(model, geometry)

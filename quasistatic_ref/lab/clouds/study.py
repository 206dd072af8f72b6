"""The study of clouds: its grid, and the row of one grasp."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from quasistatic_ref.formats.resources import models_folder
from quasistatic_ref.lab import clouds
from quasistatic_ref.lab.clouds.held import grasp_record
from quasistatic_ref.lab.clouds.samplings import SAMPLINGS, Mesh
from quasistatic_ref.lab.log import Record
from quasistatic_ref.step.data import Array

NONE = "none"
"""The change of a cell in which the scene is what it is."""
TORSION = 0.003
"""mu_omega of the scene [m]."""
STIFFNESS = 1000.0
"""K_q of the scene's width [N/m]."""
ARM = (2000.0, 2000.0, 2000.0, 50.0, 50.0, 50.0)
"""K_q of the scene's base [N/m, N m/rad]."""
TARGETS = (
    {"t": 0.0, "base": {"xyz": [0.02, -0.011, 0.175]}, "width": 0.11},
    {"t": 0.7, "base": {"xyz": [0.02, -0.011, 0.175]}},
    {"t": 2.9, "base": {"xyz": [0.02, -0.011, 0.215]}},
)
"""The scene's targets; the second has the closed width as well."""


@cache
def grid() -> Mapping[str, Any]:
    """What ``clouds.toml`` holds."""
    return tomllib.loads((files(clouds) / "clouds.toml").read_text("utf-8"))


@dataclass(frozen=True)
class Cell:
    """One grasp of the study.

    Parameters
    ----------
    sampling : str
    count : int
        Points of the cloud.
    seed : int
    change : str
        What is not as in the scene: ``"none"``, ``"k"``, ``"squeeze"``, ...
    value : float
        Its value; 0 where nothing is changed [of the change: -, m, N or N/m].
    mu_omega : float
        Of the fingers [m].
    """

    sampling: str
    count: int
    seed: int
    change: str
    value: float
    mu_omega: float

    def settings(self) -> dict[str, Any]:
        """Changes of the scenario ``bunny_grasp``."""
        settings: dict[str, Any] = {"contacts.grip.mu_omega": self.mu_omega}
        grip = grid()["grip"]
        if self.change == "k":
            settings["contacts.grip.k"] = int(self.value)
        elif self.change == "squeeze":
            settings |= _closing_targets(grip["opening"] - self.value / STIFFNESS)
        elif self.change == "stiffness":
            settings["bodies.gripper.K_q.width"] = self.value
            settings |= _closing_targets(grip["opening"] - grip["squeeze"] / self.value)
        elif self.change == "arm":
            settings["bodies.gripper.K_q.base"] = [self.value * K for K in ARM]
        return settings

    def cloud(self) -> Array:
        """The points of the cloud [m], shape (count, 3)."""
        order = list(SAMPLINGS).index(self.sampling)
        rng = np.random.default_rng([self.seed, self.count, order])
        return SAMPLINGS[self.sampling](bunny_mesh(), self.count, rng)


def _closing_targets(width: float) -> dict[str, Any]:
    """Targets whose fingers close to a width [m]."""
    first, closed, top = TARGETS
    return {"bodies.gripper.targets": [first, closed | {"width": width}, top]}


@cache
def bunny_mesh() -> Mesh:
    """The mesh of the bunny, of which the scene's cloud are vertices."""
    text = (models_folder() / "bunny_grasp" / "bunny.obj").read_text("utf-8")
    lines = [line.split() for line in text.splitlines()]
    vertices = [[float(x) for x in words[1:4]] for words in lines if words[:1] == ["v"]]
    triangles = [[int(i) - 1 for i in words[1:4]] for words in lines if words[:1] == ["f"]]
    return Mesh(np.array(vertices), np.array(triangles))


def cells() -> Iterator[Cell]:
    """Every grasp of the study; those of one cloud stand together."""
    for sampling, count, change, value in _kinds():
        for seed in range(grid()["seeds"]):
            if change == "mu_omega":
                yield Cell(sampling, count, seed, change, value, value)
                continue
            for mu_omega in (TORSION, 0.0):
                yield Cell(sampling, count, seed, change, value, mu_omega)


def _kinds() -> Iterator[tuple[str, int, str, float]]:
    density = grid()["density"]
    change = grid()["change"]
    for sampling in density["samplings"]:
        for count in density["counts"]:
            yield sampling, count, NONE, 0.0
    for name in ("k", "mu_omega", "squeeze", "stiffness", "arm"):
        for value in change[name]:
            yield change["sampling"], change["count"], name, float(value)


def row(cell: Cell, cloud: Array | None = None) -> Record:
    """What became of a grasp, rounded to six digits: the record that is committed.

    Parameters
    ----------
    cell : Cell
    cloud : ndarray, shape (count, 3), optional
        Its cloud, where it is there already [m].
    """
    record = grasp_record(cell.cloud() if cloud is None else cloud, cell.settings())
    written: Record = {
        name: value if isinstance(value, bool) else float(f"{value:.6g}")
        for name, value in record.items()
    }
    if written.get("needed") == np.inf:
        written["needed"] = None  # JSON has no infinity
    return vars(cell) | written

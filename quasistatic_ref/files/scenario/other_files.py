"""What the files are that people give in the place of a scenario, and what is done with them."""

from pathlib import Path

from quasistatic_ref.files.clouds import KINDS
from quasistatic_ref.files.mesh_files import MESHES

CLOUD = "a cloud; `quasistatic-ref body FILE` makes a body of it"
OTHER_FILES = {
    **dict.fromkeys(KINDS, CLOUD),
    **dict.fromkeys(MESHES, "a mesh; `quasistatic-ref body FILE` makes a body of it"),
    ".ply": "a mesh or a cloud; `quasistatic-ref body FILE` makes a body of it",
    ".npz": "a run, of which `extract` takes steps, or a cloud, of which `body` makes a body",
    ".xacro": "a xacro; `xacro FILE > robot.urdf` makes a URDF of it",
    ".urdf": "a robot; `inspect` shows it, and a body of a scenario names it as its `urdf`",
    **dict.fromkeys(
        (".xml", ".mjcf"),
        "a MuJoCo scene; `run` and `opinion` read it, and mujoco_scenario(MjModel) in Python",
    ),
    **dict.fromkeys(
        (".sdf", ".world"),
        "an SDF, which nothing here reads; each body needs a URDF, in a TOML file",
    ),
    **dict.fromkeys((".yaml", ".yml"), "YAML; a scenario is TOML, and its bodies are URDFs"),
    ".json": "JSON; `solve` reads steps, `verify` solutions, `qp` programs",
    ".mat": "a quadratic program; `qp` proves its optimum",
    ".parquet": "a set of quadratic programs; `qp` proves their optima",
}
"""Extension -> what such a file is."""


def other_file(path: Path) -> str | None:
    """What a file is that is no scenario by its name, and what is done with it; None of others."""
    stem = Path(path.stem)
    if path.suffix.lower() == ".txt" and stem.suffix.lower() in (".toml", *OTHER_FILES):
        return f"a text, as some editors name files that they save; rename it to {stem}"
    return OTHER_FILES.get(path.suffix.lower())

"""A scene, made in Python or loaded, written as a scenario file and URDFs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final
from xml.etree.ElementTree import Element, SubElement, fromstring, tostring

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError, ModelError
from quasistatic_ref.formats.files import bytes_written, json_text, text_written, writable_folder
from quasistatic_ref.formats.plain import bits, field_values
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.readers.mesh_files import mesh_path
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.model.system import System
from quasistatic_ref.model.urdf.solid import Homogeneous, solid_element
from quasistatic_ref.model.urdf.urdf_xml import xml_root
from quasistatic_ref.scenario.bodies import BodyEntry
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.scenario.scenario_table import FORMAT, VERSION
from quasistatic_ref.scenario.world_solids import solid_table
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.arrays import Array

WORLD: Final = 0
"""Number of the world among the links."""
NOT_OF_SIMULATORS: Final = ("targets", "wrenches", "joint_friction", "joint_limits", "support")
"""What a body's table says and no simulator knows."""
NEIGHBOURS: Final = 4
"""How many floats on each side of an angle are tried."""


def scenario_written(
    scene: Simulator | Scenario, path: str | Path, steps: int | None = None
) -> Path:
    """Write a scene as a scenario: a TOML file, and next to it a URDF for each body.

    A simulator has no targets: they stay where the actuated joints start, and waypoints can be
    added to the file. A pair's name gains those of its shapes when it is loaded. What was written
    is loaded again, and its first step compared with the scene's, before a file appears.

    Parameters
    ----------
    scene : Simulator or Scenario
    path : str or Path
        Of the scenario, ``NAME.toml``; the other files are named ``NAME_BODY``.
    steps : int
        Of a run of the scenario; by default those of `scene`, if it is one.

    Returns
    -------
    Path
        Of the scenario.

    Raises
    ------
    InputError
        If a scenario has no words for something, such as an extension, or a shape on a link that
        URDF does not know; if a file cannot be written.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    >>> scene = qr.load_scenario({"h": 0.01, "steps": 100, "bodies": {"ball": ball}})
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = qr.scenario_written(scene, Path(tempfile.mkdtemp()) / "ball.toml")
    >>> qr.load_scenario(path).system.q_start
    array([0.  , 0.  , 0.05, 0.  , 0.  , 0.  , 1.  ])
    """
    path = Path(path)
    if path.suffix != ".toml":
        raise InputError("must end in .toml", file=path)
    entries: Mapping[str, BodyEntry] = {}
    if isinstance(scene, Scenario):
        entries = scene.bodies
        # Tables of bodies say friction, joint limits and the pairs of supports.
        supports = {f"support of {name}" for name in entries}
        pairs = tuple(pair for pair in scene.pairs if pair.name not in supports)
        simulator = replace(scene, pairs=pairs, of_bodies=None).simulator()
        steps = scene.steps if steps is None else steps
    else:
        simulator = scene
    if steps is None:
        raise InputError("is missing: a simulator does not know how many", field="steps")
    if simulator.extension is not None:
        problem = "is a function, and a scenario has no words for it; pass it to Scenario.simulator"
        raise InputError(problem, field="extension")
    with TemporaryDirectory() as folder:
        files = _SceneFiles(simulator.system, Path(folder), path.stem)
        contacts: dict[str, dict[str, Any]] = {}
        for pair in simulator.pairs:
            short = pair.name.partition("(")[0]  # a loaded pair's name has those of its shapes
            contacts[pair.name if short in contacts else short] = files.contact(pair)
        top = {
            "format": FORMAT,
            "version": VERSION,
            "h": simulator.h,
            "steps": steps,
            "gravity": simulator.gravity.tolist(),
            "cone": simulator.cone,
            "law": simulator.law,
            "fast": simulator.fast,
        }
        bodies = files.bodies(simulator)
        for name, entry in entries.items():
            table = entry.table.fields
            bodies[name] |= {field: table[field] for field in NOT_OF_SIMULATORS if field in table}
        solver = {name: getattr(simulator, name) for name in ("backend", "accuracy", "certify")}
        tables = {"": top, "solver": solver, "limits": vars(simulator.limits)}
        tables |= {f"bodies.{name}": table for name, table in bodies.items()}
        tables |= {f"shapes.{name}": table for name, table in files.standing.items()}
        tables |= {f"contacts.{json_text(name)}": table for name, table in contacts.items()}
        written = text_written(Path(folder) / path.name, _toml_text(tables))
        _check_same(simulator, written)
        target = writable_folder(path.parent)
        for file in sorted(Path(folder).iterdir(), key=lambda file: file.suffix == ".toml"):
            bytes_written(target / file.name, file.read_bytes())
    return path


class _SceneFiles:
    """The files of a scene next to its scenario, and the words by which contacts name shapes.

    Parameters
    ----------
    system : System
    folder : Path
        Where the files are written.
    stem : str
        With which their names begin.
    """

    def __init__(self, system: System, folder: Path, stem: str) -> None:
        self.system = system
        self.folder = folder
        self.stem = stem
        self.robots = [xml_root(text) for text in system.texts]
        self.standing: dict[str, dict[str, Any]] = {}
        self.clouds: dict[str, str] = {}

    def contact(self, pair: ContactPair) -> dict[str, Any]:
        """The table of one pair."""
        friction = {"mu_v": pair.mu_v, "rows": pair.rows}
        if pair.rows == 6:
            friction["mu_omega"] = pair.mu_omega
        sides = {"alpha": self.named(pair.alpha), "beta": self.named(pair.beta)}
        return sides | friction | {"k": int(pair.k), "hull": pair.hull}

    def named(self, placed: PlacedShape) -> str:
        """What a contact calls a shape, which is written where no file has it yet."""
        if any(placed is shape for shape in self.system.shapes):
            return placed.name
        if placed.link == WORLD:
            kind, sizes = solid_table(placed.shape, placed.name)
            pose = {"xyz": placed.t.tolist(), "rpy": _roll_pitch_yaw(placed)}
            self.standing[placed.name] = {kind: sizes, "pose": pose}
            return placed.name
        body, _, link = self.system.links[placed.link].partition("/")
        if isinstance(placed.shape, PointCloud):
            return self.cloud(placed, placed.shape, body)
        return self.added(placed, body, link)

    def cloud(self, placed: PlacedShape, shape: PointCloud, body: str) -> str:
        """A cloud as a file, named by its body."""
        at_root = placed.link == self.system.link(body)
        if not at_root or np.any(np.eye(3) != placed.R) or np.any(placed.t):
            problem = "is a cloud that does not stand in the frame of its body's root link"
            raise InputError(problem, field=placed.name)
        if self.clouds.setdefault(body, placed.name) != placed.name:
            raise InputError("is the second cloud of its body", field=placed.name)
        np.save(self.folder / f"{self.stem}_{body}.npy", shape.points)
        return body

    def added(self, placed: PlacedShape, body: str, link: str) -> str:
        """A solid as a collision shape of its link."""
        kind, _ = solid_table(placed.shape, placed.name)
        if not isinstance(placed.shape, Homogeneous):
            problem = (
                f"is a {kind} on a link; a URDF has box, sphere, cylinder, capsule, and clouds "
                "stand in files"
            )
            raise InputError(problem, field=placed.name)
        number = [other.name for other in self.system.bodies].index(body)
        (parent,) = [one for one in self.robots[number].findall("link") if one.get("name") == link]
        name = placed.name.replace("/", "_").replace("#", "_")
        if all(one.get("name") != name for one in parent.findall("collision")):
            collision = SubElement(parent, "collision", name=name)
            rpy = _roll_pitch_yaw(placed)
            SubElement(collision, "origin", xyz=_numbers(placed.t.tolist()), rpy=_numbers(rpy))
            SubElement(collision, "geometry").append(fromstring(solid_element(placed.shape)))
            self.robots[number].set("version", "1.1")  # from which on there are capsules
        return f"{body}/{name}"

    def bodies(self, simulator: Simulator) -> dict[str, Any]:
        """The tables of all bodies; their URDFs are written."""
        tables = {}
        pairs = zip(self.system.bodies, self.robots, strict=True)
        for body, robot in pairs:
            self.copy_meshes(body, robot)
            file = f"{self.stem}_{body.name}.urdf"
            text_written(self.folder / file, tostring(robot, encoding="unicode") + "\n")
            table: dict[str, Any] = {"urdf": file, "base": body.base}
            table["pose"] = {"xyz": np.ravel(body.xyz).tolist(), "rpy": np.ravel(body.rpy).tolist()}
            table["positions"] = dict(body.positions)
            if body.name in self.clouds:
                table["cloud"] = f"{self.stem}_{body.name}.npy"
            tables[body.name] = table | self.actuation(body, simulator)
        return tables

    def actuation(self, body: Body, simulator: Simulator) -> dict[str, Any]:
        """What is actuated, its stiffness, and whether gravity acts on it."""
        actuated = self.system.coordinates[: self.system.n_a]
        of_body = np.array([c.joint.startswith(f"{body.name}/") for c in actuated], dtype=bool)
        if not of_body.any():
            return {}
        if np.any(simulator.K_q[np.ix_(of_body, ~of_body)]):
            problem = "couples two bodies, and a scenario has a matrix for each body"
            raise InputError(problem, field="K_q")
        acts = simulator.gravity_factor[: self.system.n_a][of_body]
        if acts.any() and not acts.all():
            problem = f"differs between joints of {body.name}; a scenario says it of a body"
            raise InputError(problem, field="gravity_acts")
        named = body.actuated if body.actuated == "all" else list(body.actuated)
        K_q = simulator.K_q[np.ix_(of_body, of_body)].tolist()
        return {"actuated": named, "K_q": K_q, "gravity_compensated": not acts.any()}

    def copy_meshes(self, body: Body, robot: Element) -> None:
        """Copies of the meshes that a URDF names; visual meshes that are not there are left out."""
        is_text = isinstance(body.urdf, str) and body.urdf.lstrip().startswith("<")
        folder = Path() if is_text else Path(body.urdf).parent
        for link in robot.findall("link"):
            for each in [*link.findall("collision"), *link.findall("visual")]:
                for mesh in each.findall("geometry/mesh"):
                    try:
                        mesh_file = mesh_path(mesh.get("filename", ""), folder, body.package_dirs)
                    except ModelError:
                        if each.tag == "collision":
                            raise
                        link.remove(each)
                        continue
                    name = f"{self.stem}_{body.name}_{mesh_file.name}"
                    copy = self.folder / name
                    if copy.exists() and copy.read_bytes() != mesh_file.read_bytes():
                        problem = "is the name of two meshes of one body"
                        raise InputError(problem, field=f"{body.name}: {mesh_file.name}")
                    copy.write_bytes(mesh_file.read_bytes())
                    mesh.set("filename", name)


def _roll_pitch_yaw(placed: PlacedShape) -> list[float]:
    """Roll, pitch and yaw [rad] that give a shape's R to the last bit.

    Those of R are rounded, so their neighbours are tried as well.

    Raises
    ------
    InputError
        If there are none.
    """
    R: Array = placed.R
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    rpy = np.array([np.arctan2(R[2, 1], R[2, 2]), pitch, np.arctan2(R[1, 0], R[0, 0])])
    neighbours = np.arange(-NEIGHBOURS, NEIGHBOURS + 1)
    for steps in sorted(product(neighbours, repeat=3), key=lambda steps: max(map(abs, steps))):
        angles = rpy + np.array(steps) * np.spacing(rpy)
        if np.array_equal(rotation(angles), R):
            return [float(angle) for angle in angles]
    problem = "is not what any roll, pitch and yaw give; make it by model.rotation.rotation(rpy)"
    raise InputError(problem, field=f"{placed.name}.R", value=R.tolist())


def _check_same(simulator: Simulator, path: Path) -> None:
    """Check that a scenario's first step is the simulator's, to the last bit.

    Raises
    ------
    InputError
        If a name or a number differs.
    """
    loaded = load_scenario(path)
    pairs = [pair for pair in loaded.pairs if "(" in pair.name]  # those of supports have none
    other = replace(loaded, pairs=tuple(pairs), of_bodies=None).simulator()
    for ours, written in zip(simulator.pairs, other.pairs, strict=True):
        for side in ("alpha", "beta"):
            shape = getattr(ours, side)
            again = getattr(written, side)
            if np.any(shape.R != again.R) or np.any(shape.t != again.t):
                problem = "is rounded where a URDF is read; place the shape without a rotation"
                raise InputError(problem, field=f"{shape.name}.R", value=shape.R.tolist())
    if np.any(other.system.q_start != simulator.system.q_start):
        raise InputError("would start elsewhere when it is loaded", file=path.name)
    if _first_step(simulator) != _first_step(other):
        raise InputError("would have another first step when it is loaded", file=path.name)


def _first_step(simulator: Simulator) -> object:
    """The bits of the step from where the system starts, with the targets there, but for names."""
    system = simulator.system
    q = system.q_start
    kinematics = system.kinematics(q)
    points = simulator.closest_points(kinematics)
    step = simulator.step_data(q, q[: system.n_q_a], 0.0, points, kinematics)
    return bits(field_values(step) | {"contacts": field_values(step.contacts) | {"name": ()}})


def _toml_text(tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Tables by their headings, the first one at the top of the file, in TOML."""
    parts = []
    for heading, table in tables.items():
        lines = [f"[{heading}]"] if heading else []
        lines += [f"{name} = {_toml_value(value)}" for name, value in table.items()]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def _toml_value(value: Any) -> str:
    """A value in TOML, tables in one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{json_text(k)} = {_toml_value(v)}' for k, v in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml_value, value))}]"
    return repr(value) if isinstance(value, float) else json_text(value)


def _numbers(values: Iterable[float]) -> str:
    """Numbers in shortest decimal, spaces between them."""
    return " ".join(map(repr, values))

"""The files of public packages: what loads here and elsewhere, and where the numbers differ.

    python -m validation.make.public_files

Packages are downloaded, at the versions below, into a temporary folder; nothing is installed. Each
URDF is read by pinocchio too, each MJCF scene by MuJoCo, each mesh by trimesh and each PCD by
pypcd4. Writes validation/results/public_files.md. ``--count N`` takes at most N
files of each kind of a package, spread evenly over them.
"""

import multiprocessing
import signal
import subprocess
import sys
import tarfile
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from zipfile import ZipFile

import numpy as np
from tqdm import tqdm

from quasistatic_ref import ModelError, RunFailed, System
from quasistatic_ref.errors import InputError
from quasistatic_ref.files.clouds import seen_points
from quasistatic_ref.files.mesh_files import loaded_mesh, mesh_hull
from quasistatic_ref.model.body import Body
from quasistatic_ref.optional.mujoco.compiler import compiled_model
from quasistatic_ref.optional.mujoco.scene import mujoco_scenario
from validation.tools.scripts import RESULTS, script_options

WHEELS = (
    "example-robot-data==6.0.0",
    "pybullet==3.2.7",
    "drake==1.51.1",
    "dm-control==1.0.50",
    "gymnasium-robotics==1.4.2",
    "metaworld==3.1.1",
    "mujoco-mjx==3.17.0",
    "gymnasium==1.4.0",
)
SOURCES = ("pypcd4==1.5.1",)
"""Packages whose files are those of their tests."""
MESHES = (".stl", ".obj", ".dae", ".glb", ".off", ".ply")
CLOSE = 1e-6
"""Relative difference of numbers that are the same."""
SECONDS = 60
"""Longest time of the processor in which a file is read, and a step taken of a scene."""


@dataclass(frozen=True)
class Outcome:
    """What became of one file.

    Parameters
    ----------
    package, file, kind : str
    refused : str
        Why it does not load here; empty where it does.
    peer : str
        The same of the other package.
    differs : str
        Which numbers of both differ.
    """

    package: str
    file: str
    kind: str
    refused: str
    peer: str
    differs: str


def sentence(error: Exception, package: str) -> str:
    """An error as one line, without the folder of its package."""
    if isinstance(error, ModelError | InputError):
        error.file = None
    line = " ".join(str(error).split()).replace(package, "").replace("|", "/").replace("<", "&lt;")
    return line[:240] or type(error).__name__


def of_urdf(path: Path) -> dict[str, float]:
    """Limits of joints and the whole mass [m, rad, kg]."""
    system = System([Body("b", path, actuated="all")])
    numbers = {}
    for joint in system.joints:
        if joint.limits is not None:
            name = joint.name.partition("/")[2]
            numbers |= {f"{name} lower": joint.limits[0], f"{name} upper": joint.limits[1]}
    return numbers | {"mass": float(system.masses.sum())}


def of_pinocchio(path: Path) -> dict[str, float]:
    """The same, of joints with one coordinate."""
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
    numbers = {}
    for name, joint in zip(model.names, model.joints, strict=True):
        if joint.nq == 1:
            ends = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            numbers |= {f"{name} lower": ends[0], f"{name} upper": ends[1]}
    return numbers | {"mass": sum(inertia.mass for inertia in model.inertias)}


def of_mesh(path: Path) -> dict[str, float]:
    """Its ends without vertices that no triangle uses [m], and the volume of its hull [m^3]."""
    corners = loaded_mesh(path).corners
    if not len(corners):
        mesh_hull(path, np.ones(3))  # says so
    low, high = corners.min(axis=0), corners.max(axis=0)
    ends = dict(zip("abcdef", [*low, *high], strict=True))
    flat = np.linalg.matrix_rank(corners - low) < 3
    return ends if flat else ends | {"hull": mesh_hull(path, np.ones(3)).volume}


def of_trimesh(path: Path) -> dict[str, float]:
    """The same."""
    import trimesh

    scene = trimesh.load_scene(path, process=False)
    if path.suffix.lower() == ".dae" and scene.units is not None:
        scene.apply_scale(trimesh.units.unit_conversion(scene.units, "meters"))
    low, high = scene.bounds
    volume = scene.convex_hull.volume
    return dict(zip("abcdef", [*low, *high], strict=True)) | {"hull": float(volume)}


def of_cloud(path: Path) -> dict[str, float]:
    """The number of its points, and their mean [m]."""
    return of_points(seen_points(path)[0])


def of_points(points: np.ndarray) -> dict[str, float]:
    """The same, without points that are not numbers."""
    points = points[np.isfinite(points).all(axis=1)].astype(np.float64)
    return {"points": len(points)} | dict(zip("xyz", points.mean(axis=0), strict=True))


def of_pcd(path: Path) -> dict[str, float]:
    """The same by pypcd4."""
    import pypcd4

    return of_points(pypcd4.PointCloud.from_path(path).numpy(("x", "y", "z")))


def of_mjcf(path: Path) -> dict[str, float]:
    """Coordinates and geoms of a scene that runs; only a step that fails is taken with a proof."""
    model = compiled_model(path, [path.parents[2]])
    try:
        mujoco_scenario(model, settings={"solver.certify": "off"}, steps=1).run(progress=False)
    except RunFailed:
        mujoco_scenario(model, steps=1).run(progress=False)
    return {"nv": model.nv, "ngeom": model.ngeom}


def of_mujoco(path: Path) -> dict[str, float]:
    """The same of MuJoCo's own compiler."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    return {"nv": model.nv, "ngeom": model.ngeom}


Reader = Callable[[Path], dict[str, float]]
READERS: dict[str, tuple[Reader, Reader]] = {
    "URDF": (of_urdf, of_pinocchio),
    "MJCF": (of_mjcf, of_mujoco),
    "mesh": (of_mesh, of_trimesh),
    "PCD": (of_cloud, of_pcd),
}


def kind_of(path: Path) -> str:
    """The kind of a file, or nothing of one that is none of these."""
    suffix = path.suffix.lower()
    if suffix == ".xml":
        try:
            root = ET.parse(path).getroot()
        except ET.ParseError:
            return ""
        whole = root.tag == "mujoco" and root.find("worldbody") is not None
        return "MJCF" if whole else ""
    kinds = {".urdf": "URDF", ".pcd": "PCD"}
    return "mesh" if suffix in MESHES else kinds.get(suffix, "")


class TooLong(BaseException):
    """A reader takes longer than SECONDS; no error that one of its parts may catch."""


def too_long(signum: int, frame: object) -> None:
    """End a reader."""
    raise TooLong


def tried(reader: Reader, path: Path, package: str) -> tuple[dict[str, float], str]:
    """What a reader makes of a file, or why it makes nothing."""
    signal.signal(signal.SIGPROF, too_long)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        return reader(path), ""
    except TooLong:
        return {}, f"takes longer than {SECONDS} s"
    except Exception as error:  # each package raises its own kinds of errors
        return {}, sentence(error, package)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def outcome(package: str, name: str, path: Path, kind: str) -> Outcome:
    """One file, here and elsewhere."""
    folder = str(path).removesuffix(name)
    (here, refused), (there, peer) = (tried(reader, path, folder) for reader in READERS[kind])
    differ = [
        f"{key}: {here[key]:.9g}, {there[key]:.9g}"
        for key in here.keys() & there.keys()
        if not np.isclose(here[key], there[key], rtol=CLOSE, atol=CLOSE**2)
    ]
    return Outcome(package, name, kind, refused, peer, "; ".join(sorted(differ)[:3]))


def downloaded(folder: Path) -> Iterator[tuple[str, Path]]:
    """Each package, and the folder of its files."""
    for package in (*WHEELS, *SOURCES):
        place = folder / package.partition("==")[0]
        how = ["--no-binary", place.name] if package in SOURCES else []
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", *how]
        subprocess.run([*command, "--dest", str(place), package], check=True)
        (archive,) = place.iterdir()
        if archive.suffix == ".whl":
            with ZipFile(archive) as files:
                files.extractall(place)
        else:
            with tarfile.open(archive) as files:
                files.extractall(place, filter="data")
        yield package, place


def page(outcomes: list[Outcome]) -> str:
    """Counts, and a row for each file that is refused or differs."""
    lines = ["| package | kind | files | load here | load elsewhere | only elsewhere | differ |"]
    lines += ["|---|---|---|---|---|---|---|"]
    groups = Counter((one.package, one.kind) for one in outcomes)
    for (package, kind), count in sorted(groups.items()):
        of_kind = [one for one in outcomes if (one.package, one.kind) == (package, kind)]
        counts = [
            sum(not one.refused for one in of_kind),
            sum(not one.peer for one in of_kind),
            sum(bool(one.refused) and not one.peer for one in of_kind),
            sum(bool(one.differs) for one in of_kind),
        ]
        lines.append(f"| {package} | {kind} | {count} | {' | '.join(map(str, counts))} |")
    lines += ["", "| file | here | elsewhere |", "|---|---|---|"]
    for one in sorted(outcomes, key=lambda one: (one.kind, one.package, one.file)):
        if one.refused or one.differs:
            here = one.refused or f"differs: {one.differs}"
            lines.append(f"| {one.package.partition('=')[0]}: {one.file} | {here} | "
                         f"{one.peer or 'loads'} |")  # fmt: skip
    return "\n".join(lines) + "\n"


def main() -> None:
    """Read each file of each package."""
    count = script_options(__doc__, count=int).count
    workers: Any = multiprocessing.get_context("spawn")
    with TemporaryDirectory() as temporary, ProcessPoolExecutor(2, workers) as pool:
        asked = []
        for package, folder in downloaded(Path(temporary)):
            files: dict[str, list[Path]] = {}
            for path in sorted(folder.rglob("*")):
                if path.is_file() and (kind := kind_of(path)):
                    files.setdefault(kind, []).append(path)
            for kind, paths in files.items():
                for path in paths[:: -(-len(paths) // (count or len(paths)))]:
                    name = str(path.relative_to(folder))
                    asked.append(pool.submit(outcome, package, name, path, kind))
        outcomes = [one.result() for one in tqdm(asked)]
    (RESULTS / "public_files.md").write_text(page(outcomes), "utf-8")


if __name__ == "__main__":
    main()

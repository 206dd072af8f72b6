"""A scan as a body of a scenario: its points, mass, centre of mass and inertia."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
import trimesh

from quasistatic_ref.errors import InputError, about_file, check_kind
from quasistatic_ref.files.clouds import KINDS, seen_points
from quasistatic_ref.files.mesh_files import MESHES, loaded_mesh
from quasistatic_ref.files.point_text import UNITS
from quasistatic_ref.files.text import check_points, unseen_note
from quasistatic_ref.model.body import Body
from quasistatic_ref.numbers.arrays import Array, Indices, freeze_copies, positive_number
from quasistatic_ref.optional.scans.closed import closed_mesh
from quasistatic_ref.optional.scans.cloud import spacing, stray, thinned
from quasistatic_ref.optional.scans.solid import Solid, hull_of_points
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.text.content import text_written
from quasistatic_ref.text.plain import Plain

SCANS = tuple(dict.fromkeys((*KINDS, *MESHES)))
"""Extensions of clouds and meshes."""
EXTENTS = 0.005, 3.0
"""Lengths of what is handled [m]; for others the unit is asked for."""
POINTS = 1000
"""Points that a body has unless it is said; the paper's bunny has 992."""
FEWEST = 50
"""Fewest points of which a solid is made."""
COARSE = 0.01
"""Step of a grid of coordinates over the extent [-] from which it is said."""
ON_MESH = 10_000
"""Points that are drawn on a mesh, uniform over its area, before they are thinned."""


@dataclass(frozen=True, eq=False)
class ScannedBody(Plain):
    """A body that was made of a scan.

    Parameters
    ----------
    name : str
    points : ndarray, shape (N, 3)
        Of its cloud, in the frame of the scan [m].
    mass : float
        [kg]
    centre : ndarray, shape (3,)
        Of mass [m].
    inertia : ndarray, shape (3, 3)
        About the centre of mass [kg m^2].
    notes : tuple of str
        What was done and what is doubtful, in sentences with their numbers.
    """

    name: str
    points: Array
    mass: float
    centre: Array
    inertia: Array
    notes: tuple[str, ...]

    def __post_init__(self) -> None:
        freeze_copies(self, "points", "centre", "inertia")

    @property
    def urdf(self) -> str:
        """The body's URDF: one link without a shape."""
        x, y, z = self.centre.tolist()
        (xx, xy, xz), (_, yy, yz), (*_, zz) = self.inertia.tolist()
        return (
            f'<robot name="{self.name}"><link name="{self.name}"><inertial>'
            f'<origin xyz="{x!r} {y!r} {z!r}"/><mass value="{self.mass!r}"/>'
            f'<inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="{xy!r}" ixz="{xz!r}" '
            f'iyz="{yz!r}"/></inertial></link></robot>\n'
        )

    @property
    def height(self) -> float:
        """Height of the scan's origin when its lowest point is on a floor at z = 0 [m]."""
        return -float(self.points[:, 2].min())

    def scenario(self) -> str:
        """A scenario (TOML) in which the scanned body stands on a floor as it was scanned."""
        return (
            'format = "quasistatic-ref/scenario"\n'
            "version = 1\n"
            "h = 0.02 # a guess\n"
            "steps = 50\n"
            "\n"
            f"[bodies.{self.name}]\n"
            f'urdf = "{self.name}.urdf"\n'
            f'base = "floating"\n'
            f"pose = {{ xyz = [0, 0, {self.height + 0.0:.6g}], rpy = [0, 0, 0] }} # as scanned\n"
            f'cloud = "{self.name}.csv"\n'
            "\n"
            "[shapes.floor]\n"
            "halfspace = { normal = [0, 0, 1], offset = 0 }\n"
            "\n"
            f"[contacts.{self.name}_on_floor]\n"
            'alpha = "floor"\n'
            f'beta = "{self.name}"\n'
            "mu_v = 0.5 # a guess\n"
            "rows = 4\n"
            "k = 8 # a guess\n"
        )

    def save(self, folder: str | Path) -> tuple[Path, Path]:
        """Write ``NAME.csv`` and ``NAME.urdf`` into a folder; the files."""
        lines = [",".join(f"{x:.9g}" for x in point) for point in self.points.tolist()]
        cloud = text_written(Path(folder) / f"{self.name}.csv", "\n".join(["x,y,z", *lines, ""]))
        return cloud, text_written(Path(folder) / f"{self.name}.urdf", self.urdf)


def scanned_body(
    scan: str | Path,
    *,
    mass: float | None = None,
    density: float | None = None,
    unit: str | None = None,
    points: int = POINTS,
    name: str | None = None,
) -> ScannedBody:
    """A body from a scan: a point cloud, or a mesh.

    The solid is the inside of a closed mesh, or the convex hull of a cloud, of one density. Points
    of a cloud that no gap of a few spacings joins to the others are left out.

    Parameters
    ----------
    scan : str or Path
        A cloud (CSV, XYZ, PCD, NPY, NPZ) or a mesh (STL, OBJ, PLY, OFF, GLB, DAE); one without
        faces is a cloud.
    mass : float, optional
        [kg].
    density : float, optional
        In place of the mass [kg/m^3].
    unit : str, optional
        ``"m"``, ``"cm"``, ``"mm"`` or ``"in"``; by default the one in the names of the columns, or
        metres, if the extent is that of what is handled.
    points : int
        Most points of the body.
    name : str, optional
        Of the body; by default of the file.

    Returns
    -------
    ScannedBody

    Raises
    ------
    InputError
        If the file cannot be read, the unit is doubtful, all points lie in a plane, or a mesh has
        a hole, a doubled face or shells that overlap.

    Examples
    --------
    >>> from quasistatic_ref.files.scenario.scenario import scenario_path
    >>> bunny = qr.scanned_body(scenario_path("bunny_grasp").with_name("bunny_992.csv"), mass=0.2)
    >>> bunny.points.shape
    (992, 3)
    """
    check_kind(scan, str | PathLike, "scan", "a path")
    path = Path(scan)
    name = path.stem.replace(" ", "_") if name is None else name
    Body(name, "<robot/>")  # checks the name
    options, greatest = (("mass", mass), ("density", density)), 1e6
    chosen = [(word, value) for word, value in options if value is not None]
    chosen = [(word, positive_number(value, word)) for word, value in chosen]
    if len(chosen) != 1 or not chosen[0][1] < greatest:
        problem = "say one of them, greater than 0: --mass in kg, or --density in kg/m^3"
        raise InputError(problem, field="mass, density", value=[mass, density])
    check_kind(points, int, "points", "a whole number")
    if unit is not None:
        check_kind(unit, str, "unit", f"one of {', '.join(UNITS)}")
    if points < FEWEST:
        raise InputError(f"must be at least {FEWEST}", field="points", value=points)
    with about_file(path):
        notes: list[str] = []
        cloud, solid = _surface_and_solid(path, unit, notes)
        if solid is None:
            problem = "its points lie in a plane; give a closed mesh, or points all around"
            raise InputError(problem, field="points", value=len(cloud))
    kept = thinned(cloud, points)
    if len(kept) < len(cloud):
        apart = 1e3 * spacing(cloud[kept])
        notes.append(f"{len(kept)} of {len(cloud)} points are kept, {apart:.2g} mm apart")
    mass = solid.volume * density if mass is None and density is not None else mass
    assert mass is not None
    notes.append(
        f"a volume of {1e6 * solid.volume:.4g} cm^3: {mass:.4g} kg are "
        f"{mass / solid.volume:.4g} kg/m^3"
    )
    return ScannedBody(name, cloud[kept], mass, solid.centre, mass * solid.gyration, tuple(notes))


def _surface_and_solid(
    path: Path, unit: str | None, notes: list[str]
) -> tuple[Array, Solid | None]:
    """Points on the surface, shape (N, 3) [m], and the solid; what was done is added to notes."""
    kind = path.suffix.lower()
    if kind not in SCANS:
        problem = f"is not a known kind of cloud or mesh{suggestion(kind, SCANS)}"
        raise InputError(problem, field="extension", value=path.suffix)
    if kind in MESHES:
        mesh = loaded_mesh(path)
        if not len(mesh.vertices):
            raise InputError("is empty: the file holds no vertices", field="vertices")
        notes += [mesh.note] if mesh.note else []
        if len(mesh.triangles):
            return _of_mesh(mesh.vertices * _metres(mesh.corners, unit), mesh.triangles, notes)
        check_points(len(mesh.vertices))
        written = mesh.vertices
    else:
        written, unseen, unit_of_names = seen_points(path)
        if None not in (unit, unit_of_names) and unit != unit_of_names:
            problem = f"must be {unit_of_names}, as the file names its columns, or left out"
            raise InputError(problem, field="unit", value=unit)
        unit = unit or unit_of_names
        if unseen:
            notes.append(unseen_note(unseen))
    written = np.unique(written, axis=0)
    points = written * _metres(written, unit)
    if len(points) < FEWEST:
        raise InputError(f"must be at least {FEWEST}", field="points", value=len(points))
    grid = _grid(points)
    if grid is not None:
        notes.append(
            f"its coordinates lie on a grid of {1e3 * grid:.3g} mm, as rounding leaves it, which "
            "is too coarse for its volume and its corners; take a file with more digits"
        )
    strays = stray(points)
    if strays.any():
        places = 1e3 * points[strays][:3]
        where = "; ".join(", ".join(f"{x:.4g}" for x in place) for place in places.tolist())
        more = "" if strays.sum() <= 3 else ", ..."
        notes.append(f"{strays.sum()} stray points are left out, at ({where}{more}) mm")
    points = points[~strays]
    notes.append(
        "the solid of a cloud is its convex hull; if the body is hollow, or has a hole or a dent, "
        "give a closed mesh"
    )
    return points, hull_of_points(points)


def _of_mesh(vertices: Array, triangles: Indices, notes: list[str]) -> tuple[Array, Solid]:
    """Points of a closed mesh, its corners and uniform ones, and the solid that it encloses."""
    mesh = closed_mesh(vertices, triangles, notes)
    notes.append(f"a closed mesh of {len(triangles)} triangles")
    points, _ = trimesh.sample.sample_surface(mesh, ON_MESH, seed=0)
    corners = mesh.triangles.reshape(-1, 3)
    return np.unique(np.concatenate([corners, points]), axis=0), Solid.of_triangles(mesh.triangles)


def _grid(points: Array) -> float | None:
    """The step of a coarse grid on which all coordinates lie [m], or None."""
    steps = np.concatenate([np.diff(np.unique(axis.round(9))) for axis in points.T])
    step = float(steps.min(initial=np.inf))
    extent = float(np.ptp(points, axis=0).max())
    on_grid = np.isfinite(step) and abs(steps / step - (steps / step).round()).max() < COARSE**2
    return step if on_grid and step > COARSE * extent else None


def _metres(points: Array, unit: str | None) -> float:
    """The length of one unit of coordinates [m]; InputError where the caller must state it."""
    if unit is not None:
        if unit not in UNITS:
            problem = f"is not a unit{suggestion(unit, UNITS)}"
            raise InputError(problem, field="unit", value=unit)
        return UNITS[unit]
    extent = float(np.ptp(points, axis=0).max())
    if not EXTENTS[0] <= extent <= EXTENTS[1]:
        problem = f"is {extent:.4g} m long if it is in metres; say its unit: --unit mm, or m"
        raise InputError(problem, field="unit")
    return 1.0

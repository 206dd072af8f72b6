"""Random MJCF models of meshes, and where the points of each mesh are by the words of the format.

A mesh is moved by -`refpos`, turned by the inverse of `refquat`, and then each coordinate is
multiplied by `scale`; the geom's own pose follows. A file is looked for in `meshdir` (of the
model that names it, from that model's folder), by its last name alone if `strippath` of the outer
model says so.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from quasistatic_ref.step.data import Array

BUILTIN = {
    "sphere": "2", "hemisphere": "3", "cone": "7 0.4", "wedge": "8 3 60 20 0.2",
    "supersphere": "12 0.6 0.7", "supertorus": "12 0.3 0.5 0.6",
}  # fmt: skip
INERTIA = ("legacy", "exact", "convex", "shell")


@dataclass
class MeshModel:
    """A model on disk.

    Parameters
    ----------
    path : Path
    points : dict of str to ndarray, shape (N, 3)
        Of each geom whose mesh is no builtin one, the points in the frame of its body [m].
    kinds : set of str
        What the model has: ``"strippath"``, ``"refquat"``, ...
    """

    path: Path
    points: dict[str, Array] = field(default_factory=dict)
    kinds: set[str] = field(default_factory=set)


def random_model(folder, seed):
    """A model of some bodies with meshes, written into an empty folder."""
    writer = _Writer(np.random.default_rng(seed), MeshModel(folder / "model.xml"))
    attached = writer.some("attach", 0.4)
    if attached:
        (folder / "parts").mkdir()
        body = f'<body name="top">{writer.file(folder / "parts", "of-")[1]}</body>'
        _write(folder / "parts" / "child.xml", *writer.last, body)
    assets, bodies = writer.file(folder, "")
    if attached:
        assets += '<model name="child" file="parts/child.xml"/>'
        attach = '<attach model="child" body="top" prefix="of-"/>'
        bodies += f"<frame {writer.pose()[0]}>{attach}</frame>"
    _write(writer.model.path, writer.last[0], assets, bodies)
    return writer.model


def _write(path, compiler, assets, bodies):
    path.write_text(
        f"<mujoco>{compiler}<asset>{assets}</asset><worldbody>{bodies}</worldbody></mujoco>"
    )


class _Writer:
    """What one model is written with."""

    def __init__(self, rng, model):
        self.rng = rng
        self.model = model
        self.count = 0
        self.last = ("", "")
        self.strip = self.some("strippath", 0.4)

    def some(self, kind, share=0.5):
        """Whether the model has something; noted if it has."""
        has = bool(self.rng.random() < share)
        if has:
            self.model.kinds.add(kind)
        return has

    def pose(self):
        """A pose as attributes, its rotation and its origin."""
        t = self.rng.normal(scale=0.3, size=3).round(3)
        if self.some("quarter turns", 0.3):  # where roll, pitch and yaw are least regular
            angles = 90.0 * self.rng.integers(-2, 3, 3)
        else:
            angles = self.rng.uniform(-180, 180, 3).round(2)
        R = Rotation.from_euler("XYZ", angles, degrees=True)  # MuJoCo's eulerseq xyz
        return f'pos="{_text(t)}" euler="{_text(angles)}"', R, t

    def file(self, folder, prefix):
        """The assets and bodies of one file; its compiler and assets are kept in `last`."""
        strip = self.some("another strippath") if prefix else self.strip
        meshdir = "assets" if self.some("meshdir") else ""
        word = self.rng.choice(["meshdir", "assetdir"])
        given = f'{word}="{meshdir}"' if meshdir else ""
        compiler = f'<compiler angle="degree" strippath="{str(strip).lower()}" {given}/>'
        assets = []
        bodies = ""
        for number in range(self.rng.integers(1, 3)):
            name = 'name="body1"' if number and self.some("unnamed body") else ""
            joints = "".join(
                f'<joint type="{kind}" pos="0.1 0 0.2" axis="{_text(self.rng.normal(size=3))}"/>'
                for kind in ("hinge", "slide") if self.some(kind)
            )  # fmt: skip
            geoms = "".join(
                self.geom(assets, folder / meshdir, prefix) for _ in range(self.rng.integers(1, 3))
            )
            bodies += f"<body {name} {self.pose()[0]}>{joints}{geoms}</body>"
        self.last = (compiler, "".join(assets))
        return "".join(assets), bodies

    def geom(self, assets, folder, prefix):
        """One geom of a mesh of its own."""
        self.count += 1
        name = f"g{self.count}"
        scale = np.ones(3)
        moved = np.zeros(3)
        turned = Rotation.identity()
        words = f'name="{name}" inertia="{self.rng.choice(INERTIA)}"'
        kind = self.rng.choice(["file", "vertex", "builtin"], p=[0.5, 0.3, 0.2])
        self.model.kinds.add(str(kind))
        if self.some("scale"):
            scale = self.rng.uniform(0.5, 2, 3).round(2) * self.rng.choice([1, -1], 3, p=[0.8, 0.2])
            words += f' scale="{_text(scale)}"'
        if self.some("refpos"):
            moved = self.rng.normal(scale=0.4, size=3).round(3)
            words += f' refpos="{_text(moved)}"'
        if self.some("refquat"):
            turned = Rotation.random(random_state=self.rng)
            words += f' refquat="{_text(np.roll(turned.as_quat(), 1))}"'
        pose, R, t = self.pose()
        if kind == "builtin":
            shape = str(self.rng.choice(list(BUILTIN)))
            words += f' builtin="{shape}" params="{BUILTIN[shape]}"'
        else:
            vertices, faces = self.solid()
            if kind == "vertex":
                words += f' vertex="{_text(vertices)}"'
                if self.some("face"):
                    words += f' face="{" ".join(map(str, faces.ravel()))}"'
            else:
                words += f' file="{self.mesh_file(folder, name, vertices, faces)}"'
            placed = scale * turned.inv().apply(vertices - moved)
            self.model.points[prefix + name] = R.apply(placed) + t
        assets.append(f"<mesh {words}/>")
        return f'<geom name="{name}" type="mesh" mesh="{name}" {pose}/>'

    def solid(self):
        """Vertices and outward faces of a random polytope, or of one with a dent."""
        points = self.rng.normal(scale=0.1, size=(self.rng.integers(5, 20), 3)).round(4)
        hull = ConvexHull(points)
        vertices = points[hull.vertices]
        number = {int(old): new for new, old in enumerate(hull.vertices)}
        faces = np.array([[number[int(i)] for i in face] for face in hull.simplices])
        a, b, c = vertices[faces].transpose(1, 0, 2)
        inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
        faces[inward] = faces[inward][:, ::-1]
        if self.some("dent", 0.3):  # its last vertex is drawn half-way to the middle
            vertices[-1] = (vertices[-1] + vertices.mean(axis=0)) / 2
        return vertices, faces

    def mesh_file(self, folder, name, vertices, faces):
        """A mesh as a file, with another of the same name where it must not be looked for."""
        inside = folder / "deep" / f"{name}.obj"
        plain = folder / f"{name}.obj"
        inside.parent.mkdir(parents=True, exist_ok=True)
        right, wrong = (plain, inside) if self.strip else (inside, plain)
        for path, factor in ((right, 1.0), (wrong, 3.0)):
            lines = [f"v {_text(factor * vertex)}" for vertex in vertices]
            lines += [f"f {' '.join(str(i + 1) for i in face)}" for face in faces]
            path.write_text("\n".join(lines) + "\n")
        return f"deep/{name}.obj"


def _text(numbers):
    return " ".join(repr(float(x)) for x in np.ravel(numbers))

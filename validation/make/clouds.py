"""The study of clouds: the grasp with other clouds of the same bunny.

    python -m validation.make.clouds [--row N]

Row N of results/clouds.jsonl is made again and printed, without N all of them: which cloud, what is
not as in the scene, and what became of the grasp. What else is in a row was measured once, in the
closed grip: the squeeze of a finger [N], the distance of the centre of mass from the line of the
loads [m], the loaded points, and the mu_omega that these have by mu_v alone (R15), and that is
needed (R14) [m].
"""

import json
import tempfile

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

import quasistatic_ref as qr
from validation.tools.scripts import RESULTS, ROOT, script_options

ROWS = RESULTS / "clouds.jsonl"
BUNNY = trimesh.load_mesh(ROOT / "models/bunny_grasp/bunny.obj", process=False)
CLOSED, TOP = 70, 290
"""Steps between which the bunny is lifted."""


def random(rng, count):
    """Points uniformly distributed over the bunny, and the normals there, each (count, 3)."""
    of = rng.choice(len(BUNNY.faces), count, p=BUNNY.area_faces / BUNNY.area)
    s, t = rng.random((2, count, 1))
    s, t = np.where(s + t > 1, (1 - s, 1 - t), (s, t))
    a, b, c = BUNNY.triangles[of].swapaxes(0, 1)
    return a + s * (b - a) + t * (c - a), BUNNY.face_normals[of]


def farthest(rng, count):
    """Points each of which is the farthest from those before it, of four times as many."""
    points, normals = random(rng, 4 * count)
    chosen = [0]
    distance = np.inf
    while len(chosen) < count:
        gaps = np.linalg.norm(points - points[chosen[-1]], axis=1)
        distance = np.minimum(distance, gaps)
        chosen.append(distance.argmax())
    return points[chosen], normals[chosen]


def vertices(rng, count):
    """Vertices of the bunny, whose triangles are divided in four until there are enough."""
    points, triangles = np.array(BUNNY.vertices), BUNNY.faces
    while len(points) < count:
        sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, of = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = triangles.T
        d, e, f = (of.reshape(-1, 3) + len(points)).T
        points = np.vstack([points, points[edges].mean(axis=1)])
        triangles = np.hstack([(a, d, f), (d, b, e), (f, e, c), (d, e, f)]).T
    return points[rng.permutation(len(points))[:count]], None


def scan(rng, count):
    """Points that one of four views sees at a cosine of 0.3, with five holes and noise."""
    views = rng.normal(size=(4, 3))
    holes, _ = random(rng, 5)
    seen = np.zeros((0, 3))
    while len(seen) < count:
        points, normals = random(rng, count)
        kept = np.any(normals @ views.T > 0.3 * np.linalg.norm(views, axis=1), axis=1)
        kept &= np.all(np.linalg.norm(points[:, None] - holes, axis=2) > 0.008, axis=1)
        noise = 2e-4 * rng.normal(size=(count, 1)) * normals
        seen = np.vstack([seen, (points + noise)[kept]])
    return seen[:count], None


SAMPLINGS = {"random": random, "farthest": farthest, "vertices": vertices, "scan": scan}


def row_again(row):
    """What became of a row's grasp: largest rotation [deg] and rise [mm] during the lift."""
    kind, count = row["sampling"], row["count"]
    rng = np.random.default_rng([row["seed"], count, list(SAMPLINGS).index(kind)])
    value = {"k": 5, "squeeze": 12.2, "stiffness": 1000.0, "arm": 1.0, row["change"]: row["value"]}
    at = {"t": 0.0, "base": {"xyz": [0.02, -0.011, 0.175]}, "width": 0.11}
    closed = at | {"t": 0.7, "width": 0.0952 - value["squeeze"] / value["stiffness"]}
    top = {"t": 2.9, "base": {"xyz": [0.02, -0.011, 0.215]}}
    with tempfile.NamedTemporaryFile(suffix=".npz") as file:
        np.savez(file, points=SAMPLINGS[kind](rng, count)[0])
        file.flush()
        scenario = qr.load_scenario("bunny_grasp", {
            "bodies.bunny.cloud": file.name, "steps": TOP,
            "contacts.grip.k": int(value["k"]), "contacts.grip.mu_omega": row["mu_omega"],
            "bodies.gripper.K_q.base": (value["arm"] * np.repeat([2000.0, 50.0], 3)).tolist(),
            "bodies.gripper.K_q.width": value["stiffness"],
            "bodies.gripper.targets": [at, closed, top],
        }, fast=True)  # fmt: skip
    run = scenario.run(progress=False)
    link = scenario.system.link("bunny")
    poses = [scenario.system.kinematics(q) for q in run["q"][CLOSED:]]
    turns = Rotation.from_matrix([pose.R[link] @ poses[0].R[link].T for pose in poses])
    return row | {
        "rotation": float(f"{np.degrees(turns.magnitude().max()):.6g}"),
        "lift": float(f"{1e3 * (poses[-1].t[link] - poses[0].t[link])[2]:.6g}"),
        "certified": np.mean(run["certificate"] == "exact"),
    }


if __name__ == "__main__":
    chosen = script_options(__doc__, row=int).row
    for number, line in enumerate(ROWS.read_text("utf-8").splitlines()):
        if number > 0 and chosen in (None, number):
            print(json.dumps(row_again(json.loads(line))))

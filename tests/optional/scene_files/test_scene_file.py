"""Scenes made in Python, written as files and loaded again."""

from dataclasses import replace

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.scenes.systems import RAIL
from quasistatic_ref.model.joints.axis_joint import Prismatic
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.optional.scene_files.scene_file import scenario_written
from tests.contact.still import placed_shape
from tests.extras import SCENARIOS

TURNED = rotation(np.array([0.3, -0.2, 1.1]))
STANDING = (
    qr.Box((0.05, 0.06, 0.07)),
    qr.Sphere(0.1),
    qr.Cylinder(0.02, 0.1),
    qr.Capsule(0.02, 0.1),
    qr.Cone(0.02, 0.1),
    qr.Ellipsoid((0.01, 0.02, 0.03)),
)


def scene(changes=(), **settings):
    """A finger on a rail, a ball that it pushes, solids that stand, a capsule and a cloud."""
    rail = qr.Body("rail", RAIL, actuated=["slide"], xyz=(-0.2, 0, 0.05))
    ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    system = qr.System([rail, ball])
    finger = system.link("rail/finger")
    body = system.link("ball/solid")
    floor = placed_shape(qr.HalfSpace((0, 0, 1), 0.0), name="floor")
    cloud = placed_shape(qr.PointCloud(0.04 * np.eye(3)), body, name="points")
    pairs = [
        qr.ContactPair("rest", floor, system.shapes[0], 0.5, 0.01, 6, 1),
        qr.ContactPair("push",
                       placed_shape(qr.Capsule(0.02, 0.03), finger, t=(0.1, 0, 0), name="tip"),
                       system.shapes[0], 0.2, 0.0, 4, 1),
        qr.ContactPair("points", floor, cloud, 0.1, 0.0, 4, 2),
    ]  # fmt: skip
    for number, shape in enumerate(STANDING):
        stands = placed_shape(shape, 0, TURNED, (number, 2.0, 0.1), f"solid{number}")
        pairs.append(qr.ContactPair(f"far {number}", stands, system.shapes[0], 0.5, 0.0, 4, 1))
    K_q = np.array([[300.0]])
    return qr.Simulator(system, [*pairs, *changes], **({"h": 0.02, "K_q": K_q} | settings))


def motion(simulator, steps=5):
    target = simulator.system.q_start[: simulator.system.n_q_a]
    if isinstance(simulator.system.joints[0], Prismatic):
        target = target + 0.1
    run = qr.rollout(simulator, simulator.system.q_start, target, steps=steps, progress=False)
    return run["q"].tobytes()


def test_a_scene_is_loaded_as_it_was_written_and_moves_alike(tmp_path):
    simulator = qr.FastSimulator(scene(gravity_acts=np.array([True])))
    path = qr.scenario_written(simulator, tmp_path / "new" / "scene.toml", steps=7)
    loaded = qr.load_scenario(path)
    assert loaded.steps == 7
    assert loaded.fast
    names = [pair.name.partition("(")[0] for pair in loaded.pairs]
    assert names == [pair.name for pair in simulator.pairs]
    assert motion(loaded.simulator()) == motion(simulator)
    names = sorted(file.name for file in path.parent.iterdir())
    assert names == ["scene.toml", "scene_ball.npy", "scene_ball.urdf", "scene_rail.urdf"]


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_scenario_of_the_package_is_written_as_it_was_loaded(tmp_path, name):
    scenario = qr.load_scenario(name, fast=True)
    loaded = qr.load_scenario(qr.scenario_written(scenario, tmp_path / "copy.toml"))
    assert loaded.steps == scenario.steps
    for t in np.linspace(0, scenario.h * scenario.steps, 7):
        assert loaded.targets(t).tobytes() == scenario.targets(t).tobytes()
    first = [replace(one, steps=2).run(progress=False)["q"] for one in (loaded, scenario)]
    assert first[0].tobytes() == first[1].tobytes()


def test_what_only_a_scenario_says_is_written_with_it(tmp_path):
    """Targets, wrenches, friction of a joint and of a support, Coulomb's law."""
    puck = qr.Body.of_shape("puck", qr.Cylinder(0.03, 0.01), 0.2, base="planar")
    scenario = qr.load_scenario({
        "h": 0.02,
        "steps": 6,
        "bodies": {
            "rail": {
                "urdf": RAIL, "actuated": ["slide"], "K_q": {"slide": 100.0},
                "targets": [{"t": 0.0, "slide": 0.0}, {"t": 0.1, "slide": 0.05}],
                "joint_friction": {"slide": 0.3},
            },
            "puck": {
                "urdf": puck, "pose": {"xyz": (0.4, 0, 0)},
                "support": {"mu_v": 0.3, "mu_omega": 0.01},
                "wrenches": [{"t": 0.02, "force": [1.5, 0, 0]}, {"t": 0.1, "torque": [0, 0, 0.1]}],
            },
        },
    })  # fmt: skip
    loaded = qr.load_scenario(qr.scenario_written(scenario, tmp_path / "scene.toml"))
    runs = [one.run(progress=False) for one in (scenario, loaded)]
    assert runs[0]["q"].tobytes() == runs[1]["q"].tobytes()
    assert np.ptp(scenario.system.of(runs[0].q, "rail/slide")) > 0.01
    assert np.ptp(scenario.system.of(runs[0].q, "puck.x")) > 0
    law = qr.load_scenario("sphere_spin", {"law": "coulomb"}, steps=1)
    assert qr.load_scenario(qr.scenario_written(law, tmp_path / "law.toml")).law == "coulomb"


ON_BALL = 3
"""Number of the ball's link."""


@pytest.mark.parametrize(
    ("changes", "settings", "words"),
    [
        ((), {"extension": lambda q: qr.Extension()}, "extension: is a function"),
        ([qr.Cone(0.01, 0.01)], {}, "is a cone on a link"),
        ([qr.convex_hull(np.vstack([np.zeros(3), np.eye(3)]))], {}, "is a ConvexMesh"),
    ],
)
def test_what_no_file_holds_is_refused_and_nothing_is_written(tmp_path, changes, settings, words):
    floor = placed_shape(qr.HalfSpace((0, 0, 1), 0.0), name="floor")
    pairs = [
        qr.ContactPair("more", floor, placed_shape(shape, ON_BALL), 0.1, 0.0, 4, 1)
        for shape in changes
    ]
    with pytest.raises(InputError, match=words):
        scenario_written(scene(pairs, **settings), tmp_path / "scene.toml", steps=1)
    assert not list(tmp_path.iterdir())


def test_a_rotation_that_no_angles_give_is_refused_by_name(tmp_path):
    R = TURNED @ TURNED @ TURNED  # rounded otherwise than any roll, pitch and yaw
    beta = scene().pairs[0].beta
    for skew, words in (
        (placed_shape(STANDING[0], 0, R, name="skew"), "is not what any roll, pitch and yaw give"),
        (placed_shape(STANDING[0], 2, TURNED, name="skew"), "is rounded where a URDF is read"),
    ):
        more = qr.ContactPair("more", skew, beta, 0.1, 0.0, 4, 1)
        with pytest.raises(InputError, match=rf"skew\.R: {words}"):
            scenario_written(scene([more]), tmp_path / "scene.toml", steps=1)
    assert not list(tmp_path.iterdir())

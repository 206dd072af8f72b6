"""Mistakes of a new user in Python: each is answered with one sentence that names field and remedy.

Each line is an answer, and the calls that it is given to.
"""

from pathlib import Path

import coal
import mujoco
import numpy as np
import pinocchio as pin
import pytest

import quasistatic_ref as qr
from quasistatic_ref import InputError, Limits, QuasistaticError
from tests.closeness import assert_same
from tests.files.urdf.urdf_texts import collision, inertial, link, robot, urdf_of_text
from tests.scenes import PUSH, written_scenario

BLOCK = qr.Body.of_shape("block", qr.Box((0.05, 0.05, 0.02)), mass=0.5, xyz=(0, 0, 0.02))
FINGER = qr.Body.of_shape("finger", qr.Sphere(0.01), 0.1, xyz=(-0.06, 0, 0.02), actuated=["base"])
SYSTEM = qr.System([FINGER, BLOCK])
Q = SYSTEM.q_start
Q_A = Q[:7]
FLOOR = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
SCENE = {
    "h": 0.01, "steps": 2, "bodies": {"block": BLOCK}, "shapes": {"floor": FLOOR.shape},
    "contacts": {"rest": {"alpha": "floor", "beta": "block", "mu_v": 0.5, "rows": 4}},
}  # fmt: skip
LOADS = r"system.load\(q, \"BODY\", force="


def pair(**more):
    given = {"name": "f", "alpha": FLOOR, "beta": SYSTEM.shapes[1]}
    return qr.ContactPair(**(given | {"mu_v": 0.3, "mu_omega": 0.0, "rows": 4, "k": 4} | more))


def simulator(**more):
    return qr.Simulator(SYSTEM, [pair()], **({"h": 0.01, "K_q": 100.0} | more))


SCENARIO = qr.load_scenario("sphere_spin")
SIMULATOR = simulator()
STEP = SIMULATOR.step(Q, Q_A).step
FORM = qr.standard_form(STEP)


def step(q=Q, q_bar_a=Q_A, **more):
    """By two backends, which must say the same."""
    said = []
    for one in (SIMULATOR, simulator(backend="daqp")):
        with pytest.raises(QuasistaticError) as refused:
            one.step(q, q_bar_a, **more)
        said.append(str(refused.value))
    assert said[0] == said[1]
    raise refused.value


def run(**more):
    return qr.rollout(SIMULATOR, **({"q": Q, "target": Q_A, "steps": 2} | more))


def scene(**more):
    return qr.load_scenario(SCENE | more)


RUN = run()
TURNED = SYSTEM.placed({"block": {"rpy": (0.1, 0.2, 0.3)}})
MISTAKES = {
    r"q: must have shape \(14,\)": (
        lambda: step(Q[:7]),
        lambda: step(Q[None]),
    ),
    "must be finite": lambda: step(Q * np.nan),
    r"one, not 0\.9999999739; system.normalised\(q\) divides it": lambda: step(
        TURNED.astype(np.float32)
    ),
    r"q_a: must have shape \(7,\)": lambda: step(q_bar_a=Q),
    "is not a body, joint or coordinate; known: block": lambda: run(target={"thumb": 0.01}),
    r"target\[block\]: is not actuated; make it so": lambda: run(target={"block": 0.01}),
    r"target: must return numbers of shape \(7,\)": lambda: run(target=lambda t: None),
    r"\(7,\) or \(2, 7\), or name joints": lambda: run(target=np.tile(Q_A, (5, 1))),
    r"must contain finite numbers of shape \(7,\)": lambda: run(target=Q_A * np.nan),
    LOADS: (
        lambda: step(force={"block": [1, 0, 0]}),
        lambda: run(force=[1, 0, 0]),
        lambda: run(force=lambda t, q: [1, 0, 0]),
        lambda: run(force=lambda t: {"block": (1, 0, 0)}),
    ),
    "must contain finite numbers only": lambda: step(force=np.full(12, np.nan)),
    r"force: must have shape \(3,\)": lambda: SYSTEM.load(Q, "block", force=1.0),
    "h: must be a positive number of seconds": lambda: simulator(h=0),
    r"K_q: must have shape \(6,\)": lambda: simulator(K_q=[1, 2, 3]),
    "K_q: must be positive definite": lambda: simulator(K_q=0),
    "K_q: must contain finite numbers only": lambda: simulator(K_q=np.inf),
    r"K_q\[block\]: is not actuated": lambda: simulator(K_q={"block": 1.0}),
    "has no stiffness for finger/base": (
        lambda: simulator(K_q={"finger/base.x": 1.0}),
        lambda: simulator(K_q={}),
    ),
    r"gravity: must have shape \(3,\)": lambda: simulator(gravity=-9.81),
    "gravity_acts: must be true or false for each": (
        lambda: simulator(gravity_acts=[0.5] * 6),
        lambda: simulator(gravity_acts=["yes"] * 6),
    ),
    r"gravity_acts: must have shape \(6,\)": lambda: simulator(gravity_acts=[True]),
    "simulator.h: is fixed when a simulator is made": lambda: setattr(SIMULATOR, "h", 0.02),
    "limits.reach: must be a number greater than 0": lambda: Limits(reach=np.nan),
    "limits.penetration: must be a number greater than 0": lambda: Limits(penetration=True),
    "accuracy: must be a number greater than 0": lambda: simulator(accuracy=True),
    "cone: must be the name of a cone": lambda: STEP.replace(cone=["pyramid"]),
    "law: is not a choice": lambda: simulator(law=["convex"]),
    r"bodies: must be a list of bodies: System\(\[body\]\)": lambda: qr.System(BLOCK),
    "bodies: must be a list of bodies, each as Body or Body.of_pinocchio makes it": lambda: (
        qr.System(["block"])
    ),
    "pose: is no argument of Body; give xyz=pose.translation": (
        lambda: qr.Body("b", "b.urdf", pose=pin.SE3.Identity()),
        lambda: qr.Body.of_shape("b", qr.Sphere(0.1), 1.0, pose=pin.SE3.Identity()),
        lambda: qr.Body.of_pinocchio("b", pin.Model(), pose=pin.SE3.Identity()),
    ),
    "actuate: is no argument of Body; did you mean 'actuated'": lambda: qr.Body(
        "b", "b.urdf", actuate="all"
    ),
    "b.urdf: must be a path, or a URDF as text; of_pinocchio takes": lambda: qr.Body(
        "b", pin.Model()
    ),
    r"must be a pinocchio.Model: robot.model, and": lambda: qr.Body.of_pinocchio(
        "b", pin.RobotWrapper(pin.Model())
    ),
    r"b.shape: must be one of this package, such as Box\(box.halfSide\)": lambda: qr.Body.of_shape(
        "b", coal.Box(1.0, 1.0, 1.0), 1.0
    ),
    "b.package_dirs: must be a list of": lambda: qr.Body("b", "b.urdf", package_dirs="x"),
    "step: must be a StepData": lambda: qr.verify(qr.SolutionFile(3)),
    "extension: must be an Extension": lambda: qr.solve_step(STEP, extension=3),
    "extension.terms: must be a function of": lambda: qr.Extension([]),
    "extension.without_stiffness: must be True or False": lambda: qr.Extension(
        without_stiffness="no"
    ),
    "extension.rises: must be Rises": lambda: qr.Extension(rises=[1.0]),
    "extension.rows: must be an Extra": lambda: qr.Extension(rows=(np.eye(3), np.zeros(3))),
    "solver: is no argument of .*; did you mean 'backend'": (
        lambda: qr.solve_step(STEP, solver="osqp"),
        lambda: simulator(solver="osqp"),
        lambda: qr.coulomb_step(STEP, solver="osqp"),
        lambda: qr.StepProblem(STEP).solve(solver="OSQP"),
    ),
    "forces: is no argument of rollout; did you mean 'force'": lambda: run(forces=None),
    "finding: is no argument of Scenario.run; did you mean 'findings'": lambda: qr.load_scenario(
        "sphere_spin"
    ).run(finding=False),
    "name: must be a path, an installed scenario's name or a": lambda: qr.load_scenario(3),
    "farkas: must be a list of fractions": lambda: qr.verify(qr.SolutionFile(STEP, farkas=3)),
    "contacts: must be Contacts": lambda: STEP.replace(contacts=3),
    "extra: must be an Extra": lambda: STEP.replace(extra=3),
    r"delta_q: must have shape \(12,\)": lambda: qr.optimality_residuals(FORM, 3, []),
    "observers: must be a list of Observer": lambda: run(observers=[3]),
    "ignore: must be a list of names": lambda: run(ignore=[3]),
    "is not an array of this trajectory": lambda: RUN[["phi"]],
    "name: must be a name": lambda: SYSTEM.of(Q, ["block"]),
    "model: must be a mujoco.MjModel": (
        lambda: qr.mujoco_step(3, 3, 0.01),
        lambda: qr.mujoco_scenario({"h": 0.01}),
    ),
    r"a mujoco.MjModel: spec.compile\(\)": (
        lambda: qr.mujoco_step(mujoco.MjSpec(), 3, 0.01),
        lambda: qr.mujoco_opinion(mujoco.MjSpec(), 3),
        lambda: qr.mujoco_scenario(mujoco.MjSpec()),
    ),
    r"a mujoco.MjModel: mujoco.MjModel.from_xml_path\(file\)": (
        lambda: qr.mujoco_step("scene.xml", 3, 0.01),
        lambda: qr.mujoco_opinion(Path("scene.xml"), 3),
        lambda: qr.mujoco_scenario("scene.xml"),
    ),
    "data: must be a mujoco.MjData": lambda: qr.mujoco_scenario(
        mujoco.MjSpec().compile(), "scene.xml"
    ),
    "tolerance: must be a number greater than 0": lambda: qr.mujoco_opinion(3, 3, "1"),
    "of: must be a Moment, as figures.moment makes it": lambda: qr.draw_scene(None, 3),
    "moments: must be a list of moments": lambda: qr.draw_scenes([], [3]),
    r"must be a StepData: save_step\(path, step\)": lambda: qr.save_step(STEP, "x.json"),
    r"must be a Trajectory: save_trajectory\(path": lambda: qr.save_trajectory(STEP, "x.npz"),
    r"must be a StepSolution: save_solution\(path": lambda: qr.save_solution(STEP, "x.json"),
    "f.mu_v: must be at least 0": lambda: pair(mu_v=-1.0),
    "f.k: must be a whole number, 1 or more": lambda: pair(k=True),
    "name: must be a text": lambda: pair(name=3),
    r"points: must have shape \(3, 3\)": lambda: qr.PointCloud(np.zeros((3, 2))),
    "half_extents: must be given, or size, twice as long, and not both": lambda: qr.Box(),
}
"""Words of the answer, and what is answered so."""


@pytest.mark.parametrize("words", MISTAKES)
def test_each_mistake_is_one_sentence_that_says_what_is_right(words):
    for number, mistake in enumerate(np.atleast_1d(MISTAKES[words])):
        with pytest.raises(QuasistaticError, match=words) as refused:
            mistake()
        sentence = str(refused.value)
        assert "\n" not in sentence, number
        assert len(sentence) < 500, number


def test_a_function_of_q_cannot_change_where_its_step_starts():
    def changing(t, q):
        q[0] = 1.0
        return Q_A

    with pytest.raises(ValueError, match="read-only"):
        run(target=changing)


def test_a_target_that_is_changed_after_its_step_stays_recorded():
    recorder, target = qr.Recorder(SIMULATOR, Q), Q_A.copy()
    recorder.add(target, SIMULATOR.step(Q, target))
    target[0] = 1.0
    assert_same(recorder.trajectory()["q_bar_a"], [Q_A])


def test_a_target_by_names_holds_all_other_joints():
    goal = SYSTEM.placed({"finger": {"xyz": (-0.05, 0, 0.02)}})[:7]
    named = run(target={"finger": {"xyz": (-0.05, 0, 0.02)}})
    returned = run(target=lambda t: {"finger.x": -0.05})
    assert named["q"].tobytes() == run(target=goal)["q"].tobytes() == returned["q"].tobytes()


def test_a_body_that_nothing_moves_is_offered_a_base(tmp_path):
    head, _, rest = PUSH.replace('base = "floating"\n', "").partition("[[bodies.ball")
    path = written_scenario(tmp_path, head + rest[rest.index("[shapes.floor]") :])
    with pytest.raises(InputError, match=r'if ball is to move freely, give it base = "floating"$'):
        qr.load_scenario(path)


def test_a_collision_keeps_its_name_and_contacts_may_use_it(tmp_path):
    ball = collision('<sphere radius="0.01"/>', '<origin xyz="0.04 0 0"/>')
    named = ball.replace("<collision>", '<collision name="handle">')
    mug = link("mug", collision('<sphere radius="0.03"/>') + named, inertial("0.2", ("1e-4",) * 3))
    urdf_of_text(tmp_path, robot(mug), "mug.urdf")
    path = tmp_path / "mug.toml"
    path.write_text(
        'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
        '[bodies.mug]\nurdf = "mug.urdf"\nbase = "floating"\n'
        "[shapes.floor]\nhalfspace = { normal = [0, 0, 1] }\n"
        '[contacts.floor]\nalpha = "floor"\nbeta = "mug/handle"\nmu_v = 0.5\nrows = 4\n'
    )
    scenario = qr.load_scenario(path)
    assert [shape.name for shape in scenario.system.shapes] == ["mug/mug#0", "mug/handle"]
    assert [pair.name for pair in scenario.pairs] == ["floor(floor, mug/handle)"]
    # The name of a link, or one that is there twice, would mean two things.
    for taken in ("mug", "a#b"):
        text = robot(mug.replace('name="handle"', f'name="{taken}"'))
        assert qr.System([qr.Body("mug", text)]).shapes[1].name == "mug/mug#1"


def test_findings_of_a_step_that_starts_deep_or_that_nothing_holds():
    deep = SYSTEM.placed({"block": {"xyz": (0, 0, -0.01)}})
    assert [one.name for one in SIMULATOR.findings(deep)] == ["initial-penetration"]
    assert SIMULATOR.findings() == ()
    assert "unsupported-body" in [one.name for one in scene(contacts={}).findings()]


def test_stiffness_in_each_form_is_the_same_matrix():
    diagonal = [1e3, 1e3, 1e3, 10.0, 10.0, 10.0]
    forms = np.diag(diagonal), diagonal, {"finger": diagonal}, {"finger/base": np.diag(diagonal)}
    for form in forms:
        assert_same(simulator(K_q=form).K_q, np.diag(diagonal))
    assert_same(simulator(K_q=7.0).K_q, 7.0 * np.eye(6))


def test_defaults_of_toml_are_those_of_python_and_a_far_limit_is_one():
    alone = qr.ContactPair("f", FLOOR, SYSTEM.shapes[1], mu_v=0.3, mu_omega=0.0)
    assert (alone.rows, alone.k) == (6, 1)
    free = qr.System([BLOCK])
    assert qr.Simulator(free, [], h=0.01).K_q.shape == (0, 0)
    far = qr.Simulator(free, [], h=0.01, limits=Limits(reach=1e200))
    assert far.step(free.q_start, []).q[2] < free.q_start[2]


ALONE = qr.System([BLOCK])
OF_TWO = "<System of finger, block: n_a = 6, n_u = 6, 2 links>"
OF_ONE = "<System of block: n_a = 0, n_u = 6, 1 link>"
SHOWN = {
    OF_TWO: SYSTEM,
    OF_ONE: ALONE,
    f"<Simulator of {OF_TWO}: h = 0.01 s, 4 contacts, cone pyramid, backend clarabel>": SIMULATOR,
    f"<Simulator of {OF_ONE}: h = 0.01 s, 1 contact, cone pyramid, backend clarabel>": (
        qr.Simulator(ALONE, [pair(beta=ALONE.shapes[0], k=1)], h=0.01)
    ),
    "<StepProblem of 12 unknowns, 16 rows: h = 0.01 s, cone pyramid>": qr.StepProblem(STEP),
    "<Named of finger/base, block/base>": SYSTEM.named,
    "<ContactPair f: mu_v = 0.3, mu_omega = 0 m, 4 rows, k = 4>": pair(),
    "<Floating finger/base: actuated, 6 coordinates>": SYSTEM.joints[0],
    "<Kinematics of 2 links>": SYSTEM.kinematics(Q),
    "<StandardForm of 12 variables, 16 rows>": qr.standard_form(STEP),
    "<ExactQP: exact, 1 active row, obj -1.5152>": qr.exact_qp([[1.0]], [-2.0152], [[1.0]], [1.0]),
    "<SystemState at q = [0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 1.0]>": ALONE.at(ALONE.q_start),
    "<ClosestPoints of 4 contacts, phi from 0 m>": SIMULATOR.step(Q, Q_A).points,
}


@pytest.mark.parametrize("line", SHOWN)
def test_the_repr_of_a_public_object_fits_on_a_line(line):
    assert repr(SHOWN[line]) == line


def test_an_answer_says_whether_it_is_proved_and_shows_its_forces():
    solution = qr.solve_step(STEP)
    assert solution.proved
    assert not qr.solve_step(STEP, certify="residual").proved
    assert repr(solution.compliant).startswith("ContactForces(wrench=array(4, 4), delta_q=array(")

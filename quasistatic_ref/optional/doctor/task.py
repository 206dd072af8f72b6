"""Whether a run did what its scene was made for: the findings of the task."""

from collections.abc import Iterator
from functools import cached_property
from itertools import product

import numpy as np

from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.scene_notes import side
from quasistatic_ref.optional.doctor.start import bodies, joining
from quasistatic_ref.optional.doctor.telling import amount, length
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import Array, Mask
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.tolerances import BEYOND, FILLED, LAGS, SLIPPED, STALLED, SUNK

OPPOSITE = -0.5
"""Cosine of two normals that grip [-]."""
TWISTED = 0.1
"""Share of its torsion that a grip which turns away takes at least [-]."""
TURNED = 0.1
"""Turn of what a grip carries that counts as lost [rad]."""
HELD = 1e-12
"""What interpolation between equal waypoints leaves [m, rad, -]."""
TRIAL = 50
"""Steps of a run that may be a trial."""
LONG = 10.0
"""Time of a first waypoint over that of a run that does not come to it [-]."""
LOOKED = 8
"""Steps, spread over a run, in which bodies are looked for that pass through each other."""
WAYS = [np.array(way) / np.linalg.norm(way) for way in product((-1, 0, 1), repeat=3) if any(way)]
"""To the faces, edges and corners of a cube [-]."""
BALL = 1.15
"""Radius of a ball that holds a shape, over the distance of the farthest of its points in the WAYS:
no direction is more than 28 degrees from one of them [-]."""
IN_BOX = 1e-9
"""How far outside of the box about a shape its points may be by rounding [m]."""
MOST = 300
"""Pairs of shapes that are looked at."""
AT_ONCE = 500_000
"""Points that are looked at together: of more, memory would count."""


class Task:
    """A run, and who was to do what in it.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self.run = run
        self.trajectory = run.trajectory
        self.system = run.system
        self.pairs = run.pairs
        self.h = run.h
        self.steps = run.steps
        self.end = run.steps * run.h
        self.tracks = run.recorder.tracks
        self.accounts = run.pair_accounts
        moves = self.system.column_map.of_coordinates(self.system.column_map.moves)[:, 0] != 0
        self.driven = moves[:, : self.system.n_a].any(axis=1)
        self.free = moves[:, self.system.n_a :].any(axis=1) & ~self.driven

    @property
    def finished(self) -> bool:
        """Whether there are waypoints, and the run goes on to the last of them."""
        times = [float(track.times[-1]) for track in self.tracks]
        return bool(times) and max(times) <= self.end + self.h / 2

    @cached_property
    def tables(self) -> dict[str, list[int]]:
        """The pairs by which something driven acts on something free, by their tables."""
        found: dict[str, list[int]] = {}
        for i, pair in enumerate(self.pairs):
            links = [pair.alpha.link, pair.beta.link]
            if self.driven[links].any() and self.free[links].any():
                found.setdefault(self.accounts[i].table, []).append(i)
        return found

    @cached_property
    def grips(self) -> dict[str, Mask]:
        """Of each of :attr:`tables`, whether two contacts that touch face each other, (steps,)."""
        return {table: _grips(self, pairs) for table, pairs in self.tables.items()}

    def idle(self, table: str) -> bool:
        """Whether no pair of a table ever touched."""
        return not any(self.accounts[i].touches.any() for i in self.tables[table])

    def mu_omega(self, i: int) -> float:
        """Coefficient of torsion of a pair [m]; 0 of one without torsion."""
        pair = self.pairs[i]
        return pair.mu_omega if pair.rows == 6 else 0.0

    def size(self, i: int) -> float:
        """Extent of the smaller shape of a pair [m]."""
        shapes = (self.pairs[i].alpha.shape, self.pairs[i].beta.shape)
        return min(float(shape.extent) or np.inf for shape in shapes)

    def held(self, i: int) -> str:
        """What is free in a pair of :attr:`tables`."""
        pair = self.pairs[i]
        return self.accounts[i].alpha if self.free[pair.alpha.link] else self.accounts[i].beta

    def holder(self, i: int) -> str:
        """What is driven in it."""
        pair = self.pairs[i]
        return self.accounts[i].beta if self.free[pair.alpha.link] else self.accounts[i].alpha


def late(run: Run) -> Iterator[Finding]:
    """A run that ends long before the first waypoint at which something is to have moved.

    Who tries a scene takes its first steps alone: that is none.
    """
    task = Task(run)
    first: dict[str, float] = {}
    for track in task.tracks:
        moved = (track.values != track.values[0]).any(axis=1)
        if moved.any():
            first[track.joint.name] = float(track.times[moved.argmax()])
    if not first or task.steps < TRIAL or min(first.values()) < LONG * task.end:
        return
    joint = min(first, key=first.__getitem__)
    yield Finding(
        "late waypoints",
        True,
        "raise steps or h, or check the times of waypoints, which are in seconds",
        f"the run ends at {task.end:.4g} s ({task.steps} steps of {task.h:g} s), before the "
        f"first waypoint of {joint}, at {first[joint]:.4g} s",
        {"end_s": task.end, "waypoint_s": first[joint]},
    )


def still(run: Run) -> Iterator[Finding]:
    """Actuated joints that are to act on something, never reach it, and have nowhere to go."""
    task = Task(run)
    n = task.system.n_q_a
    targets = task.trajectory["q_bar_a"]
    idle = [table for table in task.tables if task.idle(table)]
    later = any((track.values != track.values[0]).any() for track in task.tracks)
    if not n or later or len(idle) < len(task.tables) or not idle:
        return
    if np.abs(targets - task.trajectory["q"][0, :n]).max() <= HELD:
        bodies = sorted({j.name.partition("/")[0] for j in task.system.joints if j.actuated})
        yield Finding(
            "no motion",
            True,
            "add targets, "
            + ("--targets" if run.system.of_mjcf else f"[[bodies.{bodies[0]}.targets]]"),
            f"all targets are where {listed(bodies)} starts, so that nothing is driven, and no "
            f"pair of contacts.{idle[0]} ever touches",
            {"steps": task.steps},
        )


def through(run: Run) -> Iterator[Finding]:
    """Bodies that come to be in each other and share no table: of each two the deepest."""
    task = Task(run)
    system = task.system
    shapes = {s.name: s for s in system.shapes}
    shapes |= {s.name: s for pair in task.pairs for s in (pair.alpha, pair.beta)}
    joined = {frozenset((_who(p.alpha), _who(p.beta))) for p in task.pairs}
    every = list(shapes.values())
    made = []
    for i, a in enumerate(every):
        for b in every[i + 1 :]:
            bodies = [system.links[s.link].partition("/")[0] for s in (a, b)]
            moved = task.driven[[a.link, b.link]] | task.free[[a.link, b.link]]
            if bodies[0] == bodies[1] or not moved.any() or frozenset((_who(a), _who(b))) in joined:
                continue
            made.append((a, b))
    if not made or len(made) > MOST:
        return
    points = {placed.name: _points(placed) for placed in every}
    radius = {
        name: BALL * float(np.linalg.norm(own, axis=1).max(initial=0.0))
        for name, own in points.items()
    }
    steps = np.unique(np.linspace(1, task.steps, LOOKED).round().astype(int)).tolist()
    at = [system.kinematics(task.trajectory["q"][k]) for k in (0, *steps)]
    R = np.array([kinematics.R for kinematics in at])
    t = np.array([kinematics.t for kinematics in at])
    depths = np.array([_depths(pair, points, radius, R, t) for pair in made])
    sizes = [min(float(s.shape.extent) or np.inf for s in pair) for pair in made]
    passed = (depths[:, :1] <= 0) & (depths[:, 1:] > SUNK * np.array(sizes)[:, None])
    said: dict[frozenset[str], Finding] = {}
    for i, j in np.argwhere(passed.T).tolist():
        k = steps[i]
        depth = float(depths[j, i + 1])
        names = [side(system, s) for s in made[j]]
        key = frozenset(name.partition("/")[0] for name in names)
        if key not in said or said[key].numbers["depth_mm"] < 1e3 * depth:
            said[key] = Finding(
                "passes through",
                True,
                joining(run, listed(names)) + ", or keep them apart",
                f"nothing lets them touch, and they pass through each other, {length(depth)} deep "
                f"at {k * task.h:.2f} s",
                {"depth_mm": 1e3 * depth, "step": k - 1},
            )
    yield from said.values()


def _who(placed: PlacedShape) -> str | int:
    """What a table joins: a link, or a shape of the world."""
    return placed.link or placed.name


def _depths(
    pair: tuple[PlacedShape, PlacedShape],
    points: dict[str, Array],
    radius: dict[str, float],
    R: Array,
    t: Array,
) -> Array:
    """How deep points of one shape are in the other at most, at some instants, (instants,) [m].

    Negative where they are apart. The links are at R, (instants, L, 3, 3), and t [m].
    """
    centres = [R[:, s.link] @ s.t + t[:, s.link] for s in pair]
    bounded = all(len(points[s.name]) for s in pair)
    apart = np.linalg.norm(np.subtract(*centres), axis=1) > sum(radius[s.name] for s in pair)
    near = np.flatnonzero(~(apart & bounded))
    depth = np.full(len(R), -np.inf)
    for of, inside in (pair, pair[::-1]):
        if isinstance(inside.shape, PointCloud) or not len(points[of.name]):
            continue
        own = points[of.name] @ of.R.T + of.t
        for k in np.array_split(near, 1 + near.size * len(own) // AT_ONCE):
            some = own
            if bounded:  # the WAYS along its axes lead to the faces of the box about it
                low = points[inside.name].min(axis=0)[:, None] - IN_BOX
                high = points[inside.name].max(axis=0)[:, None] + IN_BOX
                back = inside.R.T @ R[k, inside.link].mT
                away = back @ (t[k, of.link] - t[k, inside.link])[:, :, None]
                x = back @ R[k, of.link] @ own.T + away - (inside.R.T @ inside.t)[:, None]
                some = own[((low <= x) & (x <= high)).all(axis=1).any(axis=0)]
            if not len(some):
                continue
            x = some @ R[k, of.link].mT + t[k, None, of.link]
            x = (x - t[k, None, inside.link]) @ R[k, inside.link]
            x = (x - inside.t) @ inside.R
            phi = inside.shape.signed_distance(x.reshape(-1, 3))[0].reshape(x.shape[:2])
            depth[k] = np.maximum(depth[k], -phi.min(axis=1))
    return depth


def _points(placed: PlacedShape) -> Array:
    """Points of a shape, in its own frame, shape (n, 3) [m]: none of a half-space."""
    if isinstance(placed.shape, PointCloud):
        return placed.shape.points
    if not np.isfinite(placed.shape.extent):
        return np.zeros((0, 3))
    return np.array([placed.shape.support_point(way) for way in WAYS])


def idle(run: Run) -> Iterator[Finding]:
    """Tables by which something driven was to act on something free, and never did."""
    task = Task(run)
    if not task.finished:
        return
    for table, pairs in task.tables.items():
        others = (other for other in task.tables if other != table)
        acts = any(
            not task.idle(other) and task.held(task.tables[other][0]) == task.held(pairs[0])
            for other in others
        )
        if acts or not task.idle(table):
            continue
        i = min(pairs, key=lambda i: float(task.accounts[i].phi.min()))
        near = task.accounts[i]
        k = int(near.phi.argmin())
        least = float(near.phi[k])
        if least >= FILLED:
            apart = "none comes near enough to have a distance"
            numbers: dict[str, float] = {}
        else:
            apart = f"the nearest, {near.name}, is {length(least)} apart at "
            apart += f"{task.trajectory['t'][k]:.2f} s"
            numbers = {"least_distance_mm": 1e3 * least, "step": k}
        yield Finding(
            "idle contacts",
            True,
            f"check where {task.held(i)} stands and how far {task.holder(i)} moves",
            f"no pair of contacts.{table} ever touches; {apart}",
            numbers,
        )


def lost(run: Run) -> Iterator[Finding]:
    """Grips, contacts from opposite sides, along which what they hold slips by much."""
    task = Task(run)
    for table, pairs in task.tables.items():
        every = {i: slip for i in pairs if (slip := task.accounts[i].slip) is not None}
        if not (task.finished and _slips(task, pairs)):  # with and without a grip
            continue
        slips = {i: np.where(task.grips[table], slip, 0.0) for i, slip in every.items()}
        worst = max(slips, key=lambda i: float(slips[i].sum()) / task.size(i))
        way = float(slips[worst].sum())
        if way <= SLIPPED * task.size(worst):
            continue
        k = int(slips[worst].argmax())
        pressed, torque = _load(task, pairs, k)
        bears = task.pairs[worst].mu_v * pressed
        body = task.held(worst)
        weight = task.system.mass(body.partition("/")[0]) * task.run.g
        turning = task.mu_omega(worst) * pressed
        if weight < bears and torque > TWISTED * turning > 0:
            yield Finding(
                "lost grip",
                True,
                f"raise mu_omega of contacts.{table}, or hold {body} nearer to its centre of mass",
                f"{body} slips by {length(way)} along {task.holder(worst)} as it turns there; at "
                f"{task.trajectory['t'][k]:.2f} s torsion takes {torque:.3g} of the {turning:.3g} "
                f"N m that the grip could bear alone, and what is left does not hold {body}",
                {"slip_mm": 1e3 * way, "torque_Nm": torque, "bears_Nm": turning, "step": k},
            )
            continue
        yield Finding(
            "lost grip",
            True,
            f"raise mu_v of contacts.{table}, or K_q of what closes it or how far it closes",
            f"{body} slips by {length(way)} along {task.holder(worst)}; at "
            f"{task.trajectory['t'][k]:.2f} s the grip presses with {pressed:.3g} N in all, its "
            f"friction bears {bears:.3g} N, and {body} weighs {weight:.3g} N",
            {"slip_mm": 1e3 * way, "bears_N": bears, "weight_N": weight, "step": k},
        )


def turned(run: Run) -> Iterator[Finding]:
    """Grips in which what they alone carry turns by much, without much slip."""
    task = Task(run)
    for table, pairs in task.tables.items():
        every = {i: turn for i in pairs if (turn := task.accounts[i].turn) is not None}
        if not task.finished or not every:
            continue
        turns = {i: np.where(task.grips[table], turn, 0.0) for i, turn in every.items()}
        worst = max(turns, key=lambda i: float(turns[i].sum()))
        angle = float(turns[worst].sum())
        k = int(turns[worst].argmax())
        if angle <= TURNED or _slips(task, pairs) or not _carries(task, table, worst, k):
            continue
        pressed, torque = _load(task, pairs, k)
        turning = task.mu_omega(worst) * pressed
        if torque > TWISTED * turning > 0:
            body = task.held(worst)
            yield Finding(
                "lost grip",
                True,
                f"raise mu_omega of contacts.{table}, or hold {body} nearer to its centre of mass",
                f"{body} turns by {amount(angle, 'rad')} in {task.holder(worst)}; at "
                f"{task.trajectory['t'][k]:.2f} s torsion takes {torque:.3g} of the {turning:.3g} "
                f"N m that the grip could bear alone",
                {"turn_rad": angle, "torque_Nm": torque, "bears_Nm": turning, "step": k},
            )


def _slips(task: Task, pairs: list[int]) -> bool:
    """Whether a pair of a table slips by much in all."""
    slips = {i: slip for i in pairs if (slip := task.accounts[i].slip) is not None}
    return any(slip.sum() > SLIPPED * task.size(i) for i, slip in slips.items())


def _carries(task: Task, table: str, worst: int, k: int) -> bool:
    """Whether nothing but a table touches the body of one of its pairs in step k."""
    held = task.held(worst).partition("/")[0]
    others = (i for i, account in enumerate(task.accounts) if account.table != table)
    return not any(
        task.accounts[i].touches[k] and held in bodies(task.system, task.pairs[i]) for i in others
    )


def _load(task: Task, pairs: list[int], k: int) -> tuple[float, float]:
    """What a table presses with in step k [N], and the sum of its torsions [N m]."""
    names = {task.accounts[i].name for i in pairs}
    on = np.array([name in names for name in task.trajectory.pair_names])
    forces = task.run.forces(k)[on]
    return float(forces[:, 2].sum()), float(np.abs(forces[:, 3]).sum())


def _grips(task: Task, pairs: list[int]) -> Mask:
    names = {task.accounts[i].name for i in pairs}
    own = np.flatnonzero([name in names for name in task.trajectory.pair_names])
    touching = {task.accounts[i].name: task.accounts[i].touches for i in pairs}
    slots = task.trajectory.pair_names
    on = np.stack([touching[slots[j]] for j in own], axis=1)
    sign = {task.accounts[i].name: -1.0 if task.free[task.pairs[i].alpha.link] else 1.0
            for i in pairs}  # fmt: skip
    n = task.trajectory["n"][:, own] * np.array([sign[slots[j]] for j in own])[:, None]
    n = np.where(on[:, :, None], n, 0.0)
    faces = np.einsum("kix,kjx->kij", n, n).min(axis=(1, 2), initial=0.0)
    return np.asarray(faces < OPPOSITE)


def short(run: Run) -> Iterator[Finding]:
    """Joints that end far from their targets and are not stopped by what they press on."""
    task = Task(run)
    if not task.finished or not task.steps:
        return
    k = task.steps - 1
    q = task.trajectory["q"][-1]
    lag = task.system.actuated_difference(q, task.trajectory["q_bar_a"][-1])
    ways = {track.joint: float(np.ptp(track.values[:, 0])) for track in task.tracks
            if track.joint.v.stop == track.joint.v.start + 1}  # fmt: skip
    far = [joint for joint, way in ways.items() if way and abs(lag[joint.v.start]) > LAGS * way
           and not _at_a_stop(task, joint, q)]  # fmt: skip
    if not far:
        return
    contacts = task.run.contacts(k)
    J_n = frame_jacobian(contacts, contacts.J)[0][:, : task.system.n_a]
    pushes = task.run.forces(k)[:, 2:3] * J_n  # what each contact exerts on each joint
    spring = task.run.simulator.K_q @ lag
    for joint in far:
        v = joint.v.start
        error = abs(float(lag[v]))
        stopped = -np.sign(lag[v]) * pushes[:, v].sum() > abs(spring[v]) / 2
        unit = joint.coordinates[0].unit
        if stopped and not _stalled(task, int(np.abs(pushes[:, v]).argmax()), error, unit):
            continue
        needed = abs(float(spring[v])) / (LAGS * ways[joint])
        yield Finding(
            "far from target",
            True,
            f"raise K_q of {joint.name} to {needed:.2g} or more",
            f"it ends {amount(error, unit)} from its last target, with "
            f"{abs(spring[v]):.3g} {'N' if unit == 'm' else 'N m'} on its spring",
            {f"error_{unit}": error, "K_q": needed},
        )


def _at_a_stop(task: Task, joint: Joint, q: Array) -> bool:
    """Whether a joint is at a limit at which it stops, at q, shape (n_q,)."""
    if joint.limits is None or joint.v.start not in task.run.bounded:
        return False
    return bool(abs(q[joint.q] - joint.limits).min() <= BEYOND)


def _stalled(task: Task, contact: int, error: float, unit: str) -> bool:
    """Whether what a contact pushes has not moved, though the target is far inside of it."""
    name = task.trajectory.pair_names[contact]
    i = next(i for i, account in enumerate(task.accounts) if account.name == name)
    table = task.accounts[i].table
    if table not in task.tables or unit != "m" or error <= STALLED * task.size(i):
        return False
    if task.grips[table][-1]:
        return False
    pair = task.pairs[i]
    link = pair.alpha.link if task.free[pair.alpha.link] else pair.beta.link
    poses = [task.system.kinematics(task.trajectory["q"][k]).t[link] for k in (0, -1)]
    moved = float(np.linalg.norm(poses[1] - poses[0]))
    return moved < SUNK * task.size(i)


OF_TASK = (late, still, through, idle, lost, turned, short)
"""Causes come first."""

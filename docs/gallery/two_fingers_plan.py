"""
Two fingers plan by sampling
============================

Two fingers, balls on springs, turn a box by 0.6 rad. Before each step 200 pairs of targets are
drawn, and ``simulator.steps`` tries them all from one state; the best pair is taken. This needs no
slope, which a contact that opens does not have. The fingers start where they would turn the box the
other way, and walk to its other corners first.
"""

import time

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

goal, drawn, reach, size = 0.6, 200, 0.006, (0.05, 0.03, 0.02)
box = qr.Body.of_shape("box", qr.Box(size), mass=0.4, xyz=(0, 0, 0.02))
fingers = [
    qr.Body.of_shape(name, qr.Sphere(0.01), 0.1, base="planar", xyz=xyz, actuated=["base"])
    for name, xyz in {"left": (-0.03, -0.041, 0.02), "right": (0.03, 0.041, 0.02)}.items()
]
system = qr.System([*fingers, box])
floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
left, right, solid = system.shapes
pairs = [
    qr.ContactPair("floor", floor, solid, mu_v=0.3, mu_omega=0.0, rows=4, k=4),
    qr.ContactPair("left", left, solid, mu_v=0.5, mu_omega=0.0, rows=4),
    qr.ContactPair("right", right, solid, mu_v=0.5, mu_omega=0.0, rows=4),
]
# What is drawn need not be proved.
simulator = qr.Simulator(system, pairs, h=0.05, K_q=1000.0, backend="daqp", certify="off")


def place(q):
    """Where the box of configurations (N, n_q) is, (2, N) [m], and its angle [rad]."""
    x, y, _, _, _, sine, cosine = system.of(q, "box").T
    return np.array([x, y]), 2 * np.arctan2(sine, cosine)


def cost(q):
    """The angle to go [rad^2]; a centimetre of way counts as 0.1 rad; and fingers stay near."""
    at, angle = place(q)
    apart = [system.of(q, finger)[:, :2].T - at for finger in ("left", "right")]
    near = np.square(apart).sum(axis=(0, 1))
    return (goal - angle) ** 2 + 100 * np.square(at).sum(axis=0) + 0.1 * near


rng = np.random.default_rng(0)
states = [system.at(system.q_start)]
tried = {}
begin = time.process_time()
while abs(goal - place(states[-1].q[None])[1][0]) > 0.005 and len(states) < 100:
    targets = np.tile(states[-1].q[: system.n_q_a], (drawn, 1))
    targets[:, [0, 1, 4, 5]] += rng.uniform(-reach, reach, (drawn, 4))
    results = simulator.steps(states[-1], targets)
    best = int(np.argmin(cost(results.q)))
    tried[len(states)] = results.q, best
    states.append(system.at(results[best].q))
seconds = time.process_time() - begin
q = np.array([state.q for state in states])
at, angle = place(q)
count = drawn * len(tried)
print(f"{count} steps in {seconds:.1f} s turn the box by {angle[-1]:.3f} rad")
assert abs(angle[-1] - goal) < 0.005
assert np.abs(at[:, -1]).max() < 0.005

figure, (scene, samples, curve) = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained")
corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]]) * size[:2]
for k, style in ((0, ":"), (-1, "-")):
    c, s = np.cos(angle[k]), np.sin(angle[k])
    outline = 1e3 * (corners @ [[c, s], [-s, c]] + at[:, k])
    scene.plot(*outline.T, style, color="black", label=f"{angle[k]:.1f} rad")
for finger in ("left", "right"):
    scene.plot(*1e3 * system.of(q, finger)[:, :2].T, ".-", markersize=3, label=f"{finger} finger")
scene.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal", title="The fingers' ways")
scene.legend(fontsize=8)
k = 16
(way, turned), chosen = place(tried[k][0]), tried[k][1]
moved = 1e3 * np.hypot(*(way - at[:, k - 1 : k]))
samples.scatter(turned - angle[k - 1], moved, s=8, color="0.6", label="drawn")
samples.scatter(turned[chosen] - angle[k - 1], moved[chosen], marker="*", s=90, label="taken")
samples.set(xlabel="turn of the step [rad]", ylabel="way of the box [mm]")
samples.set_title(f"{drawn} steps from one state")
samples.legend(fontsize=8)
curve.plot(angle, color="black")
curve.axhline(goal, color="black", linestyle=":")
curve.set(xlabel="step", ylabel="angle of the box [rad]", title="It reaches its goal")
plt.show()

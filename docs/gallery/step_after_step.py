"""
Step after step
===============

A finger on a spring pushes a block along one axis. A run is a loop: the configuration q gives phi
and J, the program gives delta_q, and delta_q moves q on.

While the finger's target moves at v, the finger is m v / (h K_q) behind the target. Soon after the
target stops, finger and block stop. The force on the block is the drag m v / h, because each step
starts from rest.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

K_q, m, h, v, moves, gap = 500.0, 0.5, 0.02, 0.02, 1.2, 0.001

# %%
# The program of one step: delta_q is (finger, block), and the block is ahead of the finger.


def one_step(q, q_bar):
    """The answer at places q [m] to a target [m]."""
    ahead = qr.Contacts(
        name=("finger/block",), phi=[q[1] - q[0]], n=[[1, 0, 0]], d1=[[0, 1, 0]], d2=[[0, 0, 1]],
        J=[[[-1, 1], [0, 0], [0, 0], [0, 0]]], mu_v=[0.0], mu_omega=[0.0], rows=[4],
    )  # fmt: skip
    step = qr.StepData(
        h=h, K_q=[[K_q]], M_u=[[m]], tau_a=[0], tau_u=[0], delta_q_bar_a=[q_bar - q[0]],
        contacts=ahead,
    )  # fmt: skip
    return qr.solve_step(step)


# %%
# The loop.
times = np.arange(1, 121) * h
targets = v * np.minimum(times, moves)
q = [np.array([0.0, gap])]
force = []
for q_bar in targets:
    answer = one_step(q[-1], q_bar)
    q.append(q[-1] + answer.delta_q)
    force.append(answer.wrench[0, 2])
q = np.array(q)

lag = targets[59] - q[60, 0]
assert abs(lag - m * v / (h * K_q)) < 1e-9
assert abs(force[59] - m * v / h) < 1e-6
assert np.abs(np.diff(q[-5:], axis=0)).max() < 1e-11

figure, (axes, right) = plt.subplots(1, 2, figsize=(7.6, 3.2), layout="constrained")
for place, line, name in ((q[1:, 1], "--", "block"), (q[1:, 0], "-", "finger")):
    axes.plot(times, 1e3 * (targets - place), line, label=name)
axes.axhline(1e3 * lag, color="black", linestyle=":", label="m v / (h K_q)")
axes.set(xlabel="time t [s]", ylabel="behind the target [mm]")
axes.set_title("Both lag behind the target")
right.step(times, force, label="force")
right.axhline(m * v / h, color="black", linestyle=":", label="m v / h")
right.set(xlabel="time t [s]", ylabel="force [N]")
right.set_title("The force is the drag")
figure.legend(loc="outside lower center", ncols=5)
plt.show()

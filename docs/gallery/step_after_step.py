"""
Step after step
===============

A finger on a spring pushes a block along one axis. A run is a loop: where things are gives phi and
J, the program gives delta_q, and q goes on by it.

While the finger's target moves at v, the finger is m v / (h K_q) behind it. When the target stops,
so do both, soon after.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

K_q, m, h, v, moves, gap = 5000.0, 0.5, 0.01, 0.02, 1.2, 0.005

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
times = np.arange(1, 161) * h
targets = v * np.minimum(times, moves)
q = [np.array([0.0, gap])]
for q_bar in targets:
    q.append(q[-1] + one_step(q[-1], q_bar).delta_q)
q = np.array(q)

lag = targets[119] - q[120, 0]
assert abs(lag - m * v / (h * K_q)) < 1e-9
assert np.abs(np.diff(q[-5:], axis=0)).max() < 1e-12

figure, axes = plt.subplots(figsize=(4.8, 3.2), layout="constrained")
for name, place in {"target": targets, "finger": q[1:, 0], "block": q[1:, 1]}.items():
    axes.plot(times, 1e3 * place, {"target": ":", "finger": "-", "block": "--"}[name], label=name)
axes.set(xlabel="time t [s]", ylabel="x [mm]", title=f"the finger lags by {1e3 * lag:.1f} mm")
axes.legend()
plt.show()

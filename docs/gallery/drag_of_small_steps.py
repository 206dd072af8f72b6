"""
The drag of small steps
=======================

A plate on a spring pushes a block at one speed. The lag of the plate behind its target measures the
force: the friction mu_v m g, plus the drag m v / h, because each step starts from rest.

Drag over friction is the quasi-dynamic number v / (mu_v g h), which grows as steps shrink.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

m, mu_v, v, K_q, gravity = 0.5, 0.4, 0.01, 1e7, 9.81
time_steps = np.geomspace(0.5e-3, 0.1, 6)


def drag_over_friction(h):
    """What a steady push needs beyond friction, over friction [-]."""
    scenario = qr.load_scenario("block_push", [
        f"h={h}", "steps=15", f"contacts.floor.mu_v={mu_v}", f"bodies.pusher.K_q.slide={K_q}",
        "bodies.pusher.pose.xyz=[-0.06, 0, 0.05]",  # the plate touches the block
        f"bodies.pusher.targets=[{{t=0.0, slide=0.0}}, {{t=8.0, slide={8 * v}}}]",
    ])  # fmt: skip
    run = scenario.run(progress=False)
    force = K_q * (run.q_bar_a[-1, 0] - run.q[-1, 0])
    return force / (mu_v * m * gravity) - 1


drags = np.array([drag_over_friction(h) for h in time_steps])
formula = v / (mu_v * gravity * time_steps)
assert np.abs(drags / formula - 1).max() < 1e-3

figure, axes = plt.subplots(figsize=(4.5, 3.2), layout="constrained")
axes.loglog(1e3 * time_steps, formula, color="0.6", linewidth=3, label=r"$v / (\mu_v g h)$")
axes.loglog(1e3 * time_steps, drags, "ko", label="runs")
axes.axhline(0.1, color="black", linestyle=":", label="a tenth of friction")
axes.set(xlabel="time step h [ms]", ylabel="drag over friction [-]")
axes.set_title("Half the step, twice the drag")
figure.legend(loc="outside lower center", ncols=3)
plt.show()

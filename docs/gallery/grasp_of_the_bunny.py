"""
The grasp of the bunny
======================

After Figure 1 of the paper: a gripper lifts a bunny of 992 points, which it holds behind the centre
of mass. With torsional friction at the fingers the bunny does not turn in the hand. In the world it
turns by 0.2 degrees, as does the gripper, which leans on its springs. Without torsional friction
nothing resists a turn about the points by which the fingers hold it.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

closed, top = 0.7, 2.9  # when the grip is closed, and when the lift ends [s]
turns, histories, moments = {}, {}, []
for case, mu_omega in {"with torsion": None, "without torsion": 0}.items():
    changes = {} if mu_omega is None else {"contacts.grip.mu_omega": mu_omega}
    scenario = qr.load_scenario("bunny_grasp", changes, steps=290, fast=True)
    run = scenario.run(progress=False)
    moments.append(qr.figures.moment(scenario, run, -1))
    turn = np.degrees(qr.relative_turn(scenario.system, run, "bunny", "gripper", since=closed))
    time = np.append(0, run.t)
    lift = (time >= closed) & (time <= top)
    turns[case] = turn[lift].max()
    histories[case] = time[lift], turn[lift]

# %%
# The hand holds the bunny, or does not.
assert turns["with torsion"] < 1e-9
assert round(turns["without torsion"], 1) == 49.9

figure, panels = plt.subplots(1, 3, figsize=(8.5, 3.6), layout="constrained")
qr.draw_scenes(panels[:2], moments)
for axes, case in zip(panels, turns, strict=False):
    axes.set_title(case)
    panels[2].plot(*histories[case], label=f"{case}: {turns[case]:.1f} degrees")
panels[2].set(xlabel="time t [s]", ylabel="turn in the hand [deg]")
panels[2].set_ylim(-3, 68)  # room for the legend above the curve
panels[2].legend(loc="upper left", fontsize="x-small")
plt.show()

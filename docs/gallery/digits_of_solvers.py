"""
What "optimal" is worth
=======================

Solvers report success at each of these steps of the grasp, whatever accuracy they are asked for.
The certified optimum of a step says how many digits of their answers are right.

`solve_step` returns the certified optimum: the same bits for every solver.
"""

import matplotlib.pyplot as plt

import quasistatic_ref as qr

run = qr.load_scenario("bunny_grasp", steps=150, fast=True).run(progress=False)
steps = [run.step_data(k) for k in range(0, 150, 30)]
accuracies = (1e-3, 1e-6, 1e-9, 1e-12)
marks = {"clarabel": "o", "osqp": "s", "piqp": "^"}

answers, worst = {}, {}
for backend in marks:
    for accuracy in accuracies:
        answers[backend, accuracy] = [qr.solve_step(s, backend, accuracy=accuracy) for s in steps]
        digits = [float(a.statistics.digits) for a in answers[backend, accuracy]]
        worst[backend, accuracy] = min(digits)

# %%
# One answer for all of them; three digits where little was asked, seven or more at 1e-12.
for of_step in zip(*answers.values(), strict=True):
    assert len({answer.delta_q.tobytes() for answer in of_step}) == 1
assert max(worst[backend, 1e-3] for backend in marks) < 4
assert min(worst[backend, 1e-12] for backend in marks) >= 7

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
for backend, mark in marks.items():
    line = [worst[backend, accuracy] for accuracy in accuracies]
    axes.plot(accuracies, line, mark, linestyle="-", markeredgecolor="black", label=backend)
axes.set(xscale="log", ylim=(-0.5, 16.5), xlabel="accuracy that is asked for [-]")
axes.invert_xaxis()
axes.set(ylabel="correct digits, worst step [-]", title='All of these answers are called "optimal"')
axes.legend()
plt.show()

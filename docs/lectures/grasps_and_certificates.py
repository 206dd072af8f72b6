"""Lesson 5: what a grip holds, and what a certificate proves

Two fingers hold a bar; an answer comes with a proof, and a wrong one is found out.
"""

# %% setup

import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.certify.certificate import verify
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.step.standard_form import standard_form

STEP = pinch_step(5.0, 0.05, 0.5, 0.02)  # squeeze [N], lever [m], mu_v, mu_omega [m]
ANSWER = qr.solve_step(STEP)


def proved(delta_q, lam, active):
    return bool(verify(STEP, delta_q, active, lam, ANSWER.certificate))


ACTIVE = ANSWER.certificate.active
FORGED = {
    "a": (ANSWER.delta_q, ANSWER.lam),
    "b": (ANSWER.delta_q + np.eye(8)[4] * 1e-12, ANSWER.lam),
    "c": (ANSWER.delta_q, ANSWER.lam * 1.001),
}

# %% task
"""(R14): the longest lever [m] at which fingers that press with N each hold a bar of mass m."""


def longest_lever(N, m, mu_v, mu_omega):
    return 0.0


# %% answer
def longest_lever(N, m, mu_v, mu_omega):
    return mu_omega * (2 * N / (m * 9.81) - 1 / mu_v)


# %% check
def slips(N, lever):
    return np.abs(qr.solve_step(pinch_step(N, lever, 0.5, 0.02, m=0.2)).delta_q[2:]).max() > 1e-12


check(
    "lever",
    lambda: all(
        slips(N, 1.001 * longest_lever(N, 0.2, 0.5, 0.02))
        and not slips(N, 0.999 * longest_lever(N, 0.2, 0.5, 0.02))
        for N in (3.0, 5.0)
    ),
)

# %% task
"""Residuals of the optimality conditions of (13), with H, g, A, b of `standard_form` in floats: how
much H delta_q - g - A' lam differs from zero, the least slack, the least multiplier, and the
largest product of a slack and its multiplier."""


def residuals(form, delta_q, lam):
    return 1.0, -1.0, -1.0, 1.0


# %% answer
def residuals(form, delta_q, lam):
    slack = form.A @ delta_q - form.b
    balance = np.abs(form.H @ delta_q - form.g - form.A.T @ lam).max()
    return balance, slack.min(), lam.min(), np.abs(slack * lam).max()


# %% check
def good(found):
    balance, slack, multiplier, product = found
    return balance < 1e-12 and slack > -1e-12 and multiplier > -1e-12 and product < 1e-12


check(
    "residuals",
    lambda: (
        good(residuals(standard_form(STEP), ANSWER.delta_q, ANSWER.lam))
        and residuals(standard_form(STEP), ANSWER.delta_q, 1.001 * ANSWER.lam)[0] > 1e-6
        and residuals(standard_form(STEP), ANSWER.delta_q - 1e-3 * np.eye(8)[0], ANSWER.lam)[0]
        > 1e-6
    ),
)

# %% task
"""One of the answers of FORGED is right, two have a mistake. Write down which is right, and of each
other what is wrong with it: "delta_q" or "lam". (A difference of 1e-12 m is below every tolerance
of a solver; `proved` is exact.)"""
verdict = {"a": "", "b": "", "c": ""}

# %% answer
verdict = {"a": "right", "b": "delta_q", "c": "lam"}

# %% check
check(
    "mistakes",
    lambda: (
        verdict
        == {
            name: "right"
            if proved(delta_q, lam, ACTIVE)
            else ("lam" if np.array_equal(delta_q, ANSWER.delta_q) else "delta_q")
            for name, (delta_q, lam) in FORGED.items()
        }
        and proved(*FORGED["a"], ACTIVE)
    ),
)

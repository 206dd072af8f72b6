"""Grasps in the ellipsoid: second-order cones, for solvers that take them."""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.lab.study.problems.families.short import (
    framed,
    short_step,
    shortened,
    with_axes,
)
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm

BITS = 32
"""Of a row of a cone: J's 24, and friction's 8."""


def round_grasp(rng: Rng, contacts: float) -> StepData:
    """A grasp of so many `contacts` [-], a third of them with the floor, friction being 1."""
    n_c = round(contacts)
    step = with_axes(rng, short_step(grasp_step(rng, grip=n_c - n_c // 3, floor=n_c // 3)))
    c = step.contacts
    mu = np.column_stack([c.mu_v, c.mu_v, np.ones(n_c), np.where(c.rows == 6, c.mu_omega, 0.0)])
    J = shortened(mu[:, :, None] * c.J, BITS)
    contacts_ = framed(J, c.phi, 1.0, 1.0, 6)
    return step.replace(contacts=contacts_, cone=ELLIPSOID)


def cone_rows(step: StepData) -> tuple[StandardForm, int]:
    """H, g and blocks of four rows (A x - b)_0 >= |(A x - b)_1:3|, and how many blocks.

    Parameters
    ----------
    step : StepData
        In the ellipsoid, friction being 1: nothing is then rounded.
    """
    c = step.contacts
    A = c.J[:, [2, 0, 1, 3]].reshape(-1, step.n_v)
    b = np.zeros((c.n_c, 4))
    b[:, 0] = -c.phi
    tau_k = step.K_q @ step.delta_q_bar_a  # Eq. (1)
    g = step.h * np.concatenate([tau_k + step.tau_a, step.tau_u])
    return StandardForm(step.H, g, A, b.ravel() + 0.0), c.n_c

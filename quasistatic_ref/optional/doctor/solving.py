"""How the steps of a run were solved: failing backends, uncertain forces, and time of proofs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from math import log10
from typing import TYPE_CHECKING, Final

import numpy as np

from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.run import Run, RunStep
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.solve.backends import NONE, QPSOLVERS
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from quasistatic_ref.step.solution import ContactForces, ForcesOfStep

BORNE: Final = 1e-4
"""Share of the load [-] that forces of single contacts may leave without a finding."""

SURE: Final = 1e-3
"""Share of the load of a group [-] that noise in its gaps may change without a finding."""

WORTH = 10.0
"""Least time of a run whose proofs are named [s]."""
SHARE = 0.8
"""Of the time of such a run, above which its proofs are named [-]."""


def backend_failures(run: Run) -> Iterator[Finding]:
    """Steps whose exact optimum the backend missed.

    An accuracy of 10^-2k gives k digits of delta_q: by strong convexity the error is the square
    root of twice the gap.
    """
    simulator = run.simulator
    digits = run["digits"]  # NaN without an answer, or where the optimum is not known
    unanswered = np.zeros(run.steps, dtype=bool)
    unanswered[list(run.trajectory.header.unanswered)] = True
    wanted = -log10(simulator.accuracy) / 2
    if not cone(simulator.cone).polyhedral:
        wanted = 0.0  # an enclosure may be no nearer than the answer
    failed = int(unanswered.sum())
    short = int((digits < wanted).sum())
    if simulator.backend == NONE or not failed + short:
        return
    missed = unanswered | (digits < wanted)
    first = int(np.flatnonzero(missed)[0])
    exact = (run["certificate"][missed] == "exact").all()
    other = "the exact method" if exact else "another backend or the exact method"
    others = ("clarabel", "daqp") if cone(simulator.cone).polyhedral else ("clarabel", "scs")
    able = [name for name in others if _solves(run, name, first, wanted)]
    remedy = f"choose another backend than {simulator.backend}, such as {' or '.join(able)}"
    if not able:
        remedy = "check masses, lengths and stiffness, or leave the steps to the exact method"
    errors = f"failed in {failed} of {run.steps} steps" if failed else ""
    fewer = f"had fewer than the {wanted:g} digits that were asked for in {short}" if short else ""
    yield Finding(
        "failing-backend",
        True,
        remedy,
        f"{simulator.backend} {' and '.join(filter(None, (errors, fewer)))}, the first of them "
        f"step {first}; {other} solved them",
        {"failed": failed, "short": short, "step": first},
    )


def _solves(run: Run, name: str, k: int, digits: float) -> bool:
    """Whether a backend is not the run's, and has some digits of step k if that may be solved."""
    failed = run.simulator.backend.removeprefix(QPSOLVERS)
    if name == failed or not run.searched:
        return name != failed
    with suppress(QuasistaticError):
        solved = solve_step(run.at(k).step, name, accuracy=run.simulator.accuracy).statistics
        return solved.digits is not None and solved.digits >= digits
    return False


def proofs(trajectory: Trajectory) -> Iterator[Finding]:
    """A run that was proved in full, and could have had residuals alone in less time."""
    proved = np.isin(trajectory["certificate"], ("exact", "enclosure")).any()
    if not proved or trajectory.header.law != CONVEX:
        return
    total = sum(float(seconds.sum()) for seconds in trajectory.seconds.values())
    proof = float(trajectory.seconds["proof"].sum())
    if total > WORTH and proof > SHARE * total:
        yield Finding(
            "time-of-proof",
            False,
            'take certify = "residual", which judges each step by its residuals in less time',
            f"proofs took {proof:.0f} s of the {total:.0f} s of these steps",
            {"proof_s": proof, "total_s": total},
            "run",
        )


def unborne(run: Run) -> Iterator[Finding]:
    """What compliant forces leave of the loads, and how much rounding changes them.

    What a last bit of the places of contacts may change in forces is that of the same step: next to
    a load that is rounding, any change is large.
    """
    pressing = run["wrench"][:, :, 2].sum(axis=1)
    k = int(pressing.argmax())
    if pressing[k] <= SURE * run.g * run.system.masses.sum():  # nothing bears anything
        return
    compliant = run.at(k).compliant
    if compliant is None:
        return
    if compliant.imbalance > BORNE:
        yield Finding(
            "uncertain-forces",
            False,
            "read wrench in the place of forces, or raise mu_v or mu_omega",
            f"forces of single contacts leave {compliant.imbalance:.1e} of the load",
            {"left": compliant.imbalance},
            "forces",
        )
    bits = np.spacing(np.abs(run["beta"][k]).max(axis=1))
    bit = float(bits.max(initial=0.0))
    if compliant.sensitivity * bit <= SURE:  # a bound
        return
    noise = _noise(run.at(k), compliant, bits)
    if noise > SURE:
        yield Finding(
            "uncertain-forces",
            False,
            "read the sum of forces of each pair in the place of single ones, or take a softer K_q",
            f"rounding of a gap, by {bit:.1e} m, changes forces of single contacts by {noise:.1e} "
            "of the largest of their group",
            {"noise": noise},
            "forces",
        )


def _noise(at: RunStep, compliant: ContactForces, bits: Array) -> float:
    """How much forces change if each gap changes by part of a bit, relative to the largest.

    Of each group of contacts that share coordinates, the most [-].
    """
    step = at.step
    off = bits * np.random.default_rng(0).uniform(-1.0, 1.0, len(bits))
    raised = step.replace(contacts=step.contacts.raised(off))
    contact_forces: ForcesOfStep = part("contact_forces")
    changed = contact_forces(raised, None, at.near).wrench
    change = np.abs(changed - compliant.wrench)
    groups = [group.contacts for group, _ in group_steps(step)]
    shares = [
        change[of].max(initial=0.0) / np.abs(compliant.wrench[of]).max(initial=0.0)
        for of in groups
        if compliant.wrench[of].any()
    ]
    return float(max(shares, default=0.0))

"""Systems, simulators, step results, scenarios and trajectories in words: ``repr``, notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.show.show import Page, Row, counted, direction, number, vector
from quasistatic_ref.optional.show.step_words import (
    CONTACT,
    FORCE,
    bearing_first,
    certificate_facts,
    contact_rows,
    force_rows,
)

if TYPE_CHECKING:
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.scenario.scenario import Scenario
    from quasistatic_ref.simulate.recorder import Recorder
    from quasistatic_ref.simulate.result import StepResult
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.trajectory import Trajectory

NOT_IN_TEXT = (CONTACT[2], *FORCE[:2])
"""Columns for which a line has no room."""
PAIR = ("pair", "contacts", "mu_v", "mu_omega [m]", "rows")


def pair_rows(pairs: Sequence[ContactPair]) -> list[Row]:
    """Of each pair: its name, number of contacts and friction."""
    return [
        (pair.name, str(pair.n_c), number(pair.mu_v), number(pair.mu_omega), str(pair.rows))
        for pair in pairs
    ]


def result_page(result: StepResult) -> Page:
    """One step that was taken: gap, normal, force and active rows of each contact."""
    step = result.step
    certificate = result.solution.certificate
    title = (
        f"StepResult: {counted(step.n_v, 'coordinate')}, {counted(step.contacts.n_c, 'contact')}, "
        f"certificate: {certificate.kind}, {1e3 * sum(result.seconds.values()):.3g} ms"
    )
    each = zip(contact_rows(step.contacts), force_rows(result.solution), strict=True)
    rows = [(*contact[:3], *force) for contact, force in each]
    shown = bearing_first(rows, result.solution.wrench[:, 2])
    return title, certificate_facts(certificate), (*CONTACT[:3], *FORCE), shown


def recorder_page(recorder: Recorder) -> Page:
    """What was recorded so far."""
    title = (
        f"Recorder: {counted(recorder.steps, 'step')} of {recorder.h:g} s, record {recorder.record}"
    )
    return title, [f"backend {recorder.backend}, cone {recorder.cone}"], (), ()


def simulator_page(simulator: Simulator) -> Page:
    """What steps, and how each step is solved."""
    title = f"Simulator: h = {simulator.h:g} s, {_size(simulator)}"
    return title, [path_words(simulator)], PAIR, pair_rows(simulator.pairs)


def scenario_page(scenario: Scenario) -> Page:
    """What a scenario file comes to."""
    title = (
        f"Scenario {scenario.path.stem}: {counted(scenario.steps, 'step')} of {scenario.h:g} s, "
        f"{_size(scenario)}"
    )
    facts = [
        f"file {scenario.path}",
        f"bodies: {', '.join(body.name for body in scenario.system.bodies)}",
        f"{path_words(scenario)}, record {scenario.record}",
    ]
    return title, facts, PAIR, pair_rows(scenario.pairs)


def path_words(of: Simulator | Scenario) -> str:
    """How each step of a simulator or a scenario is solved, in words."""
    return (
        f"backend {of.backend}, {'fast' if of.fast else 'plain'} path, certify {of.certify}, cone "
        f"{of.cone}, gravity {vector(of.gravity)} m/s^2"
    )


def _size(of: Simulator | Scenario) -> str:
    """How many coordinates, pairs and contacts there are."""
    n_c = sum(pair.n_c for pair in of.pairs)
    return (
        f"{counted(of.system.n_v, 'coordinate')} ({of.system.n_a} actuated), "
        f"{counted(len(of.pairs), 'pair')} with {counted(n_c, 'contact')}"
    )


def trajectory_page(trajectory: Trajectory) -> Page:
    """A run: how far it went, what of it is proved, and its contacts in the last step."""
    from quasistatic_ref.simulate.trajectory import certified  # which needs pinocchio

    header = trajectory.header
    steps = trajectory.steps
    ended = "complete" if trajectory.failed is None else "ended early"
    title = (
        f"Trajectory: {counted(steps, 'step')} of {header['h']:g} s, {ended}; "
        f"{counted(trajectory['q'].shape[-1], 'entry')} of q, "
        f"{counted(np.size(trajectory['mu_v']), 'contact')}"
    )
    facts = [] if trajectory.failed is None else [f"why it ended: {trajectory.failed}"]
    facts += [
        f"{certified(trajectory)}; backend {header.get('backend')}, cone {header.get('cone')}, "
        f"record {header['record']}",
        f"largest quasi-dynamic number {number(header.get('quasi_dynamic_number'))}, largest "
        f"boundary layer {number(header.get('largest_boundary_layer'))} m",
        f"arrays: {', '.join(trajectory.arrays)}",
    ]
    facts += [f"finding: {finding}" for finding in trajectory.findings]
    n_c = np.size(trajectory["mu_v"])
    shapes = {"phi": (), "n": (3,), "wrench": (4,)}
    fits = (trajectory[key].shape == (steps, n_c, *last) for key, last in shapes.items())
    if not (steps and all(fits)):  # no steps, or a file that another program wrote
        return title, facts, (), ()
    names = header["contacts"][-1] if header["contacts"] else ()
    names = names if len(names) == n_c else range(n_c)
    try:
        forces = trajectory.step_forces(steps - 1)
    except InputError:  # of a light record: those of the proof
        forces = trajectory["wrench"][-1]
    rows = [
        (str(name), number(phi), direction(n), *map(number, of_contact))
        for name, phi, n, of_contact in zip(
            names, trajectory["phi"][-1], trajectory["n"][-1], forces, strict=True
        )
    ]
    shown = bearing_first(rows, forces[:, 2])
    return title, facts, ("contact, last step", *CONTACT[1:3], *FORCE[:4]), shown

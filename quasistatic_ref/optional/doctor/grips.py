"""Grips: what is held from opposite sides by what is driven, and what its contacts lack."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.blocks import entries_of
from quasistatic_ref.optional.doctor.bodies import COUNTS, Body, Missing
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.scenes import Scene
from quasistatic_ref.optional.doctor.start import friction_of, least_mean, table
from quasistatic_ref.optional.doctor.stopped import missing
from quasistatic_ref.optional.doctor.telling import amount, length
from quasistatic_ref.optional.doctor.tolerances import SLIPPED
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.standard_form import frame_jacobian

CLOSED = 0.45
"""Length of the least mean of normals, with weights, of a grip that is closed [-]."""
TURNED = 0.1
"""Turn of what a grip holds that counts as lost [rad]."""
AGREES = 0.5
"""Cosine between what is missing and the way of what slips from which they agree [-]."""


def lost(run: Run) -> Iterator[Finding]:
    """Findings on bodies that slip or turn by much in everything that grips them.

    The contacts of what is driven are asked alone: a grip is lost if they do not bear the body's
    loads, and what is missing is along the way by which the body slips.
    """
    of_pairs = [run.driven[p.alpha.link] or run.driven[p.beta.link] for p in run.pairs]
    driven = np.array(of_pairs, dtype=bool)[run.pair_of]
    grips = driven & run.touches
    every_slip = np.where(grips, np.linalg.norm(run.slips[..., :2], axis=2), 0.0)
    every_turn = np.where(grips, np.abs(run.noted("moved")[..., 3]), 0.0)
    for body in run.bodies_of:
        on = body.contacts & grips
        slips = np.where(on, every_slip, 0.0)
        turns = np.where(on, every_turn, 0.0)
        if not _slips(run, slips, turns):
            continue
        closed = np.array([_closed(n[here]) for n, here in zip(run["n"], on, strict=True)])
        slips = slips * closed[:, None]
        turns = turns * closed[:, None]
        if not _slips(run, slips, turns):
            continue
        scores = (slips / run.sizes / SLIPPED + turns / TURNED).max(axis=1)
        k = int(scores.argmax())
        alone = body.contacts & driven
        answer = missing(run, k, [body], contacts=alone).get(body)
        lacks = answer if isinstance(answer, Missing) else None
        agrees = lacks is not None and _agreement(run, body, k, on[k], lacks) > AGREES
        if not agrees and (run.touches[k] & body.contacts & ~driven).any():
            continue  # it is stroked, and others bear it
        normal = _normal(run, k, alone)
        yield _finding(run, body, k, on[k], normal, lacks, answer is None, slips, turns)


def _slips(run: Run, slips: Array, turns: Array) -> bool:
    """Whether any contact slips, (steps, n_c) [m], or turns, (steps, n_c) [rad], by much."""
    way = (slips.sum(axis=0) / run.sizes).max(initial=0.0)
    return bool(way > SLIPPED or turns.sum(axis=0).max(initial=0.0) > TURNED)


def _closed(n: Array) -> bool:
    """Whether normals, (n_c, 3), nearly cancel with weights >= 0 of sum 1."""
    if len(n) < 2 or (n @ n.sum(axis=0)).min() > CLOSED * np.linalg.norm(n.sum(axis=0)):
        return False  # all of them have that much along their mean
    return least_mean(n) < CLOSED


def _agreement(run: Run, body: Body, k: int, on: Mask, lacks: Missing) -> float:
    """Cosine between a body's first acceleration and its way over what grips it [-]."""
    contacts = run.at(k).contacts
    _, *J_t = frame_jacobian(contacts, contacts.J)
    rows = np.concatenate([J[on] for J in J_t])[:, body.coordinates]
    seen = np.concatenate([*run.slips[k, on, :2].T, run.noted("moved")[k, on, 3]])
    v = np.linalg.lstsq(rows, seen, rcond=1e-9)[0]
    M = body.inertia(partial(entries_of, run.at(k).step.hessian.masses), run.system.n_a)
    starts = np.linalg.solve(M, -lacks.r)
    sizes = float(np.sqrt((starts @ M @ starts) * (v @ M @ v)))
    return float(starts @ M @ v) / sizes if sizes > 0 else 0.0


def _normal(run: Run, k: int, contacts: Mask) -> Array:
    """Normal forces of some contacts alone in step k by Coulomb's law, (n_c,) [N].

    What the layer adds is none of the grip; where no fixed point is found it is not left out.
    """
    normal = run["wrench"][k, :, 2].copy()
    scene = Scene(run, k, run["q"][k], run["phi"][k], run.points_of(k), contacts=contacts)
    for slow in scene.parts:
        every = slow.every
        one = slow.rung(np.full(len(every), run.h), slow.level(every), every)
        normal[slow.groups.contacts[one.found]] = one.forces[one.found][..., 2]
    return normal


def _finding(
    run: Run,
    body: Body,
    k: int,
    on: Mask,
    normal: Array,
    lacks: Missing | None,
    held: bool,
    slips: Array,
    turns: Array,
) -> Finding:
    pairs = sorted({int(i) for i in run.pair_of[on]})
    tables = " and ".join(sorted({table(run, run.pairs[i]) for i in pairs}))
    holders = " and ".join(dict.fromkeys(run.held_by(i)[1] for i in pairs))
    way = float(slips.sum(axis=0).max())
    turn = float(turns.sum(axis=0).max())
    pressed = float(normal[on].sum())
    says = f"the grip presses with {pressed:.3g} N in all, "
    more = ", which holds it once targets stop" if held else ""
    more = more if lacks is None else f", and {lacks} are missing"
    slipped = way > SLIPPED * float(run.sizes[on].min())
    if turn > TURNED and (not slipped or (lacks is not None and lacks.turning > COUNTS)):
        six = "condim 4" if run.system.of_mjcf else "rows = 6"
        rows = "" if all(run.pairs[i].rows == 6 for i in pairs) else f" ({six})"
        remedy = f"raise {friction_of(run, 'mu_omega', tables)}{rows}, or hold {body.name} nearer "
        remedy += "to its centre of mass"
        does = f"turns by {amount(turn, 'rad')} in {holders} and slips by {length(way)}"
        says += f"mu_omega bears {float(normal[on] @ run.mu[on, 2]):.3g} N m"
    else:
        remedy = f"raise {friction_of(run, 'mu_v', tables)}, or K_q of what closes it or how far "
        remedy += "it closes"
        does = f"slips by {length(way)} along {holders}"
        says += f"its friction bears {float(normal[on] @ run.mu[on, 0]):.3g} N"
    return Finding(
        "lost-grip",
        True,
        f"move more slowly, or {remedy}" if held else remedy,
        f"{body.name} {does}; at {run['t'][k]:.2f} s {says}{more}",
        {
            "slip_mm": 1e3 * way,
            "turn_rad": turn,
            "presses_N": pressed,
            "missing_N": 0.0 if lacks is None else lacks.force,
            "missing_Nm": 0.0 if lacks is None else lacks.torque,
            "step": k,
        },
    )

"""Grips: what is held from opposite sides by what is driven, and what is missing of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.added import layers
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import friction_of, least_mean, table
from quasistatic_ref.optional.doctor.telling import amount, length
from quasistatic_ref.optional.doctor.tolerances import SLIPPED
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.standing import Standing, Standings

CLOSED = 0.45
"""Length of the least mean of normals, with weights, of a grip that is closed [-]."""
TURNED = 0.1
"""Turn of what a grip holds that counts as lost [rad]."""
STICKS = 0.1
"""Part of a slip in a step that is left where the step is taken slowly [-], of what sticks."""
AGREES = 0.5
"""Cosine between a slip and what is missing against it from which they agree [-]."""
LIGHT = 0.01
"""Force that is none, over a body's weight [-]."""
PRESSES = 1e-3
"""Normal force that grips, over the largest of the run [-]: less is a solver's noise."""


def lost(run: Run) -> Iterator[Finding]:
    """Findings on bodies that slip or turn by much in everything that grips them.

    A grip is lost if something is missing of the body, all contacts being asked; if it slips away
    from where others bear it, and not the grip; or if it would stick were the step taken slowly.
    What is wiped while it is held, or turns as it is meant to, slips slowly as well.
    """
    f_n = run["wrench"][..., 2]
    grips = run.touches & (f_n > PRESSES * f_n.max(initial=0.0))
    every_slip = np.where(grips, np.linalg.norm(run.slips[..., :2], axis=2), 0.0)
    every_turn = np.where(grips, np.abs(run.noted("moved")[..., 3]), 0.0)
    for name, held in _held(run).items():
        on = held & grips
        slips, turns = np.where(on, every_slip, 0.0), np.where(on, every_turn, 0.0)
        if not _slips(run, slips, turns):
            continue
        closed = np.array([_closed(n[here]) for n, here in zip(run["n"], on, strict=True)])
        slips, turns = slips * closed[:, None], turns * closed[:, None]
        if not _slips(run, slips, turns):
            continue
        scores = (slips / run.sizes / SLIPPED + turns / TURNED).max(axis=1)
        k = int(scores.argmax())
        sticks = _would_stick(run, k, on[k])
        lacks = None if sticks else _missing(run, k, name, on[k], held)
        if lacks or sticks:
            yield _finding(run, name, k, on[k], lacks, slips, turns)


def _missing(run: Run, k: int, name: str, on: Mask, held: Mask) -> Standing | None:
    """What is missing of a body the way that it slips: by all contacts, or by its grip alone."""
    others = run.of_body(name) & ~held
    masks = [None, ~others] if run.touches[k, others].any() else [None]
    for only in masks:
        lacks = _lacking(run, k, name, only)
        if lacks and _agrees(run, k, name, on, lacks):
            return lacks
    return None


def _held(run: Run) -> dict[str, Mask]:
    """By free bodies, which contacts they have with what is driven, shape (n_c,)."""
    held: dict[str, Mask] = {}
    for i, pair in enumerate(run.pairs):
        for one, other in ((pair.alpha, pair.beta), (pair.beta, pair.alpha)):
            if run.free[one.link] and run.driven[other.link]:
                name = run.body(one.link)
                held[name] = held.get(name, False) | (run.pair_of == i)
    return held


def _slips(run: Run, slips: Array, turns: Array) -> bool:
    """Whether any contact slips, (steps, n_c) [m], or turns, (steps, n_c) [rad], by much."""
    way = (slips.sum(axis=0) / run.sizes).max(initial=0.0)
    return bool(way > SLIPPED or turns.sum(axis=0).max(initial=0.0) > TURNED)


def _closed(n: Array) -> bool:
    """Whether normals, (n_c, 3), nearly cancel with weights >= 0 of sum 1."""
    if len(n) < 2 or (n @ n.sum(axis=0)).min() > CLOSED * np.linalg.norm(n.sum(axis=0)):
        return False  # all of them have that much along their mean
    return least_mean(n) < CLOSED


def _agrees(run: Run, k: int, name: str, on: Mask, lacks: Standing) -> bool:
    """Whether a body slips through its grip the way that nothing bears it."""
    if lacks.missing_Nm:
        return True
    if lacks.missing_N < LIGHT * run.system.mass(name) * run.g:
        return False
    of_beta = [run.body(pair.beta.link) == name for pair in run.pairs]
    signs = np.where(np.array(of_beta)[run.pair_of], 1.0, -1.0)
    way = (signs[on, None] * run.noted("moved")[k, on, :3]).sum(axis=0)
    return bool(-way @ lacks.direction[:3] > AGREES * np.linalg.norm(way))


def _lacking(run: Run, k: int, name: str, only: Mask | None) -> Standing | None:
    """What a body lacks after step k, if anything, by all contacts or some: a free one at once."""
    stands: Callable[..., Standings] = part("stands")
    kept: Callable[..., Array] = part("kept_loads")
    q = run["q"][k + 1]
    force = kept(run.simulator, run["q"][k], q, run.noted("tau")[k])
    rows = stands(run.simulator, q, run["q_bar_a"][k], force, "off", name in run.free_bases, only)
    own = [row for row in rows if row.body.partition("/")[0] == name]
    lacks = [row for row in own if row.stands is False]
    return lacks[0] if lacks else None


def _would_stick(run: Run, k: int, on: Mask) -> bool:
    """Whether some contacts would not slip, if step k were taken slowly."""
    slow: Callable[..., Any] = part("slow_step")
    step = run.at(k).posed
    with suppress(QuasistaticError):
        moved = step.contacts.motion(slow(step, max(1.0, 100 * run.h)).delta_q)[on]
        n = step.contacts.n[on]
        along = moved[:, :3] - np.vecdot(moved[:, :3], n)[:, None] * n
        ways = np.linalg.norm(along, axis=1), np.abs(moved[:, 3])
        here = np.linalg.norm(run.slips[k, on, :2], axis=1), np.abs(run.noted("moved")[k, on, 3])
        return all((way <= STICKS * now.max()).all() for way, now in zip(ways, here, strict=True))
    return False


def _finding(
    run: Run, name: str, k: int, on: Mask, lacks: Standing | None, slips: Array, turns: Array
) -> Finding:
    pairs = sorted({int(i) for i in run.pair_of[on]})
    tables = " and ".join(sorted({table(run, run.pairs[i]) for i in pairs}))
    holders = " and ".join(dict.fromkeys(run.held_by(i)[1] for i in pairs))
    way = float(slips.sum(axis=0).max())
    turn = float(turns.sum(axis=0).max())
    normal = np.maximum(run["wrench"][k, on, 2] - layers(run)[k, on], 0.0)
    pressed = float(normal.sum())
    says = f"the grip presses with {pressed:.3g} N in all, "
    more = ", which holds it if it moves slowly"
    if lacks:
        more = f", and {lacks.words} are missing"
    slipped = way > SLIPPED * float(run.sizes[on].min())
    if turn > TURNED and (not slipped or (lacks is not None and lacks.missing_Nm)):
        six = "condim 4" if run.system.of_mjcf else "rows = 6"
        rows = "" if all(run.pairs[i].rows == 6 for i in pairs) else f" ({six})"
        remedy = f"raise {friction_of(run, 'mu_omega', tables)}{rows}, or hold {name} nearer "
        remedy += "to its centre of mass"
        does = f"turns by {amount(turn, 'rad')} in {holders} and slips by {length(way)}"
        says += f"mu_omega bears {float(normal @ run.mu[on, 2]):.3g} N m"
    else:
        remedy = f"raise {friction_of(run, 'mu_v', tables)}, or K_q of what closes it or how far "
        remedy += "it closes"
        does = f"slips by {length(way)} along {holders}"
        says += f"its friction bears {float(normal @ run.mu[on, 0]):.3g} N"
    numbers = {"slip_mm": 1e3 * way, "turn_rad": turn, "presses_N": pressed, "step": k}
    numbers |= {"missing_N": lacks.missing_N, "missing_Nm": lacks.missing_Nm} if lacks else {}
    return Finding(
        "lost-grip",
        True,
        remedy if lacks else f"move more slowly, or {remedy}",
        f"{name} {does}; at {run['t'][k]:.2f} s {says}{more}",
        numbers,
    )

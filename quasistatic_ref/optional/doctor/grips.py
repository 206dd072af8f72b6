"""Grips: what is held from opposite sides by what is driven, and what is missing of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.added import layers
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import friction_of, least_mean, table
from quasistatic_ref.optional.doctor.frame.tolerances import SLIPPED
from quasistatic_ref.optional.doctor.texts import amount, finding, length
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.standing import Standing, Standings

CLOSED = 0.45
"""Length of the least mean of normals, with weights, of a grip that is closed [-]."""
TURNED = 0.1
"""Turn of what a grip holds that counts as lost [rad]."""
STICKS = 0.1
"""Part of a slip in a step that is left where the step is taken slowly [-], of what sticks."""
STAYS = 0.1
"""Way of what a grip holds, over that by which it slips [-], of what does not come along."""
AGREES = 0.5
"""Cosine between a slip and what is missing against it from which they agree [-]."""
LIGHT = 0.01
"""Share of a body's weight [-] below which a force counts as zero."""
PRESSES = 1e-3
"""Normal force that grips, over the largest of the run [-]: less is a solver's noise."""


def lost(run: Run) -> Iterator[Finding]:
    """Bodies that slip or turn by much in everything that grips them.

    A grip is lost if something is missing of the body, all contacts being asked; if it slips away
    from where others bear it, and not the grip; if it would stick were the step taken slowly; or if
    a closed grip slips off what a joint or other fingers hold.
    What is wiped while it is held, or turns as it is meant to, slips slowly as well.
    """
    every = _held(run)
    if not every:
        return
    f_n = run["wrench"][..., 2]
    grips = run.touches & (f_n > PRESSES * f_n.max(initial=0.0))
    slip = np.linalg.norm(run.slips[..., :2], axis=2)
    ways = np.array([slip, np.abs(run.noted("moved")[..., 3])]) * grips
    limits = np.array([SLIPPED * run.sizes, np.full_like(run.sizes, TURNED)])
    for name, held in every.items():
        on = held & grips
        if not _far(ways * held, limits):
            continue
        shut = [closed(n[here]) for n, here in zip(run["n"], on, strict=True)]
        slips = ways * held * np.array(shut)[:, None]
        if not _far(slips, limits):
            continue
        k = int((slips / limits[:, None]).sum(axis=0).max(axis=1).argmax())
        sticks = _would_stick(run, k, on[k], slips[:, k])
        lacks = None if sticks else _missing(run, k, name, on[k], held)
        ways_of = slips.sum(axis=1)
        way = ways_of.max(axis=1)
        grip = on[k] if lacks or sticks else _let_go(run, name, on[k], run["n"][k], ways_of[0])
        if lacks or sticks or _stays(run, name, grip, way[0]):
            yield _lost(run, name, k, grip, lacks, way, sticks)


def _held(run: Run) -> dict[str, Mask]:
    """By free bodies, which contacts they have with what is driven, shape (n_c,)."""
    held: dict[str, Mask] = {}
    for pair, at in run.slices:
        for one, other in ((pair.alpha, pair.beta), (pair.beta, pair.alpha)):
            if run.free[one.link] and run.driven[other.link]:
                held.setdefault(run.body(one.link), np.zeros(len(run.sizes), dtype=bool))[at] = True
    return held


def _far(ways: Array, limits: Array) -> bool:
    """Whether slips or turns, (2, steps, n_c) [m; rad], are beyond limits, (2, n_c), in all."""
    return bool((ways.sum(axis=1) > limits).any())


def closed(n: Array) -> bool:
    """Whether normals, (n_c, 3), nearly cancel with weights >= 0 of sum 1."""
    if len(n) < 2 or (n @ n.sum(axis=0)).min() > CLOSED * np.linalg.norm(n.sum(axis=0)):
        return False  # all of them have that much along their mean
    return least_mean(n) < CLOSED


def _would_stick(run: Run, k: int, on: Mask, ways: Array) -> bool:
    """Whether contacts that slip and turn, (2, n_c) [m; rad], would not, if step k were slow."""
    slow: Callable[..., Any] = part("slow_step")
    step, every = run.posed(k)
    if not every:  # a user's own costs or constraints are not asked
        return False
    with suppress(QuasistaticError):
        moved = step.contacts.motion(slow(step, max(1.0, 100 * run.h)).delta_q)[on]
        n = step.contacts.n[on]
        along = moved[:, :3] - np.vecdot(moved[:, :3], n)[:, None] * n
        slowly = np.array([np.linalg.norm(along, axis=1), np.abs(moved[:, 3])])
        return bool((slowly <= STICKS * ways[:, on].max(axis=1, keepdims=True)).all())
    return False


def _let_go(run: Run, name: str, on: Mask, n: Array, slip: Array) -> Mask:
    """Which contacts of a grip slip off what is held by something else, shape (n_c,).

    What is on a joint is held by that. A free body is where other driven contacts press that do
    not slip, and those that do are a grip by themselves: one finger strokes, and so do two what a
    floor holds. `n` are normals, (n_c, 3), and `slip` the ways of contacts, (n_c,) [m].
    """
    if name not in run.free_bases:
        return on
    of_pairs = set(run.pair_of[slip > SLIPPED * run.sizes].tolist())
    slides = on & np.isin(run.pair_of, [*of_pairs])
    return slides & (closed(n[slides]) and bool((on & ~slides).any()))


def _stays(run: Run, name: str, on: Mask, slip: float) -> bool:
    """Whether what is held does not come along with contacts that slip by a way [m], if any."""
    if not on.any():
        return False
    links = [link for link in range(len(run.system.links)) if run.body(link) == name]
    moved = np.abs(run["delta_q"]).sum(axis=0)[: run.system.n_v] * run.moves[links].any(axis=0)
    turns = np.array([x.unit == "rad" for x in run.system.coordinates])
    ways = np.where(turns, moved * run.sizes[on].min(), moved)
    return bool(ways.max() < STAYS * slip)


def _missing(run: Run, k: int, name: str, on: Mask, held: Mask) -> Standing | None:
    """The force that a slipping body lacks along its slip, from all contacts or its grip alone."""
    others = run.of_body(name) & ~held
    for only in [None, ~others] if run.touches[k, others].any() else [None]:
        lacks = _lacking(run, k, name, only)
        if lacks and _agrees(run, k, name, on, lacks):
            return lacks
    return None


def _lacking(run: Run, k: int, name: str, only: Mask | None) -> Standing | None:
    """What a body lacks after step k, from all contacts or some; None if it lacks nothing."""
    stands: Callable[..., Standings] = part("stands")
    kept: Callable[..., Array] = part("kept_loads")
    q = run["q"][k + 1]
    force = kept(run.simulator, run["q"][k], q, run.noted("tau")[k])
    rows = stands(run.simulator, q, run["q_bar_a"][k], force, "off", name in run.free_bases, only)
    own = (row for row in rows if row.body.partition("/")[0] == name and row.stands is False)
    return next(own, None)


def _agrees(run: Run, k: int, name: str, on: Mask, lacks: Standing) -> bool:
    """Whether a body slips through its grip the way that nothing bears it."""
    if lacks.missing_Nm:
        return True
    if lacks.missing_N < LIGHT * run.system.mass(name) * run.g:
        return False
    way = run.signs(name)[on] @ run.noted("moved")[k, on, :3]
    return bool(-way @ lacks.direction[:3] > AGREES * np.linalg.norm(way))


def _lost(
    run: Run, name: str, k: int, on: Mask, lacks: Standing | None, ways: Array, sticks: bool
) -> Finding:
    """A grip on some contacts that is lost, after a slip and a turn, (2,) [m; rad]."""
    pairs = sorted(set(run.pair_of[on].tolist()))
    tables = " and ".join(sorted({table(run, run.pairs[i]) for i in pairs}))
    holders = " and ".join(dict.fromkeys(run.held_by(i)[1] for i in pairs))
    way, turn = ways.tolist()
    normal = np.maximum(run["wrench"][k, on, 2] - layers(run)[k, on], 0.0)
    slipped = way > SLIPPED * run.sizes[on].min()
    if turn > TURNED and (not slipped or (lacks is not None and lacks.missing_Nm)):
        six = "condim 4" if run.system.of_mjcf else "rows = 6"
        rows = "" if all(run.pairs[i].rows == 6 for i in pairs) else f" ({six})"
        remedy = f"raise {friction_of(run, 'mu_omega', tables)}{rows}, or hold {name} nearer "
        remedy += "to its centre of mass"
        does = f"turns by {amount(turn, 'rad')} in {holders} and slips by {length(way)}"
        bears = f"mu_omega bears {normal @ run.mu[on, 2]:.3g} N m"
    else:
        remedy = f"raise {friction_of(run, 'mu_v', tables)}, or K_q of what closes it or how far "
        remedy += "it closes"
        does = f"slips by {length(way)} along {holders}"
        bears = f"its friction bears {normal @ run.mu[on, 0]:.3g} N"
    numbers = {"slip_mm": 1e3 * way, "turn_rad": turn, "presses_N": normal.sum(), "step": k}
    says = "and it does not come along"
    if lacks:
        says = f"and {lacks.words} are missing"
        numbers |= {"missing_N": lacks.missing_N, "missing_Nm": lacks.missing_Nm}
    elif sticks:
        says = "which holds it if it moves slowly"
        remedy = f"move more slowly, or {remedy}"
    cause = f"{name} {does}; at {run['t'][k]:.2f} s the grip presses with "
    cause += f"{normal.sum():.3g} N in all, {bears}, {says}"
    return finding("lost-grip", cause, remedy, **numbers)

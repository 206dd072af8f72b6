"""What a trajectory says of its run, beside its arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from quasistatic_ref.simulate.distance_source import CLOSED
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.text.plain import Plain

Record = Literal["full", "light", "forces"]
RECORDS: tuple[Record, ...] = get_args(Record)


@dataclass(frozen=True, eq=False, kw_only=True)
class Header(Plain):
    """The header of a trajectory: settings, names, findings and outcome of its run.

    A run makes it; its constructor checks nothing.

    Parameters
    ----------
    h : float
        Time step [s].
    backend, cone, record : str
        As of a scenario.
    n_a, n_u : int
        Number of actuated and of other coordinates of delta_q.
    coordinates, units : tuple of str, length n_a + n_u
        Their names, and their units.
    positions : tuple of str, length n_q
        Names of the entries of q, as ``name [unit]``.
    slots : tuple of str, length n_c
        Places of contacts: the pair's name and a number.
    extra : tuple of str
        Names of an extension's rows.
    steps : int
        Number of steps that succeeded.
    failed : str or None
        Why the run ended early.
    quasi_dynamic_number, largest_boundary_layer : float or None
        The largest Pi of a step [-] and boundary layer [m], see
        :mod:`~quasistatic_ref.optional.doctor.did.artifacts`; None without that part.
    contacts : tuple of tuple of str
        Names of the contacts in each step of a full record.
    findings : tuple of Finding
    law, distances : str
        As of a scenario.
    alone : bool
        False where the steps are not all that was solved, see
        :class:`~quasistatic_ref.step.solution.StepSolution`.
    unanswered : tuple of int
        The steps in which the backend gave no answer.
    not_looked_at : str
        What the findings leave out, and why.
    ignore : tuple of str
        Names of findings that the user has asked not to hear.
    scene_sha256 : str
        Fingerprint of the scene, see :attr:`.Scenario.fingerprint`; empty for that of a simulator.

    Examples
    --------
    >>> header: qr.Header = qr.load_scenario("sphere_spin", steps=3).run(progress=False).header
    >>> header.backend, header.coordinates[:2], header.units[:2]
    ('clarabel', ('sphere/base.x', 'sphere/base.y'), ('m', 'm'))
    """

    h: float
    backend: str
    cone: str
    record: str
    n_a: int
    n_u: int
    coordinates: tuple[str, ...]
    units: tuple[str, ...]
    positions: tuple[str, ...]
    slots: tuple[str, ...]
    steps: int
    extra: tuple[str, ...]
    failed: str | None
    quasi_dynamic_number: float | None
    largest_boundary_layer: float | None
    contacts: tuple[tuple[str, ...], ...]
    findings: tuple[Finding, ...]
    law: str = CONVEX
    distances: str = CLOSED
    alone: bool = True
    unanswered: tuple[int, ...] = ()
    not_looked_at: str = ""
    ignore: tuple[str, ...] = ()
    scene_sha256: str = ""

"""What a trajectory says of its run, beside its arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import Any, Literal, get_args

from quasistatic_ref.errors import about_field
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.simulate.distances import CLOSED, DISTANCES
from quasistatic_ref.simulate.finding import Finding, finding_read, finding_table
from quasistatic_ref.simulate.law import CONVEX, LAWS
from quasistatic_ref.step.cones import cone

FORMAT = "quasistatic-ref/trajectory"
VERSION = 1
Record = Literal["full", "light", "forces"]
RECORDS: tuple[Record, ...] = get_args(Record)


@dataclass(frozen=True, eq=False, kw_only=True)
class Header(Plain):
    """The header of a trajectory: settings, names, findings and outcome of its run.

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
        :mod:`~quasistatic_ref.optional.doctor.artifacts`; None without that part.
    contacts : tuple of tuple of str
        Names of the contacts in each step of a full record.
    findings : tuple of Finding
    law, distances : str
        As of a scenario.
    alone : bool
        False where the steps are not all that was solved, see
        :class:`~quasistatic_ref.certify.solution.StepSolution`.
    unanswered : tuple of int
        The steps in which the backend gave no answer.
    not_looked_at : str
        What the findings leave out, and why.
    ignore : tuple of str
        Names of findings that the user has asked not to hear.
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


def header_table(header: Header) -> dict[str, Any]:
    """A header as the table that files hold; fields with default values are left out."""
    table: dict[str, Any] = {"format": FORMAT, "version": VERSION}
    for field in fields(Header):
        value = getattr(header, field.name)
        if field.default is MISSING or value != field.default:
            table[field.name] = list(value) if isinstance(value, tuple) else value
    table["contacts"] = [list(names) for names in header.contacts]
    table["findings"] = [finding_table(finding) for finding in header.findings]
    return table


def header_read(top: TableReader, n_q: int, n_c: int) -> Header:
    """The header of a file, whose arrays have so many positions and contacts.

    What files have from before there were names of it is numbered.

    Raises
    ------
    InputError
        If a field is missing, unknown or of another type.
    """
    with about_field("cone"):
        friction = cone(top.text("cone")).name
    coordinates = tuple(top.words("coordinates"))
    contacts = top.sequence("contacts")
    if not all(isinstance(names, list) for names in contacts):
        raise top.error_about("contacts", "must be lists of names", contacts)
    top.words("warnings", [])  # of files from before there were findings
    listed = enumerate(top.sequence("findings", []))
    header = Header(
        h=top.number("h", above=0.0),
        backend=top.text("backend"),
        cone=friction,
        record=top.text("record", choices=RECORDS),
        n_a=top.integer("n_a", least=0),
        n_u=top.integer("n_u", least=0),
        coordinates=coordinates,
        units=tuple(top.words("units", ["m, rad"] * len(coordinates))),
        positions=tuple(top.words("positions", [f"q.{i} [m, rad]" for i in range(n_q)])),
        slots=tuple(top.words("slots", [f"contact/{i}/0" for i in range(n_c)])),
        steps=top.integer("steps", least=0),
        extra=tuple(top.words("extra")),
        failed=_unless_null(top, "failed", top.text),
        quasi_dynamic_number=_unless_null(top, "quasi_dynamic_number", top.number),
        largest_boundary_layer=_unless_null(top, "largest_boundary_layer", top.number),
        contacts=tuple(map(tuple, contacts)),
        findings=tuple(finding_read(one, f"findings[{i}]") for i, one in listed),
        law=top.text("law", CONVEX, LAWS),
        distances=top.text("distances", CLOSED, DISTANCES),
        alone=top.boolean("alone", True),
        unanswered=_steps(top, "unanswered"),
        not_looked_at=top.text("not_looked_at", ""),
        ignore=tuple(top.words("ignore", [])),
    )
    top.take("scene", None)  # of files from when accounts of runs were made of them
    top.close()
    return header


def _steps(top: TableReader, name: str) -> tuple[int, ...]:
    """Numbers of steps that ran, ascending."""
    numbers = top.sequence(name, [])
    if not all(type(k) is int and k >= 0 for k in numbers) or numbers != sorted(set(numbers)):
        raise top.error_about(name, "must be numbers of steps, in increasing order", numbers)
    return tuple(numbers)


def _unless_null(top: TableReader, name: str, read: Callable[[str], Any]) -> Any:
    return top.take(name) if top.is_null(name) else read(name)

"""Trajectories as ``.npz`` files without pickles, whose header is JSON."""

from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import about_field, about_file, check_kind
from quasistatic_ref.files.content import written_whole
from quasistatic_ref.files.finding import finding_read, finding_table
from quasistatic_ref.files.npz import json_array, npz_record
from quasistatic_ref.files.record import check_arrays, check_needed, without_steps
from quasistatic_ref.files.table_reader import TableReader
from quasistatic_ref.simulate.distances import CLOSED, DISTANCES
from quasistatic_ref.simulate.header import RECORDS, Header
from quasistatic_ref.simulate.law import CONVEX, LAWS
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.cones import cone

FORMAT = "quasistatic-ref/trajectory"
VERSION = 2
WHAT = "a trajectory written by this program"


def load_trajectory(path: str | Path) -> Trajectory:
    """Read a trajectory file.

    Raises
    ------
    InputError
        If it is not one, is of another version, its header and arrays do not fit together, a field
        is unknown or missing, or a number is not finite that has to be.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> run = qr.load_scenario("sphere_spin", steps=3).run(progress=False)
    >>> path = qr.save_trajectory(Path(tempfile.mkdtemp()) / "spin.npz", run)
    >>> qr.load_trajectory(path).phi.shape
    (3, 1)
    """
    table, arrays = npz_record(path, WHAT)
    with about_file(path):
        top = TableReader(table)
        top.check_format(FORMAT, VERSION)
        check_needed(arrays)
        header = header_read(top, arrays["q"].shape[-1], arrays["rows"].size)
        if not header.steps:  # older files leave out what has no entries
            arrays = without_steps(header, arrays)
        check_arrays(header, arrays)
    return Trajectory(header, arrays)


def save_trajectory(path: str | Path, trajectory: Trajectory) -> Path:
    """Write a trajectory file, whole or not at all.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> run = qr.load_scenario("sphere_spin", steps=3).run(progress=False)
    >>> qr.save_trajectory(Path(tempfile.mkdtemp()) / "spin.npz", run).name
    'spin.npz'
    """
    check_kind(trajectory, Trajectory, "trajectory", "a Trajectory: save_trajectory(path, run)")
    arrays: dict[str, Any] = {
        "header": json_array(header_table(trajectory.header)),
        **trajectory.arrays,
    }
    return written_whole(path, lambda file: np.savez_compressed(file, **arrays))


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
        scene_sha256=top.text("scene_sha256", ""),
    )
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

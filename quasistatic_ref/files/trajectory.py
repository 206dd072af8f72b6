"""Trajectories as ``.npz`` files without pickles, whose header is JSON."""

from collections.abc import Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import about_field, about_file, check_kind
from quasistatic_ref.files.finding import FINDING, finding_read, finding_table
from quasistatic_ref.files.finding import TABLES as TABLES_OF_FINDING
from quasistatic_ref.files.npz import json_array, npz_record
from quasistatic_ref.files.record import check_arrays, check_needed, without_steps
from quasistatic_ref.simulate.distance_source import CLOSED, DISTANCES
from quasistatic_ref.simulate.law import CONVEX, LAWS
from quasistatic_ref.simulate.record.header import RECORDS, Header
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.step.cones import cone
from quasistatic_ref.text.content import written_whole
from quasistatic_ref.text.declared import Field, Tables, head
from quasistatic_ref.text.table_reader import TableReader

FORMAT = "quasistatic-ref/trajectory"
VERSION = 2
WHAT = "a trajectory written by this program"
TOP = "the header of a trajectory"
TABLES = Tables({
    TOP: {
        **head(FORMAT, VERSION),
        "h": Field("number", "time step", "s", above=0.0),
        "backend": Field("text", "name of the solver"),
        "cone": Field("text", "friction cone of every contact"),
        "record": Field("text", "what the file holds", choices=RECORDS),
        "n_a": Field("integer", "number of actuated coordinates", least=0),
        "n_u": Field("integer", "number of un-actuated coordinates", least=0),
        "coordinates": Field("list of words", "names of the entries of delta_q"),
        "units": Field("list of words", "of the entries of delta_q", default=None),
        "positions": Field("list of words", "names of the entries of q", default=None),
        "slots": Field("list of words", "places of contacts: a pair and a number", default=None),
        "steps": Field("integer", "how many succeeded", least=0),
        "extra": Field("list of words", "names of an extension's rows"),
        "failed": Field("text", "why the run ended early", null=True),
        "quasi_dynamic_number": Field("number", "the largest Pi of a step", "-", null=True),
        "largest_boundary_layer": Field("number", "of a step", "m", null=True),
        "contacts": Field("list of lists of words", "names in each step of a full record"),
        "findings": Field("list of tables", "what is doubtful", default=[], of=FINDING),
        "law": Field("text", "as of a scenario", default=CONVEX, choices=LAWS),
        "distances": Field("text", "as of a scenario", default=CLOSED, choices=DISTANCES),
        "alone": Field("boolean", "whether the steps are all that was solved", default=True),
        "unanswered": Field("list of integers", "steps without the backend's answer", default=[]),
        "not_looked_at": Field("text", "what the findings leave out, and why", default=""),
        "ignore": Field("list of words", "names of findings that are not said", default=[]),
        "scene_sha256": Field("text", "hash of the scene", default=""),
        "warnings": Field("list of words", "of files from before there were findings", default=[]),
    },
    **TABLES_OF_FINDING,
})  # fmt: skip


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
        header = header_read(table, arrays)
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


def header_read(table: object, arrays: Mapping[str, NDArray[Any]]) -> Header:
    """The header of a file from its table, and its arrays, of whatever shape [of the notation].

    What files have from before there were names of it is numbered.

    Raises
    ------
    InputError
        If a field is missing, unknown or of another type, or an array that each file has.
    """
    top = TableReader(table)
    values = TABLES.read(top, TOP)
    check_needed(arrays)
    contacts, unanswered = values["contacts"], values["unanswered"]
    if not all(isinstance(names, list) for names in contacts):
        raise top.error_about("contacts", "must be lists of names", contacts)
    counted = all(type(k) is int and k >= 0 for k in unanswered)
    if not counted or unanswered != sorted(set(unanswered)):
        problem = "must be numbers of steps, in increasing order"
        raise top.error_about("unanswered", problem, unanswered)
    with about_field("cone"):
        values["cone"] = cone(values["cone"]).name
    numbered = {
        "units": ["m, rad"] * len(values["coordinates"]),
        "positions": [f"q.{i} [m, rad]" for i in range(arrays["q"].shape[-1])],
        "slots": [f"contact/{i}/0" for i in range(arrays["rows"].size)],
    }
    values |= {name: words for name, words in numbered.items() if values[name] is None}
    values["contacts"] = [*map(tuple, contacts)]
    values["findings"] = [*map(finding_read, values["findings"])]
    for name, value in values.items():
        values[name] = tuple(value) if isinstance(value, list) else value
    return Header(**{name: values[name] for name in Header.kept()})

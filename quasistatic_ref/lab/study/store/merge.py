"""Results of several machines joined into one store, in which the machine is a column.

Times of different machines are never mixed unseen: each row says on which machine it was made,
and the report writes the machine behind a solver's name. What cannot be distinguished from a
mistake, such as the same rows given twice, is refused.
"""

import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, bytes_written, json_text, text_written
from quasistatic_ref.lab.study.problems.study_problems import (
    FACTS,
    HEADER,
    NUMBERS,
    problems_read,
    set_record,
)
from quasistatic_ref.lab.study.store.claim import PASSING
from quasistatic_ref.lab.study.store.pack import shorter
from quasistatic_ref.lab.study.store.schema import FACT, check_solver_rows
from quasistatic_ref.lab.study.store.store import (
    ROWS,
    STUDY,
    VERSION,
    Row,
    key_of,
    label_of,
    lines_read,
    rows_read,
    study_checked,
)
from quasistatic_ref.lab.study.store.unreached import UNREACHED, unreached_read

SAME = ("time_limit", "budget", "warm_up", "memory", "repetitions")
"""What rows are comparable under, besides problems, settings and options."""
TWICE = 0.01
"""Share of a folder's timed rows that may, to three figures, be those of another by chance."""
TIMED = 2
"""Calls from which on the times of a row tell it from others."""


@dataclass(frozen=True, eq=False)
class Part:
    """The results of one machine, or of several that were merged before.

    Parameters
    ----------
    folder : Path
    study : mapping
        Its ``study.json``.
    rows : sequence of dict
        Each with its ``machine``.
    facts : sequence of mapping
        Its ``problems.jsonl``.
    """

    folder: Path
    study: Mapping[str, Any]
    rows: Sequence[Row]
    facts: Sequence[Mapping[str, Any]]

    @property
    def machines(self) -> list[str]:
        """Their names."""
        names: list[str] = self.study["machines"]
        return names


def part_read(words: str) -> Part:
    """The results in ``NAME=FOLDER``, or in ``FOLDER``, whose own name is then the machine's.

    Raises
    ------
    InputError
        If there is no store of solvers, or one whose problems cannot be compared.
    """
    name, _, path = words.rpartition("=")
    folder = Path(path)
    try:
        study, rows = study_checked(folder), rows_read(folder)
        _check_usable(study, rows)
        facts = lines_read(folder / FACTS, FACT)
        study = _named(study, name, folder)
        rows = [{**row, "machine": row.get("machine", study["machines"][0])} for row in rows]
        gone = set(study.get("removed", []))
        check_solver_rows(study, facts, [row for row in rows if label_of(row) not in gone])
        _check_problems(study, facts, rows, folder)
    except InputError as error:
        raise error.in_file(folder) from None
    return Part(folder, study, rows, facts)


def _check_usable(study: Mapping[str, Any], rows: Sequence[Row]) -> None:
    if study["kind"] != "solvers":
        raise InputError("holds a sweep; results on solvers are merged, and nothing else")
    if study.get("version") != VERSION:
        words = "whose times are of another kind; run the study again"
        raise InputError(f"is a store of version {study.get('version')}, {words}")
    if not rows:
        raise InputError("holds no rows yet; run the study first")


def _named(study: Mapping[str, Any], name: str, folder: Path) -> dict[str, Any]:
    """``study.json`` with machine and versions by the name of the machine."""
    if "machines" not in study:
        name = name or folder.resolve().name
        own = {field: {name: study[field]} for field in ("machine", "versions")}
        return {**study, **own, "machines": [name]}
    if name:
        words = ", ".join(study["machines"])
        raise InputError(f"was merged already, of {words}; give it without a name", value=name)
    return dict(study)


def _check_problems(
    study: Mapping[str, Any], facts: Sequence[Mapping[str, Any]], rows: Sequence[Row], folder: Path
) -> None:
    stated = study.get("problems", {}).get("sha256")
    if not isinstance(stated, str):
        raise InputError("does not say which problems it contains", field="problems.sha256")
    names = {fact["id"] for fact in facts}
    if stranger := next((row["problem"] for row in rows if row["problem"] not in names), None):
        raise InputError("is in a row and not listed", file=folder / FACTS, value=stranger)
    if (folder / HEADER).exists() and set_record(problems_read(folder))["sha256"] != stated:
        raise InputError("holds other problems than its study", file=folder / NUMBERS)


def merged(parts: Sequence[Part], out: str | Path) -> Path:
    """Write the rows of all parts as one store; whatever happens, the whole of it or nothing.

    Parameters
    ----------
    parts : sequence of Part
    out : str or Path
        A folder that is not there yet.

    Returns
    -------
    Path
        That folder.

    Raises
    ------
    InputError
        If the parts are not of one study on the same problems, the same rows are given twice, or
        the folder is there or cannot be written.
    """
    out = Path(out)
    study, rows = _study(parts), _rows(parts)
    if out.exists():
        raise InputError("is there already; choose another folder with --out", file=out)
    unreached = {
        label if "@" in label else f"{label}@{', '.join(part.machines)}": reason
        for part in parts
        for label, reason in unreached_read(part.folder).items()
    }
    begun = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        text_written(begun / STUDY, json_text(study) + "\n")
        text_written(begun / ROWS, "".join(json_text(row) + "\n" for row in rows))
        bytes_written(begun / FACTS, bytes_read(parts[0].folder / FACTS))
        if unreached:
            text_written(begun / UNREACHED, json_text(unreached) + "\n")
        for whole in [p.folder for p in parts if (p.folder / HEADER).exists()][:1]:
            for name in (NUMBERS, HEADER):
                bytes_written(begun / name, bytes_read(whole / name))
        begun.rename(out)
    except OSError as error:
        reason = f"cannot be written: {error.strerror or error}"
        raise InputError(reason, file=out) from None
    finally:
        shutil.rmtree(begun, ignore_errors=True)
    return out


def _study(parts: Sequence[Part]) -> dict[str, Any]:
    """What ``study.json`` of all is."""
    first = parts[0]
    joined = dict(first.study)
    known = {fact["id"]: (fact["family"], fact["n"], fact["m"]) for fact in first.facts}
    for part in parts[1:]:
        if part.study["problems"]["sha256"] != joined["problems"]["sha256"]:
            raise _differs(part, first, "problems, by their hash: problems that are made depend on "
                           "the machine's arithmetic, those of a set do not")  # fmt: skip
        if {f["id"]: (f["family"], f["n"], f["m"]) for f in part.facts} != known:
            raise _differs(part, first, "names of problems")
        for name in SAME:
            if part.study.get(name) != joined.get(name):
                raise _differs(part, first, name)
        joined["settings"] = _settings(joined["settings"], part, first)
        joined["solvers"] = _solvers(joined["solvers"], part, first)
        for name in ("machine", "versions"):
            for machine, own in part.study[name].items():
                if _lasting(joined[name].get(machine, own)) != _lasting(own):
                    words = f"{name}, though both are called {machine}; write NAME=FOLDER"
                    raise _differs(part, first, words)
            joined[name] = joined[name] | part.study[name]
        joined["machines"] = list(dict.fromkeys([*joined["machines"], *part.machines]))
    present = {label_of({**s, "solver": s["name"]}) for s in joined["solvers"]}
    gone = (label for part in parts for label in part.study.get("removed", []))
    joined["removed"] = [label for label in dict.fromkeys(gone) if label not in present]
    return joined


def _lasting(facts: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in facts.items() if name not in PASSING}


def _settings(there: Sequence[Mapping[str, Any]], part: Part, first: Part) -> list[Any]:
    names = {setting["name"]: setting for setting in there}
    for setting in part.study["settings"]:
        if names.setdefault(setting["name"], setting) != setting:
            raise _differs(part, first, f"setting {setting['name']}")
    return list(names.values())


def _solvers(there: Sequence[Mapping[str, Any]], part: Part, first: Part) -> list[Any]:
    """Solvers of both, each with the options of every setting."""
    names = {(s["interface"], s["name"]): dict(s) for s in there}
    for solver in part.study["solvers"]:
        own = names.setdefault((solver["interface"], solver["name"]), dict(solver))
        options = solver["options"]
        if own.get("target") != solver.get("target") or any(
            own["options"].get(name, value) != value for name, value in options.items()
        ):
            raise _differs(part, first, f"solver or options {solver['interface']}:{solver['name']}")
        own["options"] = {**own["options"], **options}
    return list(names.values())


def _rows(parts: Sequence[Part]) -> list[Row]:
    """Every row once."""
    where: dict[str, Path] = {}
    made: dict[str, Path] = {}
    for part in parts:
        timed = [_measured(row) for row in part.rows if row["calls"] >= TIMED]
        known = [made[one] for one in timed if one in made]
        if len(known) > TWICE * len(timed):
            problem = f"holds {len(known):,} rows that {known[0]} has too; give each only once"
            raise InputError(problem, file=part.folder)
        made |= dict.fromkeys(timed, part.folder)
        for row in part.rows:
            if (key := key_of(row)) in where:
                words = f"{row['problem']} by {label_of(row)} on {row['machine']}"
                problem = (
                    f"holds a measurement that {where[key]} has too ({words}); write NAME=FOLDER "
                    "where these are different machines"
                )
                raise InputError(problem, file=part.folder)
            where[key] = part.folder
    return sorted((row for part in parts for row in part.rows), key=key_of)


def _measured(row: Row) -> str:
    """A row without its machine, and short: the same of a store and of that store packed."""
    return json_text(shorter({k: v for k, v in row.items() if k != "machine"}))


def _differs(part: Part, first: Part, what: str) -> InputError:
    return InputError(f"has another {what} than {first.folder}", file=part.folder)

"""Results of several machines joined into one store, in which the machine is a column.

Times of different machines are never mixed unseen: each row says on which machine it was made,
and the report writes the machine behind a solver's name. What cannot be distinguished from a
mistake, such as the same rows given twice, is refused.
"""

import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.lab.study.problems.for_study import FOLDER
from quasistatic_ref.lab.study.store.continued import joined, lasting
from quasistatic_ref.lab.study.store.pack import shorter
from quasistatic_ref.lab.study.store.rows import Row, key_of, label_of
from quasistatic_ref.lab.study.store.store import Contents, Store, contents

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
    found : Contents
        Its store; each row with its ``machine``.
    """

    folder: Path
    found: Contents

    @property
    def machines(self) -> list[str]:
        """Their names."""
        names: list[str] = self.found.study["machines"]
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
    found = contents(folder, every=True)
    study = found.study
    rows = found.rows
    if not rows:
        raise InputError("holds no rows yet; run the study first", file=folder)
    if not isinstance(study.get("problems", {}).get("sha256"), str):
        raise InputError("does not say which problems it contains", file=folder)
    if "machines" in study:
        if name:
            words = f"was merged already, of {', '.join(study['machines'])}; give it without a name"
            raise InputError(words, file=folder, value=name)
        return Part(folder, found)
    name = name or folder.resolve().name
    own = {field: {name: study[field]} for field in ("machine", "versions")}
    rows = [row | {"machine": name} for row in rows]
    study = {**study, **own, "machines": [name]}
    return Part(folder, Contents(study, rows, found.problems, found.unreached))


def merged_store(parts: Sequence[Part], out: str | Path) -> Path:
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
    study = _study(parts)
    rows = _rows(parts)
    if out.exists():
        raise InputError("is there already; choose another folder with --out", file=out)
    unreached = {
        name if "@" in name else f"{name}@{', '.join(part.machines)}": reason
        for part in parts
        for name, reason in part.found.unreached.items()
    }
    begun = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        begun.mkdir(parents=True)
        with Store(begun, study, parts[0].found.problems) as store:
            store.add(*rows)
            store.keep_unreached(unreached)
        for part in [part for part in parts if (part.folder / FOLDER).exists()][:1]:
            shutil.copytree(part.folder / FOLDER, begun / FOLDER)
        begun.rename(out)
    except OSError as error:
        reason = f"cannot be written: {error.strerror or error}"
        raise InputError(reason, file=out) from None
    finally:
        shutil.rmtree(begun, ignore_errors=True)
    return out


def _study(parts: Sequence[Part]) -> dict[str, Any]:
    """What the store of all is about."""
    first, *others = parts
    study = first.found.study
    for part in others:
        own = part.found.study

        def differs(what: str, part: Part = part) -> InputError:
            return InputError(f"has another {what} than {first.folder}", file=part.folder)

        if own["problems"]["sha256"] != study["problems"]["sha256"]:
            words = "problems, by their hash: problems that are made depend on the machine's "
            raise differs(f"{words}arithmetic, those of a set do not")
        study = {**study, **joined(study, own, differs)}
        for name in ("machine", "versions"):
            for machine, facts in own[name].items():
                there = study[name].get(machine, facts)
                if lasting(there, there) != lasting(facts, facts):
                    raise differs(f"{name}, though both are called {machine}; write NAME=FOLDER")
            study[name] = study[name] | own[name]
        study["machines"] = list(dict.fromkeys([*study["machines"], *part.machines]))
    return study


def _rows(parts: Sequence[Part]) -> list[Row]:
    """Every row once."""
    where: dict[tuple[Any, ...], Path] = {}
    made: dict[str, Path] = {}
    for part in parts:
        timed = [_text_without_machine(row) for row in part.found.rows if row["calls"] >= TIMED]
        known = [made[one] for one in timed if one in made]
        if len(known) > TWICE * len(timed):
            problem = f"holds {len(known):,} rows that {known[0]} has too; give each only once"
            raise InputError(problem, file=part.folder)
        made |= dict.fromkeys(timed, part.folder)
        for row in part.found.rows:
            if (key := key_of(row)) in where:
                words = f"{row['problem']} by {label_of(row)} on {row['machine']}"
                problem = (
                    f"holds a measurement that {where[key]} has too ({words}); write NAME=FOLDER "
                    "where these are different machines"
                )
                raise InputError(problem, file=part.folder)
            where[key] = part.folder
    return [row for part in parts for row in part.found.rows]


def _text_without_machine(row: Row) -> str:
    """A row without its machine, and short: the same of a store and of that store packed."""
    return json_text(shorter({k: v for k, v in row.items() if k != "machine"}))

"""One engine judged: its environment made, its adapter called for phenomena."""

import json
import shlex
import sys
import tomllib
from collections.abc import Collection
from pathlib import Path
from typing import Any

from quasistatic_ref.lab.vectors.challenge.program import Program
from validation.programs.engines.phenomena import cells, engine_answer
from validation.tools.scripts import environment, record_written

HERE = Path(__file__).parent
RESULTS = HERE.parents[1] / "results" / "engines"
ENGINES = tomllib.loads((HERE / "engines.toml").read_text("utf-8"))
RECORDED = ("newton", "pinocchio")
"""Engines whose results were made at revision 90118a65, by adapters that are gone since."""
TIMEOUT = 600.0
"""For one scene or case [s]."""


def python_of(name: str, folder: Path) -> str:
    """The interpreter of an engine's environment, made in a folder unless it is there."""
    requires = ENGINES[name]["requires"]
    return str(environment(folder / name, *requires)) if requires else sys.executable


def program_of(name: str, folder: Path, timeout: float) -> Program:
    """An engine's adapter in its environment, given so long for a question [s]."""
    adapter = str(HERE / ENGINES[name]["adapter"])
    return Program(shlex.join([python_of(name, folder), adapter]), timeout)


def write_answers(name: str, folder: Path, results: Path, resume: bool) -> None:
    """What an engine answered, written setting by setting; `resume` keeps those that are there."""
    engine = ENGINES[name]
    path = results / f"{name}.json"
    before = json.loads(path.read_text("utf-8")) if resume and path.exists() else {}
    record = {"requires": engine["requires"], "settings": {}}
    with program_of(name, folder, TIMEOUT) as program:
        for setting, values in engine["settings"].items():
            print(f"{name}: {setting}", file=sys.stderr, flush=True)
            cells = before.get("settings", {}).get(setting)
            cells = cells or phenomena(program, values, engine)
            record["settings"][setting] = cells
            record["version"] = program.said.implementation or before["version"]
            record_written(path, record)
        record["tried"] = [
            {**one, **outcome_of_change(program, one, engine)} for one in engine.get("tried", ())
        ]
    record_written(path, record)


def outcome_of_change(
    program: Program, one: dict[str, Any], engine: dict[str, Any]
) -> dict[str, Any]:
    """What becomes of a cell when its setting is changed in what is said to be the cause."""
    setting = dict(engine["settings"][one["setting"]])
    for key, value in one["values"].items():
        old = setting.get(key)
        setting[key] = {**old, **value} if isinstance(old, dict) else value
    print(f"{one['setting']}, {one['changed']}", file=sys.stderr, flush=True)
    (cell,) = phenomena(program, setting, engine, (one["phenomenon"],))
    return {"words": cell["words"]}


def phenomena(
    program: Program,
    setting: dict[str, Any],
    engine: dict[str, Any],
    names: Collection[str] = (),
) -> list[dict[str, Any]]:
    """The cells of a setting, all of them or those named."""
    lacks = {*engine.get("lacks", ()), *setting.get("lacks", ())}

    def simulate(scene: dict[str, Any]) -> dict[str, Any]:
        return engine_answer(program, {**scene, **setting.get("scene", {})}, setting)

    return [
        {
            "phenomenon": cell.phenomenon,
            "value": cell.value,
            "words": cell.words,
            "verdict": "-" if cell.phenomenon in lacks else "holds" if cell.holds else "differs",
        }
        for cell in cells(simulate, setting["h"], names)
    ]

"""One engine judged: its environment made, its adapter called for phenomena."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Collection
from pathlib import Path
from typing import Any

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.vectors.challenge.program import Program
from validation.programs.engines.phenomena import cells

HERE = Path(__file__).parent
RESULTS = HERE.parents[1] / "results" / "engines"
ENGINES: dict[str, dict[str, Any]] = tomllib.loads((HERE / "engines.toml").read_text("utf-8"))
TIMEOUT = 600.0
"""For one scene or case [s]: Newton compiles its kernels at the first."""


def python_of(name: str, folder: Path) -> str:
    """The interpreter of an engine's environment, made in a folder unless it is there."""
    requires = ENGINES[name]["requires"]
    if not requires:
        return sys.executable
    python = folder / name / "bin" / "python"
    if not python.exists():
        print(f"{name}: pip install {' '.join(requires)}", file=sys.stderr, flush=True)
        subprocess.run([sys.executable, "-m", "venv", str(folder / name)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "-q", *requires], check=True)
    return str(python)


def judged(name: str, folder: Path, results: Path, resume: bool) -> None:
    """What an engine answered, written setting by setting; `resume` keeps those that are there."""
    engine = ENGINES[name]
    path = results / f"{name}.json"
    before = json.loads(path.read_text("utf-8")) if resume and path.exists() else {}
    record: dict[str, Any] = {"requires": engine["requires"], "settings": {}}
    command = shlex.join([python_of(name, folder), str(HERE / engine["adapter"])])
    with Program(command, TIMEOUT) as program:
        for setting, values in engine["settings"].items():
            print(f"{name}: {setting}", file=sys.stderr, flush=True)
            cells = before.get("settings", {}).get(setting)
            cells = cells or phenomena(program, setting, values, engine)
            record["settings"][setting] = cells
            record["version"] = program.said.implementation or before["version"]
            text_written(path, json.dumps(record, indent=1) + "\n")
        record["tried"] = [
            {**one, **tried(program, one, engine)} for one in engine.get("tried", ())
        ]
    text_written(path, json.dumps(record, indent=1) + "\n")


def tried(program: Program, one: dict[str, Any], engine: dict[str, Any]) -> dict[str, Any]:
    """What becomes of a cell when its setting is changed in what is said to be the cause."""
    setting = dict(engine["settings"][one["setting"]])
    for key, value in one["values"].items():
        old = setting.get(key)
        setting[key] = {**old, **value} if isinstance(old, dict) else value
    print(f"{one['setting']}, {one['changed']}", file=sys.stderr, flush=True)
    (cell,) = phenomena(program, one["setting"], setting, engine, (one["phenomenon"],))
    return {"words": cell["words"]}


def phenomena(
    program: Program,
    name: str,
    setting: dict[str, Any],
    engine: dict[str, Any],
    names: Collection[str] = (),
) -> list[dict[str, Any]]:
    """The cells of a setting, all of them or those named."""
    lacks = {*engine.get("lacks", ()), *setting.get("lacks", ())}

    def simulate(scene: dict[str, Any]) -> dict[str, Any]:
        changed = {**scene, **setting.get("scene", {})}
        reply = program.ask(name, "phenomena", {"scene": changed, "setting": setting})
        if reply.kind != "output":
            raise ValueError(reply.said)
        return reply.output

    return [
        {
            "phenomenon": cell.phenomenon,
            "value": cell.value,
            "words": cell.words,
            "verdict": "-" if cell.phenomenon in lacks else "holds" if cell.holds else "differs",
        }
        for cell in cells(simulate, setting["h"], names)
    ]

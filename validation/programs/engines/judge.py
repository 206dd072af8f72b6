"""One engine judged: its environment made, its adapter called for layers and phenomena."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.formats.resources import vectors_folder
from quasistatic_ref.lab.claims.engines.mujoco_scenes import heap
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.folder import layer_report
from quasistatic_ref.lab.vectors.check.report import LayerReport
from quasistatic_ref.lab.vectors.files import Case, expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers import layer
from validation.programs.engines.phenomena import cells

HERE = Path(__file__).parent
RESULTS = HERE.parents[1] / "results" / "engines"
ENGINES: dict[str, dict[str, Any]] = tomllib.loads((HERE / "engines.toml").read_text("utf-8"))
TIMEOUT = 600.0
"""For one scene or case [s]: Newton compiles its kernels at the first."""
HEAPS = 12
"""Heaps of bodies whose rows MuJoCo makes."""


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
    engine, path = ENGINES[name], results / f"{name}.json"
    before = json.loads(path.read_text("utf-8")) if resume and path.exists() else {}
    record: dict[str, Any] = {"requires": engine["requires"], "layers": [], "settings": {}}
    for words in engine["programs"]:
        adapter, *arguments = words.split()
        command = shlex.join([python_of(name, folder), str(HERE / adapter), *arguments])
        with Program(command, TIMEOUT) as program:
            for report, left_out in layers(program, words):
                record["layers"].append(layer_record(program.said.implementation, report, left_out))
            for setting, values in engine.get("settings", {}).items():
                print(f"{name}: {setting}", file=sys.stderr, flush=True)
                cells = before.get("settings", {}).get(setting)
                cells = cells or phenomena(program, setting, values, engine)
                record["settings"][setting] = cells
                record["version"] = program.said.implementation or before["version"]
                text_written(path, json.dumps(record, indent=1) + "\n")
            record["tried"] = [
                {**one, **tried(program, one, engine)} for one in engine.get("tried", ())
            ]
    record.setdefault("version", program.said.implementation)
    text_written(path, json.dumps(record, indent=1) + "\n")


def layers(program: Program, words: str) -> Iterator[tuple[LayerReport, dict[str, str]]]:
    """The report on each layer that a program answers, and why it leaves cases out."""
    if "mujoco" in words:
        yield rows_of_heaps(program)
    for name in LAYERS_OF.get(words.split("_")[0], ()):
        cases, expected = inputs_read(vectors_folder(), name), expected_read(vectors_folder(), name)
        outputs, left_out = {}, {}
        for case in cases:
            reply = program.ask(case.id, name, case.input)
            if reply.kind == "output":
                outputs[case.id] = reply.output
            else:
                left_out[case.id] = reply.said
        answers = Answers(outputs, program.said.implementation)
        yield layer_report(name, cases, expected, answers), left_out


LAYERS_OF = {
    "pinocchio": ("jacobian", "integrate"),
    "coal": ("distance",),
    "mujoco": ("distance",),
    "drake": ("distance",),
    "qpsolvers": ("qp",),
}
"""Layers that adapters answer."""


def rows_of_heaps(program: Program) -> tuple[LayerReport, dict[str, str]]:
    """MuJoCo's rows of heaps, at its own contacts; what is expected of them has no rounding."""
    cases, outputs = [], {}
    for seed in range(HEAPS):
        id = f"rows/mujoco_heap/{seed}"
        found = program.ask(id, "heap", {"mjcf": heap(seed).mjcf}).output
        cases.append(Case(id, "contacts of a heap, as MuJoCo finds them", found["input"]))
        outputs[id] = found["output"]
    expected = {
        case.id: {"id": case.id, **layer("rows").expected(case.input).json()} for case in cases
    }
    answers = Answers(outputs, program.said.implementation)
    return layer_report("rows", cases, expected, answers), {}


def layer_record(engine: str, report: LayerReport, left_out: dict[str, str]) -> dict[str, Any]:
    """What is kept of a layer's report."""
    failed = [v for v in report.verdicts if v.verdict == "failed"]
    return {
        "engine": engine,
        "layer": report.layer,
        **{v: report.count(v) for v in ("passed", "acceptable", "failed", "missing")},
        "worst digits": round(report.worst.digits, 1) if report.worst else None,
        "first failure": failed[0].id if failed else None,
        "left out": sorted(set(left_out.values())),
    }


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

"""Which short program shows which red cell, and what it prints."""

from __future__ import annotations

import subprocess
import tomllib
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "reproductions"
LIST: list[dict[str, Any]] = tomllib.loads((FOLDER / "list.toml").read_text("utf-8"))[
    "reproduction"
]
CHATTER = ("Module ", "Warp ", "   ")
"""Beginnings of lines by which Warp reports itself."""
SECONDS = 600.0
"""For one program [s]: Newton compiles its kernels."""


def of_cell(engine: str, setting: str, phenomenon: str) -> str:
    """The program of a red cell; empty if there is none."""
    for entry in LIST:
        fits = entry.get("settings", "") in setting and engine in entry["engines"]
        if fits and phenomenon in entry["phenomena"]:
            return str(entry["file"])
    return ""


def missing(records: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Red cells without a program."""
    return [
        (engine, setting, cell["phenomenon"])
        for engine, record in records.items()
        for setting, cells in record["settings"].items()
        for cell in cells
        if cell["verdict"] == "differs" and not of_cell(engine, setting, cell["phenomenon"])
    ]


def reproduced(engine: str, python: str) -> dict[str, str]:
    """What each program of an engine prints; the end of its errors where it ends with one."""
    printed = {}
    for entry in LIST:
        if engine in entry["engines"]:
            command = [python, str(FOLDER / entry["file"])]
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=SECONDS, check=False
            )
            failed = f"status {done.returncode}: {done.stderr[-400:]}"
            said = [line for line in done.stdout.splitlines() if not line.startswith(CHATTER)]
            printed[entry["file"]] = "\n".join(said) if done.returncode == 0 else failed
    return printed

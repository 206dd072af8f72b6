"""Which short program shows which red cell, and whether it prints the number of that cell."""

import re
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from validation.programs.engines.phenomena import PHENOMENA

FOLDER = Path(__file__).parents[1] / "reproductions"
LIST = tomllib.loads((FOLDER / "list.toml").read_text("utf-8"))["reproduction"]
CHATTER = ("Module ", "Warp ", "   ")
"""Beginnings of lines by which Warp reports itself."""
SECONDS = 600.0
"""For one program [s]: Newton compiles its kernels."""
ALIKE = 0.1
"""Between a cell's number and its program's, which may take a speed at the end, not from places."""
NUMBER = re.compile(r"-?\d[\d.]*(?:e[+-]?\d+)?")


def of_cell(engine: str, setting: str, phenomenon: str) -> str:
    """The program of a red cell; empty if there is none."""
    for entry in LIST:
        fits = entry.get("settings", "") in setting and engine in entry["engines"]
        if fits and phenomenon in entry["phenomena"]:
            return str(entry["file"])
    return ""


def red_cells(records: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Each cell that differs from the answer, with its engine and setting."""
    for engine, record in records.items():
        for setting, cells in record["settings"].items():
            for cell in cells:
                if cell["verdict"] == "differs":
                    yield engine, setting, cell


def cells_without_program(records: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Red cells without a program."""
    every = ((engine, setting, cell["phenomenon"]) for engine, setting, cell in red_cells(records))
    return [of for of in every if not of_cell(*of)]


def names(setting: str) -> list[str]:
    """What a setting says, whichever way it is written: ``cone="elliptic"`` is ``elliptic``."""
    return [word for word in re.findall(r"[\w'.-]+", setting) if word != "cone"]


def printed_for(printed: str, setting: str) -> list[float]:
    """The numbers in the lines that a program prints for a setting."""
    lines = (line.partition(": ") for line in printed.splitlines())
    return [
        float(number)
        for name, _, said in lines
        for number in NUMBER.findall(said)
        if names(name) == names(setting)
    ]


def unlike(records: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Red cells whose program does not show them: it prints another number, or none."""
    found = []
    for engine, setting, cell in red_cells(records):
        file = of_cell(engine, setting, cell["phenomenon"])
        numbers = printed_for(records[engine]["printed"].get(file, ""), setting)
        if not any(shows(cell, number) for number in numbers):
            found.append((engine, setting, cell["phenomenon"]))
    return found


def shows(cell: dict[str, Any], number: float) -> bool:
    """Whether a number is that of a cell; of a bar that no grip holds, a turn that is too large."""
    if "held" in PHENOMENA[cell["phenomenon"]]:
        return abs(number) > float(PHENOMENA[cell["phenomenon"]]["held"])
    return abs(number - float(cell["value"])) <= ALIKE * abs(float(cell["value"]))


def printed_lines(engine: str, python: str) -> dict[str, str]:
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

"""Scenes with one mistake each, as text files, and scenes without one.

Three scenes that do what they should (a gripper lifts a can that is known as a cloud, a pusher
moves a box over a table, a hand turns a knob) are in ``mistakes/``, with sixty mistakes, one at a
time. ``finding`` and ``words`` say what the first finding has to be, and which words its sentence
has to hold; ``remedy``, once for each finding, is the whole remedy. ``healthy.toml`` has thirty
scenes without a mistake, made from the same three, and five near misses.
"""

import re
import shutil
import tomllib
from pathlib import Path

import numpy as np

from quasistatic_ref import InputError, RunFailed, load_scenario
from quasistatic_ref import Finding

HERE = Path(__file__).parent / "mistakes"
PAGE = (HERE.parents[3] / "docs" / "findings.md").read_text("utf-8")
GRAVE = {
    name: None if " or " in severity else severity == "grave"
    for name, severity in re.findall(r"^\| `([\w-]+)` \|.*\| ([\w, ]+) \| \w+ \|$", PAGE, re.M)
}
"""By the page, of each finding; None of those that may be either."""
BEFORE = {*re.findall(r"^\| `([\w-]+)` \|.*\| (?:typed|start) \|$", PAGE, re.M)}
"""By the page, what is found before a run, of which a few steps show all."""
SCENES = ("grasp", "push", "turn")
RADIUS = 0.033
HEIGHT = 0.12
"""Of the can [m]."""


def mistakes():
    """All of them, as the file has them."""
    return tomllib.loads((HERE / "mistakes.toml").read_text("utf-8"))["mistake"]


def healthy_scenes(kind):
    """The thirty scenes without a mistake, or those that nearly have one."""
    return tomllib.loads((HERE / "healthy.toml").read_text("utf-8"))[kind]


def scenes_written(folder):
    """The scenes and their robots in a folder, and the can's points, from its middle and bottom."""
    shutil.copytree(HERE, folder, dirs_exist_ok=True)
    angle = np.arange(24) * 2 * np.pi / 24
    for name, bottom in (("can.csv", -HEIGHT / 2), ("can_from_its_bottom.csv", 0.0)):
        points = [
            (RADIUS * np.cos(a), RADIUS * np.sin(a), z)
            for z in np.linspace(bottom, bottom + HEIGHT, 13)
            for a in angle
        ]
        np.savetxt(folder / name, points, delimiter=",", fmt="%.9f")


def findings_after(folder, scene, edits=(), settings=(), fast=True):
    """What is found in a run of a scene, after edits: file, old text, new text."""
    scenes_written(folder)
    for file, old, new in edits:
        text = (folder / file).read_text("utf-8")
        assert old in text, (file, old)
        (folder / file).write_text(text.replace(old, new), "utf-8")
    try:
        run = load_scenario(
            folder / f"{scene}.toml", ["solver.certify=off", *settings], fast=fast
        ).run(progress=False)
    except RunFailed as failure:
        error = Finding("the run failed", True, "", failure.reason, {})
        return (*failure.trajectory.findings, error)
    except InputError as error:
        return (Finding("refused", True, "", str(error), {}),)
    return run.findings

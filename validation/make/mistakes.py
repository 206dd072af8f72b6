"""Scenes with one mistake each: whether a run's first finding names it.

Three scenes that do what they should (a gripper lifts a can that is known as a cloud, a pusher
moves a box over a table, a hand turns a knob) are in ``mistakes/``, with sixty mistakes, one at a
time. ``finding`` and ``words`` say what the first finding has to be, and which words its sentence
has to hold. They were written before the findings. Every third mistake was held out: it was not run
before the findings were finished. 19 of those 20 were named then; the other one is named since
targets between equal waypoints count as equal. ``healthy.toml`` has thirty scenes without a
mistake, made from the same three after all findings were finished.

Run ``python -m validation.make.mistakes [--out FILE]``, which takes two minutes.

Exit status 1 if fewer than 55 are named, if one of the three has a finding, or one of the thirty
another one than that of a large drag, which is no mistake.
"""

import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

from quasistatic_ref import InputError, RunFailed, load_scenario
from quasistatic_ref.simulate.finding import Finding
from validation.tools.scripts import script_options, show_page

HERE = Path(__file__).parent / "mistakes"
SCENES = ("grasp", "push", "turn")
NEEDED = 55
RADIUS = 0.033
HEIGHT = 0.12
"""Of the can [m]."""


def mistakes():
    """All of them, as the file has them."""
    return tomllib.loads((HERE / "mistakes.toml").read_text("utf-8"))["mistake"]


def healthy_scenes():
    """The thirty scenes without a mistake."""
    return tomllib.loads((HERE / "healthy.toml").read_text("utf-8"))["healthy"]


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
    return folder


def findings_after(scene, edits=()):
    """What is found in a run of a scene, after edits: file, old text, new text."""
    with tempfile.TemporaryDirectory() as name:
        folder = scenes_written(Path(name))
        for file, old, new in edits:
            text = (folder / file).read_text("utf-8")
            if old not in text:
                raise AssertionError(f"{file} has no {old!r}")
            (folder / file).write_text(text.replace(old, new), "utf-8")
        try:
            return load_scenario(folder / f"{scene}.toml").run(progress=False).findings
        except RunFailed as failure:
            error = Finding("the run failed", True, failure.reason, "", {})
            return (*failure.trajectory.findings, error)
        except InputError as error:
            return (Finding("refused", True, str(error), "", {}),)


def is_named(mistake, findings):
    """Whether the first finding is one that the mistake asks for, with its words."""
    return (
        bool(findings)
        and findings[0].name in mistake["finding"]
        and all(word in findings[0].sentence for word in mistake["words"])
    )


def main():
    """Run them, and write the page."""
    options = script_options(__doc__, out=Path)
    rows = ["| scene | mistake | held out | named | first finding |", "|---|---|---|---|---|"]
    right = {False: [], True: []}
    for one in mistakes():
        findings = findings_after(one["scene"], one["edits"])
        good = is_named(one, findings)
        right[one["held_out"]].append(good)
        sentence = findings[0].sentence if findings else "none"
        words = "yes" if good else "**no**"
        held = "yes" if one["held_out"] else ""
        rows.append(f"| {one['scene']} | {one['what']} | {held} | {words} | {sentence} |")
        print(rows[-1], file=sys.stderr, flush=True)
    plain = {scene: findings_after(scene) for scene in SCENES}
    changed = {one["what"]: findings_after(one["scene"], one["edits"]) for one in healthy_scenes()}
    slow = [what for what, findings in changed.items() if [x.name for x in findings] == ["drag"]]
    wrong = {what: x for what, x in {**plain, **changed}.items() if x and what not in slow}
    seen, held_out = (f"{sum(x)} of {len(x)}" for x in right.values())
    summary = (
        f"Named in the first sentence: {seen} seen and {held_out} held out. Of the "
        f"{len(plain) + len(changed)} scenes without a mistake {len(wrong)} have a finding, but "
        f"for {len(slow)} of which is said that their drag is large: {'; '.join(slow)}."
    )
    for what, findings in wrong.items():
        print(what, *findings, sep="\n  ", file=sys.stderr)
    made = "Written by `python -m validation.make.mistakes --out FILE`."
    first = "At their first run, 19 of the 20 that were held out were named."
    page = ["# Scenes with one mistake each", "", made, "", f"{summary} {first}", "", *rows]
    show_page("\n".join(page), options.out)
    every = right[False] + right[True]
    missed = len(every) - sum(every)
    return 0 if not wrong and missed <= len(mistakes()) - NEEDED else 1


if __name__ == "__main__":
    sys.exit(main())

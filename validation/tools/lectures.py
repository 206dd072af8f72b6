"""Make the notebook of each lecture: text, tasks, and cells that say whether an answer is right.

Run ``python -m validation.tools.lectures [--out FOLDER] [--answers] [--run]``. A lecture is a file
of ``docs/lectures/`` whose cells begin with ``# %% setup``, ``task``, ``answer`` or ``check``.
Notebooks have no answers by default. With --run (extra ``notebooks``), each is executed with its
answers; exit status 1 if one fails, gives less than all marks, or takes a minute of the processor.
The site shows each as a page, and gives its notebook to be downloaded.
"""

import ast
import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from validation.tools.scripts import ROOT, script_options

FOLDER = ROOT / "docs" / "lectures"
LECTURES = (
    "one_contact", "springs_and_steps", "clouds_and_jacobians", "the_program_in_cvxpy",
    "grasps_and_certificates",
)  # fmt: skip
MINUTE = 60.0
"""Longest time of the processor that a lecture's notebook may take [s]."""

GRADES = '''marks = {}


def check(task, right):
    """Mark a task: right, or not yet."""
    try:
        marks[task] = bool(right())
    except Exception as error:
        marks[task] = False
        print(f"{type(error).__name__}: {error}")
    print(f"{task}: {'right' if marks[task] else 'not yet'}")
'''
SPENT = "import time; print(time.process_time())"
TOTAL = 'print(f"{sum(marks.values())} of {len(marks)} right")'


def cells(name: str) -> tuple[str, list[tuple[str, str]]]:
    """Text at the head of a lecture, and its cells: kind and source, which says nothing to ruff."""
    head, *parts = re.split(
        r"^# %% (\w+)\n", (FOLDER / f"{name}.py").read_text("utf-8"), flags=re.M
    )
    pairs = zip(parts[::2], parts[1::2], strict=True)
    shown = [(kind, code.replace("  # fmt: skip", "").strip()) for kind, code in pairs]
    return ast.get_docstring(ast.parse(head)) or "", shown


def program(name: str, answers: bool) -> str:
    """A lecture as one program, with its answers or with what is to be filled in."""
    left_out = "task" if answers else "answer"
    return "\n\n".join(
        [GRADES, *(code for kind, code in cells(name)[1] if kind != left_out), TOTAL]
    )


def marks(name: str, answers: bool) -> dict[str, bool]:
    """Task -> whether it is right, after the lecture has run in this process."""
    space = {}
    exec(compile(program(name, answers), name, "exec"), space)
    return dict(space["marks"])


def lesson(name: str) -> list[tuple[str, str]]:
    """What a lecture shows, in order: ``text``, ``task``, ``answer`` after it, and ``code``."""
    text, parts = cells(name)
    title, _, body = text.partition("\n")
    made = [("text", f"# {title}\n{body}"), ("code", GRADES)]
    for kind, code in parts:
        if kind == "task":
            question = ast.get_docstring(ast.parse(code)) or ""
            made.append(("text", f"**Task.** {question}"))
            code = re.sub(r'\A""".*?"""\s*', "", code, count=1, flags=re.S)
        made.append((kind if kind in ("task", "answer") else "code", code))
    return [*made, ("code", TOTAL)]


def book(parts: Iterable[tuple[str, str]]) -> dict[str, Any]:
    """A notebook of Jupyter's format: cells of ``text``, or of code."""
    made = []
    for kind, source in parts:
        cell = {"id": f"cell-{len(made)}", "metadata": {}, "source": source}  # the same every time
        if kind == "text":
            made.append({"cell_type": "markdown", **cell})
        else:
            made.append({"cell_type": "code", "execution_count": None, "outputs": [], **cell})
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def notebook(name: str, answers: bool, *last: str) -> dict[str, Any]:
    """A lecture as a notebook, with more code at its end."""
    left_out = "task" if answers else "answer"
    shown = [part for part in lesson(name) if part[0] != left_out]
    return book([*shown, *(("code", code) for code in last)])


def fault(name: str) -> str:
    """What is wrong with a notebook that has its answers, or nothing."""
    from validation.tools.notebooks import executed_notebook

    made = executed_notebook(notebook(name, True, SPENT))
    said, seconds = (cell.outputs[0]["text"].strip() for cell in made.cells[-2:])
    took = float(seconds)
    print(f"{name}: {said}, {took:.1f} s", flush=True)
    right, _, whole, _ = said.split()
    return "" if right == whole and took < MINUTE else f"{name}: {said} in {took:.1f} s"


def main() -> int:
    """Write, and run."""
    options = script_options(__doc__, out=Path("lectures"), answers=False, run=False)
    options.out.mkdir(parents=True, exist_ok=True)
    for name in LECTURES:
        text = json.dumps(notebook(name, options.answers), indent=1) + "\n"
        (options.out / f"{name}.ipynb").write_text(text, "utf-8")
    print(f"wrote {len(LECTURES)} notebooks to {options.out}")
    wrong = [fault(name) for name in LECTURES] if options.run else []
    print("\n".join(filter(None, wrong)), end="")
    return 1 if any(wrong) else 0


if __name__ == "__main__":
    sys.exit(main())

"""The notebooks of docs/notebooks: their scripts run, and their sources are those of the scripts.

``python -m tests.test_notebooks`` writes the notebooks again, with their outputs. Whoever does so
looks at them. Outputs are not compared: they depend on the machine.
"""

import json
import re
import runpy

import matplotlib.pyplot as plt
import pytest

from tests.pages import ROOT
from tests.processes import python

FOLDER = ROOT / "docs" / "notebooks"
SCRIPTS = sorted(FOLDER.glob("*.py"))
LARGEST = 300_000  # bytes
WITHOUT_ROBOTS = "one_contact"


def cells(script):
    """Kind and source of each cell of a script in jupytext's percent format."""
    _, *parts = re.split(r"^# %%(.*)\n", script.read_text("utf-8"), flags=re.MULTILINE)
    for head, text in zip(parts[::2], parts[1::2], strict=True):
        source = text.strip("\n")
        if "[markdown]" in head:
            yield "markdown", re.sub(r"^# ?", "", source, flags=re.MULTILINE)
        else:
            yield "code", source


OTHERS = [script for script in SCRIPTS if script.stem != WITHOUT_ROBOTS]


@pytest.mark.long
@pytest.mark.parametrize("script", OTHERS, ids=lambda script: script.stem)
def test_a_script_runs(script, monkeypatch):
    monkeypatch.setattr(plt, "show", lambda: plt.close("all"))
    runpy.run_path(str(script))
    plt.close("all")


@pytest.mark.extra("notebooks")
def test_a_script_runs_without_a_robot_library():
    blocked = 'import runpy, sys; sys.modules["pinocchio"] = sys.modules["coal"] = None; '
    run = f"{blocked}runpy.run_path({str(FOLDER / f'{WITHOUT_ROBOTS}.py')!r})"
    python("-c", run)


@pytest.mark.extra("notebooks")
def test_a_run_shows_its_progress_in_a_notebook_and_nothing_if_it_is_not_to():
    """A kernel's standard error is no terminal; a bar is a widget there."""
    import nbclient
    import nbformat

    run = "import quasistatic_ref as qr\nrun = qr.load_scenario('block_push', steps=3).run({})"
    cells = [nbformat.v4.new_code_cell(run.format(word)) for word in ("", "progress=False")]
    book = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(book, timeout=100).execute()
    shown = [
        sum(
            "application/vnd.jupyter.widget-view+json" in one.get("data", {})
            for one in cell.outputs
        )
        for cell in book.cells
    ]
    assert shown == [1, 0]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_notebook_has_the_sources_of_its_script_and_outputs(script):
    path = script.with_suffix(".ipynb")
    assert path.stat().st_size <= LARGEST
    made = json.loads(path.read_text("utf-8"))["cells"]
    assert [(cell["cell_type"], "".join(cell["source"])) for cell in made] == list(cells(script))
    assert any(
        "image/png" in output.get("data", {}) for cell in made for output in cell.get("outputs", ())
    )


def written(script):
    """Write the notebook of a script, run in a kernel of its own."""
    import jupytext
    import nbformat
    from nbclient import NotebookClient

    made = jupytext.read(script)
    NotebookClient(made, timeout=600, record_timing=False).execute()
    for number, cell in enumerate(made.cells):
        cell.id = f"cell-{number}"  # the same every time
    made.metadata.pop("widgets", None)
    nbformat.write(made, script.with_suffix(".ipynb"))


if __name__ == "__main__":
    for each in SCRIPTS:
        written(each)

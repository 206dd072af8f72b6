"""The commands of pages run in their order, in an empty folder.

Those of docs/guides/first_scene.md run in tests/meta/test_first_scene.py, those of docs/studies.md
in tests/lab/study/test_a_solver_of_your_own.py. Lines that name a file of the reader's own are not
run: they say how a command is called. Runs end after the last step that their page looks at. They
and ``demo`` take fast steps, which have the same bits.
"""

import re
import shlex
import shutil

import pytest

from quasistatic_ref.cli.main import main
from tests.pages import EXAMPLES, ROOT, fenced, shell_lines

DOCS = ROOT / "docs"
PAGES = [
    "artifacts.md",
    "cones.md",
    "derivations.md",
    "findings.md",
    "guides/check_your_implementation.md",
    "guides/does_my_contact_hold.md",
    "guides/runs.md",
    "guides/write_a_scenario.md",
    "quickstart.md",
]
LONG = "artifacts.md", "derivations.md", "guides/runs.md", "quickstart.md"
"""Pages whose commands take seconds."""
READERS_OWN = "my_sim"
STEP = re.compile(r"--step (\d+)")
FINDS = "opinion"
"""The command that ends with 1 where it finds something, as on its page."""


NEEDS = dict.fromkeys(LONG, pytest.mark.long)
NEEDS["guides/does_my_contact_hold.md"] = pytest.mark.extra("engines")


@pytest.mark.parametrize("page", [pytest.param(p, marks=NEEDS.get(p, ())) for p in PAGES])
def test_the_commands_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if "contact_hold" in page:  # the scenes that the page links to
        shutil.copytree(EXAMPLES / "opinion", tmp_path, dirs_exist_ok=True)
    text = (DOCS / page).read_text("utf-8")
    last = max(map(int, STEP.findall(text)), default=4)
    lines = [shlex.split(line) for line in shell_lines(text)]
    commands = [words[1:] for words in lines if words[0] == "quasistatic-ref"]
    assert commands
    for words in commands:
        fast = [] if words[1].endswith(".xml") else ["--fast"]  # which no MuJoCo scene takes
        shorter = ["--set", f"steps={last + 1}"]
        quicker = {"run": [*shorter, *fast], "demo": fast}.get(words[0], [])
        if not any(READERS_OWN in word for word in words):
            assert main([*words, *quicker]) == (words[0] == FINDS), words


@pytest.mark.parametrize(
    "page", ["conventions.md", pytest.param("guides/runs.md", marks=pytest.mark.long)]
)
def test_the_programs_of_a_page_run(page, tmp_path, monkeypatch, capsys):
    """A run of theirs ends a little after the grip has closed, at 0.7 s, and takes fast steps."""
    monkeypatch.chdir(tmp_path)
    programs = fenced((DOCS / page).read_text("utf-8"), "python")
    assert programs
    for program in programs:
        exec(compile(program.replace("steps=150", "steps=75, fast=True"), page, "exec"), {})

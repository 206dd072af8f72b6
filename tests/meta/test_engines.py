"""Phenomena for engines: the committed page is that of the results, and its example runs."""

import json
import re

import numpy as np

from validation.programs.engines import phenomena
from validation.programs.engines.judge import ENGINES, RECORDED, RESULTS
from validation.programs.engines.tables import phenomena_page


def test_the_engine_of_the_page_is_asked_everything(capsys):
    page = (RESULTS.parents[2] / "docs" / "engines.md").read_text("utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    with np.errstate(divide="ignore", invalid="ignore"):  # its bodies never move
        exec(compile(code, "engines.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(phenomena.PHENOMENA)


def test_the_page_is_that_of_the_results():
    names = (*ENGINES, *RECORDED)
    records = {name: json.loads((RESULTS / f"{name}.json").read_text("utf-8")) for name in names}
    assert (RESULTS / "phenomena.md").read_text("utf-8") == phenomena_page(records)

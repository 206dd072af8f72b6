"""Engines that we did not write, judged: ``python -m validation.make.engines [NAME ...]``.

For each engine of engines.toml, or those named: makes an environment with its pinned versions in a
temporary folder (``--environments`` keeps them in a folder of yours, and takes what is there), asks
its adapter for the phenomena, writes ``NAME.json`` in the folder ``--out``
(validation/results/engines unless it is said), and runs the engine's reproductions in its
environment. At the end the page, phenomena.md, is written again from all results that are there:
with ``--tables`` only that. ``--resume`` keeps settings that have results.

Settings that are named as causes of a red cell are changed, and the cell is measured again
(``tried``). It takes an hour on two busy cores, seven minutes of it computing, and three
gigabytes. Exit status 1 if a red cell has no reproduction, or one that does not print the cell's
number, or if a reproduction ended with an error.
"""

import json
import tempfile
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from validation.programs.engines.judge import ENGINES, RESULTS, python_of, write_answers
from validation.programs.engines.reproduce import cells_without_program, printed_lines, unlike
from validation.programs.engines.tables import phenomena_page
from validation.tools.scripts import record_written, script_options


def main() -> int:
    """Judge, and write the tables."""
    given = script_options(
        __doc__, ENGINES, out=RESULTS, environments=Path, tables=False, resume=False
    )
    results = given.out
    results.mkdir(parents=True, exist_ok=True)
    wrong = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = (given.environments or Path(temporary)).absolute()
        for name in () if given.tables else given.names or ENGINES:
            write_answers(name, folder, results, given.resume)
            path = results / f"{name}.json"
            record = json.loads(path.read_text("utf-8"))
            record["printed"] = printed_lines(name, python_of(name, folder))
            record_written(path, record)
            wrong += sum(text.startswith("status") for text in record["printed"].values())
    records = {
        name: json.loads(path.read_text("utf-8"))
        for name in ENGINES
        if (path := results / f"{name}.json").exists()
    }
    text_written(results / "phenomena.md", phenomena_page(records))
    for cell in cells_without_program(records):
        wrong += 1
        print(f"without a reproduction: {', '.join(cell)}")
    for cell in unlike(records):
        wrong += 1
        print(f"not shown by its reproduction: {', '.join(cell)}")
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main())

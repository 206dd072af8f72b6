"""Engines that we did not write, judged: ``python -m validation.make.engines [NAME ...]``.

For each engine of engines.toml, or those named: makes an environment with its pinned versions in a
temporary folder (``--environments`` keeps them in a folder of yours, and takes what is there), asks
its adapter for the phenomena, and writes ``NAME.json`` in the folder ``--out``
(validation/results/engines unless it is said). At the end the page, phenomena.md, is written again
from all results that are there: with ``--tables`` only that. ``--resume`` keeps settings that have
results.

Settings that are named as causes of a red cell are changed, and the cell is measured again
(``tried``).
"""

import json
import tempfile
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from validation.programs.engines.judge import ENGINES, RECORDED, RESULTS, write_answers
from validation.programs.engines.tables import phenomena_page
from validation.tools.scripts import script_options


def main() -> int:
    """Judge, and write the page."""
    given = script_options(
        __doc__, ENGINES, out=RESULTS, environments=Path, tables=False, resume=False
    )
    results = given.out
    results.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        folder = (given.environments or Path(temporary)).absolute()
        for name in () if given.tables else given.names or ENGINES:
            write_answers(name, folder, results, given.resume)
    records = {
        name: json.loads(path.read_text("utf-8"))
        for name in (*ENGINES, *RECORDED)
        if (path := results / f"{name}.json").exists()
    }
    text_written(results / "phenomena.md", phenomena_page(records))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

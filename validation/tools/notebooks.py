"""Make a Jupyter notebook of every example, and run it.

Run ``python -m validation.tools.notebooks [NAME ...] [--out FOLDER]``, with the extra
``notebooks``. Exit status 1 if a notebook fails, or ends without its numbers or its figure.
"""

import ast
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from itertools import repeat
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from quasistatic_ref.lab.examples.gallery import EXAMPLES, example
from validation.tools.lectures import book
from validation.tools.scripts import script_options

try:
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError
    from traitlets.config import Config
except ModuleNotFoundError as error:
    sys.exit(f"needs {error.name}: pip install 'quasistatic-ref[notebooks]'")

KERNELS = 2
"""Notebooks that run at the same time."""
PATIENCE = 600
"""Longest run of a cell [s]."""


def notebook(name: str) -> dict[str, Any]:
    """An example as a notebook: its text, its code, its numbers, its figure."""
    path = Path(example(name).__file__)
    text, code = parts(path.read_text("utf-8"))
    title, _, body = text.partition("\n")
    return book([
        ("text", f"# {title}\n{body}".rstrip()),
        ("code", code),
        ("code", "main()"),
        ("code", DRAWN),
    ])  # fmt: skip


DRAWN = """from quasistatic_ref.optional.show.figures import figure_style

with figure_style():
    page = figure()"""


def executed_notebook(content: dict[str, Any]) -> nbformat.NotebookNode:
    """A notebook that has run, spoken to through files of its own: no ports."""
    made = nbformat.from_dict(content)
    with TemporaryDirectory() as folder:
        config = Config({"KernelManager": {"transport": "ipc", "ip": f"{folder}/kernel"}})
        NotebookClient(made, timeout=PATIENCE, config=config).execute()
    return made


def parts(source: str) -> tuple[str, str]:
    """Docstring of a module, and its code."""
    tree = ast.parse(source)
    lines = source.splitlines()
    return ast.get_docstring(tree) or "", "\n".join(lines[tree.body[1].lineno - 1 :])


def run(name: str, out: Path) -> str:
    """Run a notebook, and write it; what is wrong with it, or nothing."""
    start = time.perf_counter()
    try:
        made = executed_notebook(notebook(name))
    except CellExecutionError as error:
        return f"{name}: {error}"
    nbformat.write(made, out / f"{name}.ipynb")
    print(f"{name}: {time.perf_counter() - start:.1f} s", flush=True)
    numbers, drawn = (cell.outputs for cell in made.cells[2:])
    results = [output for output in numbers if output.output_type == "execute_result"]
    seen = [output for output in drawn if "image/png" in output.get("data", {})]
    if len(results) != 1 or len(seen) != 1:
        return f"{name}: {len(results)} results of main() and {len(seen)} figures, not one each"
    return ""


def main() -> int:
    """Every notebook, or those that are named."""
    options = script_options(__doc__, EXAMPLES, out=Path("notebooks"))
    options.out.mkdir(parents=True, exist_ok=True)
    names = options.names or EXAMPLES
    with ThreadPoolExecutor(KERNELS) as pool:
        wrong = [fault for fault in pool.map(run, names, repeat(options.out)) if fault]
    print(f"wrote {len(names) - len(wrong)} notebooks to {options.out}")
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""Make a Jupyter notebook of every example, and run it.

Run ``python -m validation.tools.notebooks [--out FOLDER] [--only NAME ...] [--no-run]``, with the
extra ``notebooks``. Exit status 1 if a notebook fails, or ends without its numbers or its figure.
"""

from __future__ import annotations

import argparse
import ast
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

from quasistatic_ref.lab.examples.gallery import EXAMPLES, example

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


def notebook(name: str) -> nbformat.NotebookNode:
    """An example as a notebook: its text, its code, its numbers, its figure."""
    path = Path(example(name).__file__)
    text, code = parts(path.read_text(encoding="utf-8"))
    title, _, body = text.partition("\n")
    made = nbformat.v4.new_notebook()
    made.cells = [
        nbformat.v4.new_markdown_cell(f"# {title}\n{body}".rstrip()),
        nbformat.v4.new_code_cell(code),
        nbformat.v4.new_code_cell("main()"),
        nbformat.v4.new_code_cell(
            "from quasistatic_ref.optional.show.figures import figure_style\n\n"
            "with figure_style():\n    page = figure()"
        ),
    ]
    for k, cell in enumerate(made.cells):
        cell["id"] = f"cell-{k}"  # the same every time
    made.metadata["kernelspec"] = {
        "name": "python3",
        "display_name": "Python 3",
        "language": "python",
    }
    return made


def parts(source: str) -> tuple[str, str]:
    """Docstring of a module, and its code between that and ``if __name__``."""
    tree = ast.parse(source)
    body = [node for node in tree.body[1:] if "__name__" not in ast.unparse(node)]
    lines = source.splitlines()
    first, last = body[0].lineno, body[-1].end_lineno
    return ast.get_docstring(tree) or "", "\n".join(lines[first - 1 : last])


def run(name: str, made: nbformat.NotebookNode) -> str:
    """Run a notebook in place; what is wrong with it, or nothing."""
    start = time.perf_counter()
    with TemporaryDirectory() as folder:
        # Spoken to through files of its own: no ports, and no other kernel's messages.
        config = Config({"KernelManager": {"transport": "ipc", "ip": f"{folder}/kernel"}})
        fault = _fault(name, NotebookClient(made, timeout=PATIENCE, config=config))
    print(f"{name}: {time.perf_counter() - start:.1f} s", flush=True)
    return fault


def _fault(name: str, client: NotebookClient) -> str:
    try:
        made = client.execute()
    except CellExecutionError as error:
        return f"{name}: {error}"
    numbers, drawn = (cell.outputs for cell in made.cells[2:])
    results = [output for output in numbers if output.output_type == "execute_result"]
    seen = [output for output in drawn if "image/png" in output.get("data", {})]
    if len(results) != 1 or len(seen) != 1:
        return f"{name}: {len(results)} results of main() and {len(seen)} figures, not one each"
    return ""


def main() -> int:
    """Every notebook, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("notebooks"))
    parser.add_argument("--only", nargs="+", default=EXAMPLES, choices=EXAMPLES, metavar="NAME")
    parser.add_argument("--no-run", action="store_true")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    made = {name: notebook(name) for name in options.only}
    wrong: list[str] = []
    if not options.no_run:
        with ThreadPoolExecutor(KERNELS) as pool:
            wrong = [fault for fault in pool.map(run, made, made.values()) if fault]
    for name, content in made.items():
        nbformat.write(content, options.out / f"{name}.ipynb")
    print(f"wrote {len(made)} notebooks to {options.out}")
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env bash
# dartpy 6.20.0: a project keeps its tests in a folder `tests` without __init__.py, a namespace package, and a program
# in another folder has the project on its path, behind the installed packages or before them.
# Expected: `import tests.speeds` gives the project's module, as it does before dartpy is installed.
# What comes: the wheel carries its own tests as a top-level package `tests` with an __init__.py, which wins over a
# namespace package wherever it is on the path: No module named 'tests.speeds'.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
mkdir -p "$folder/project/tests" "$folder/elsewhere"
echo "limit = 0.5" > "$folder/project/tests/speeds.py"
cd "$folder/elsewhere"
asked='import tests.speeds; print(tests.speeds.limit)'
echo "before: $(PYTHONPATH=../project ../venv/bin/python -c "$asked")"
"$folder/venv/bin/python" -m pip install --quiet dartpy==6.20.0
after="$(PYTHONPATH=../project ../venv/bin/python -c "$asked" 2>&1 | tail -1 || true)"
echo "after: $after"
test "$after" = "ModuleNotFoundError: No module named 'tests.speeds'"
../venv/bin/python -c '
import importlib.metadata as metadata
print("files of dartpy in tests/:", sum(str(file).startswith("tests/") for file in metadata.files("dartpy")))
import tests
print(tests.__file__.split("site-packages")[1])
'

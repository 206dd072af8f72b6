"""Two checkers of solution files against each other.

Run ``python -m validation.tools.check_verifier``, where Node is; ``--all`` takes no sample.
``validation/programs/verifier/verify.js`` was written from the documents alone. Here both it and
`verify` of this package judge the files of :mod:`validation.tools.verifier_files`. They agree if
the JavaScript refuses nothing that `verify` verifies, and if it refuses what `verify` refuses, or
says "not checked" of a field that was forged. With ``--site``, the built documentation, the page in
it is asked too, in a browser.

Prints a table, and exits with status 1 where the two disagree.
"""

import json
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.step.files import step_text
from tests.oracles.forged_scenes import scenes
from tests.oracles.forgeries import good_file
from validation.tools.browser import Browser, check
from validation.tools.scripts import ROOT, script_options
from validation.tools.verifier_files import Case, Cases, all_cases

VERIFIER = ROOT / "validation" / "programs" / "verifier" / "verify.js"
NODE = """
const { verify } = require(process.argv[1]);
const cases = JSON.parse(require("fs").readFileSync(0, "utf8"));
console.log(JSON.stringify(cases.map(([step, solution]) => verify(step, solution))));
"""
BATCH = 2000
"""Files in one process of Node: its input is one string."""


def verdicts(cases: list[Case]) -> list[dict[str, Any]]:
    """What ``verify.js`` says of each case; many in one process."""
    node = shutil.which("node") or sys.exit("no Node on this machine: install Debian's nodejs")
    found = []
    for k in range(0, len(cases), BATCH):
        given = json.dumps([[case.step, case.solution] for case in cases[k : k + BATCH]])
        done = subprocess.run(
            [node, "-e", NODE, str(VERIFIER)],
            input=given,
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        found += json.loads(done.stdout)
    return found


def disagreement(case: Case, said: dict[str, Any]) -> bool:
    """Whether the two checkers contradict each other, or the second is right for a wrong reason."""
    if not said["reason"].startswith(case.reason):
        return True
    if case.refusal is None:
        return bool(said["verdict"] == "refused")
    open_fields = set(said["notChecked"]) & case.forged
    return not (said["verdict"] == "refused" or (said["verdict"] == "not checked" and open_fields))


def page_verdicts(site: Path, cases: list[Case]) -> list[str]:
    """What the page of a built site says of each case, in a browser without network."""
    found = []
    with Browser() as browser, TemporaryDirectory() as folder:
        paths = [Path(folder) / "step.json", Path(folder) / "solution.json"]
        for case in cases:
            paths[0].write_text(case.step)
            paths[1].write_text(case.solution)
            browser.open(site / "check_solution.html")
            root = browser.ask("DOM.getDocument")["root"]["nodeId"]
            node = browser.ask("DOM.querySelector", nodeId=root, selector="#files")["nodeId"]
            browser.ask("DOM.setFileInputFiles", nodeId=node, files=[str(path) for path in paths])
            browser.until("document.getElementById('said').textContent !== ''")
            found.append(browser.value("document.getElementById('said').textContent"))
        check(bool(browser.faults()), "; ".join(browser.faults()))
    return found


def check_page(site: Path) -> None:
    """A true solution is verified in the page, a forged one refused; ends the script if not."""
    (step,) = (step for (kind, name), step in scenes().items() if "own" in name)
    with TemporaryDirectory() as folder:
        cases = Cases(Path(folder))
        good = good_file(step, "exact")
        text = step_text(step)
        forged = good | {
            "delta_q": [float(np.nextafter(good["delta_q"][0], 1)), *good["delta_q"][1:]]
        }
        texts = [json.dumps(record) for record in (good, forged)]
        said = page_verdicts(site, [cases.case("page", text, record) for record in texts])
    verdicts = [sentence.split(":")[0] for sentence in said]
    check(verdicts != ["verified", "refused"], str(said))
    print("in the page a true solution is verified, and a forged one refused")


def main() -> int:
    """Print the table; exit status 1 if the two checkers disagree."""
    options = script_options(__doc__, site=Path, all=False, out=Path)
    if options.site:
        check_page(options.site)
    with TemporaryDirectory() as folder:
        cases = list(all_cases(Path(folder), options.all))
    rows = {}
    faults = []
    for case, said in zip(cases, verdicts(cases), strict=True):
        ours = "verified" if case.refusal is None else "refused"
        rows.setdefault(case.family, Counter())[f"{ours}, {said['verdict']}"] += 1
        if disagreement(case, said):
            rows[case.family]["disagree"] += 1
            faults.append((case, said))
    columns = [f"{ours}, {js}" for ours in ("verified", "refused")
               for js in ("verified", "not checked", "refused")] + ["disagree"]  # fmt: skip
    rows["all"] = sum(rows.values(), Counter())
    cells = [(family, *(counts[c] for c in columns)) for family, counts in rows.items()]
    lines = markdown_table(("files", *columns), cells)
    print("\n".join(lines))
    for case, said in faults[:20]:
        print(case.family, sorted(case.forged), case.refusal, said, case.solution[:300], sep="\n  ")
    if options.out:
        text_written(options.out, HEAD + "\n".join(lines) + "\n")
    return int(bool(faults))


HEAD = """# Two checkers of solution files

Made by `python -m validation.tools.check_verifier --all`, whose first lines say what is asked. A
column names what `verify` of the package says, then what `validation/programs/verifier/verify.js`
says.

"""

if __name__ == "__main__":
    sys.exit(main())

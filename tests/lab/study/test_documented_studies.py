"""The study files that the documentation shows are study files."""

import re
from pathlib import Path

from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.study.file.study_file import solver_study, study_kind

DOCS = Path(__file__).parents[3] / "docs"
FILE = re.compile(r"^```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_the_study_of_the_guide_has_three_solvers_and_thirty_problems(tmp_path):
    (shown,) = FILE.findall((DOCS / "guides" / "run_a_study.md").read_text("utf-8"))
    path = tmp_path / "my_study.toml"
    path.write_text(shown, "utf-8")
    tables = toml_read(path)
    assert study_kind(tables) == "solvers"
    study = solver_study(path, tables)
    (part,) = study.parts
    assert sum(study.problems.families.values()) == 30
    assert (len(part.solvers), len(part.settings), len(part.units)) == (3, 2, 2)

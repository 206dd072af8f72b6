"""Set-up, solving and conversion in the report, against rows whose parts are planted."""

from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.report.report import study_report
from tests.lab.study import made_store
from tests.lab.study.plain_report import agrees, parsed, quantile, rows_of_line


def test_set_up_solving_and_conversion_are_the_parts_of_calls(tmp_path):
    """Planted: solving is half of a call, set-up a fifth (ant) or not reported (cat)."""
    rows = [row for row in made_store.written(tmp_path / "store") if row["repetition"] == 0]
    tables = parsed(markdown_page(study_report(tmp_path / "store")))
    ((_, where, columns, body),) = (t for t in tables if t[0].startswith("Set-up, solving"))
    assert sorted(line[0] for line in body) == ["ant", "ant", "cat"]  # bee reports nothing
    for line in body:
        own = rows_of_line("", where.partition(";")[0], columns[:3], line[:3], rows)
        own = [row for row in own if row["outcome"] == "solved"]
        call = 1e3 * quantile([row["seconds"]["call"] for row in own], 0.5)
        setup = 0.2 if line[0] == "ant" else 0.0
        assert int(line[3]) == len(own)
        assert agrees(line[4], call)
        assert line[5] == "-" if line[0] == "cat" else agrees(line[5], 0.2 * call)
        assert agrees(line[6], 0.5 * call)
        assert agrees(line[7], (0.5 - setup) * call)
        assert agrees(line[8], 100 * (0.5 - setup))

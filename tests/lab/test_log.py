"""Logs of long runs: what was done is kept, and not done again."""

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.log import Log

HEAD = {"settings": [1, 2]}


def log_of(path, head=HEAD):
    return Log(path, lambda record: record["i"], head)


def test_a_run_goes_on_after_the_last_whole_line(tmp_path):
    path = tmp_path / "log.jsonl"
    records = [{"i": i, "square": i**2} for i in range(3)]
    log_of(path).add(*records)
    whole = path.read_text()
    path.write_text(whole[:-5])  # the last record is cut off
    log = log_of(path)
    assert log.by_key == {0: records[0], 1: records[1]}
    log.add(records[2])
    assert path.read_text() == whole
    assert [*log_of(path).by_key.values()] == records


def test_a_log_of_something_else_is_refused_and_left_as_it_is(tmp_path):
    path = tmp_path / "log.jsonl"
    log_of(path).add({"i": 1})
    with pytest.raises(InputError, match="were made with other settings"):
        log_of(path, {"settings": []})
    for text in ('{"settings": [1, 2]}\n{"k": 1}\n', '{"settings": [1, 2]}\n3\n', "x\n"):
        path.write_text(text)
        with pytest.raises(InputError, match="holds something else"):
            log_of(path)
        assert path.read_text() == text

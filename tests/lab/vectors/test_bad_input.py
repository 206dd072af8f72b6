"""Whatever `quasistatic-ref vectors` cannot do is refused in one sentence, with status 2."""

import pytest

from tests.lab.vectors.committed_cases import VECTORS, answer_file, right_answers

BAD = {
    "generate --vectors nowhere --out out": "no such file",
    "check nowhere": "is not a folder of answers",
    "check .": "answers no layer",
    "check answers --vectors nowhere": "expected",
    "check answers --only selection/nothing": "no beginning",
    "check answers --digits nan": "digits: must be from 0 to 16",
    "check answers --layer row": "--layer row: is not a layer; did you mean 'rows'?",
    "check answers --case row/cone": "--case row/cone: is not a layer; did you mean 'rows'?",
    "check answers --only row/cone": "--only row/cone: is not a layer; did you mean 'rows'?",
    "own --layer row": "--layer row: is not a layer; did you mean 'rows'?",
    "challenge": "--command: is missing",
    "challenge --command x --cases 0": "--cases: must be positive",
    "challenge --command x --timeout nan": "--timeout: must be positive",
    "challenge --command x --seed -1": "--seed: must be 0 or more",
    "challenge --command x --digits 20": "--digits: must be at most 16",
    "challenge --command x --layer row": "did you mean 'rows'?",
    "challenge --command x --layer derivative": "has no new cases; the vectors have some",
    "challenge --command x --again no_such_file": "no_such_file",
    "challenge --command ./no_such_program": "cannot be started",
    "challenge --command \\'unclosed": "cannot be read",
    "challenge --command ''": "is empty",
}


@pytest.mark.parametrize("command", BAD)
def test_a_bad_input_of_vectors_is_refused_in_one_sentence(command, tmp_path, monkeypatch, cli):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "answers").mkdir()
    answer_file(tmp_path / "answers", "selection", right_answers("selection"))
    of_vectors = command.startswith(("own", "check")) and "--vectors" not in command
    errors = cli("vectors", command, *(["--vectors", VECTORS] * of_vectors), status=2).err
    assert BAD[command] in errors
    assert errors.count("\n") == 1

"""Whatever `quasistatic-ref vectors` cannot do is refused in one sentence, with status 2."""

import pytest

from tests.lab.vectors.committed_cases import VECTORS, answer_file, right_answers

CHECK = ["check", "answers"]
CHALLENGE = ["challenge", "--command", "x"]
BAD = [
    (["own", "--layer", "row", "--out", "out"], "did you mean 'rows'?"),
    (["generate", "--vectors", "nowhere", "--out", "out"], "no such file"),
    (["check", "nowhere"], "is not a folder of answers"),
    (["check", "."], "answers no layer"),
    ([*CHECK, "--vectors", "nowhere"], "expected"),
    ([*CHECK, "--only", "selection/nothing"], "no beginning"),
    ([*CHECK, "--digits", "nan"], "digits: must be from 0 to 16"),
    (["challenge"], "--command: is missing"),
    ([*CHALLENGE, "--cases", "0"], "--cases: must be positive"),
    ([*CHALLENGE, "--timeout", "nan"], "--timeout: must be positive"),
    ([*CHALLENGE, "--seed", "-1"], "--seed: must be 0 or more"),
    ([*CHALLENGE, "--digits", "20"], "--digits: must be at most 16"),
    ([*CHALLENGE, "--layer", "row"], "did you mean 'rows'?"),
    ([*CHALLENGE, "--again", "no_such_file"], "no_such_file"),
    (["challenge", "--command", "./no_such_program"], "cannot be started"),
    (["challenge", "--command", "'unclosed"], "cannot be read"),
    (["challenge", "--command", ""], "is empty"),
]


@pytest.mark.parametrize(("given", "says"), BAD)
def test_it_is_refused_in_one_sentence(given, says, tmp_path, monkeypatch, cli):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "answers").mkdir()
    answer_file(tmp_path / "answers", "selection", right_answers("selection"))
    if given[0] in ("own", "check", "report") and "--vectors" not in given:
        given = [*given, "--vectors", str(VECTORS)]
    errors = cli("vectors", *given, status=2).err
    assert says in errors
    assert errors.count("\n") == 1

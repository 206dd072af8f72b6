"""The notebooks of the lectures grade themselves: answers are right, and nothing else is."""

import pytest

from validation.tools.lectures import LECTURES, cells, marks


@pytest.mark.parametrize("name", LECTURES)
def test_every_answer_of_a_lecture_is_right_and_no_unfinished_task_is(name):
    done = marks(name, answers=True)
    begun = marks(name, answers=False)
    tasks = sum(kind == "task" for kind, _ in cells(name)[1])
    assert len(done) == len(begun) == tasks >= 2
    assert all(done.values()), done
    assert not any(begun.values()), begun

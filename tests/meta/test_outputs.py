"""What commands write, as tried by validation/make/outputs.py: its page, and a sample of it."""

from validation.make.outputs import (
    COUNT,
    FULL,
    OTHERS,
    RESULT,
    STREAMS,
    page,
)


def test_the_committed_page_says_that_nothing_was_lost():
    kinds = {
        "pipes, devices, logs that are appended to": len(STREAMS),
        "full disks": len(FULL),
        "results that are there": len(OTHERS),
        "backend, speed, cone, certificate": COUNT,
        "runs ended by signals, and resumed": 3,
    }
    tried = [(kind, "", "") for kind, count in kinds.items() for _ in range(count)]
    assert RESULT.read_text(encoding="utf-8") == page(tried, COUNT)

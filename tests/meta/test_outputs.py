"""What commands write, as tried by validation/make/outputs.py: its page, and a sample of it."""

from pathlib import Path

from validation.make.outputs import (
    COUNT,
    FULL,
    OTHERS,
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
    committed = Path(__file__).parents[2] / "validation" / "results" / "outputs.md"
    assert committed.read_text("utf-8") == page(tried, COUNT)

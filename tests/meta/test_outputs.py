"""What commands write, as tried by validation/make/outputs.py: its page, and a sample of it."""

from validation.make.outputs import (
    COUNT,
    FULL,
    OTHERS,
    RESULT,
    STREAMS,
    contents,
    page,
    shell,
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


def test_what_was_lost_is_named_with_its_command():
    tried = [("full disks", "RUN", ""), ("full disks", "SOLVE", "what was there")]
    assert page(tried, 0).endswith("| full disks | 2 | `SOLVE`: what was there |\n")


def test_a_command_is_run_in_its_folder_and_its_files_are_seen(tmp_path):
    assert shell(tmp_path, "mkdir out; echo text > out/log; exit 3").returncode == 3
    assert contents(tmp_path) == {"out/log": b"text\n"}

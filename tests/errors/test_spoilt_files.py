"""Every reader given spoilt files: each is accepted, or refused in one sentence.

Files are spoilt by a seed that Hypothesis draws. ``--hypothesis-profile=long`` gives every reader
thousands of them.
"""

import random
import shutil
import subprocess
import sys
import time

import pytest
from hypothesis import given, note, settings
from hypothesis import strategies as st

from quasistatic_ref import QuasistaticError
from tests.errors.readers import FAMILIES
from validation.make.hostile_files import STRACE, opened_elsewhere

SECONDS = 10.0
"""Of the processor that a file may take [s]."""
LONGEST = 2000
"""Most characters of a sentence."""
SHARE = 5
"""One in so many of the profile's examples: there are many readers."""


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_a_spoilt_file_is_accepted_or_refused_in_a_sentence(tmp_path, family):
    for name, reader in family(tmp_path).items():
        path = tmp_path / reader.file
        for good in reader.good:
            path.write_bytes(good)
            reader.read(path)
        spoilt_files_read(name, reader, path)
        path.write_bytes(reader.good[0])


@pytest.mark.skipif(shutil.which("strace") is None, reason="strace says what is opened")
def test_what_a_process_opens_outside_of_its_folder_is_seen(tmp_path):
    """``validation.make.hostile_files`` reads what strace writes of Python, C and children."""
    outside = tmp_path / "outside" / "c.xyz"
    outside.parent.mkdir()
    outside.write_text("0 0 0")
    log = tmp_path / "log"
    mark = "try: open('/proc/self/file {}')\nexcept OSError: pass\n"
    by_child = f"import subprocess as s; s.run(['cat', '{outside}'], stdout=s.DEVNULL)\n"
    for opens in (f"open('{outside}').close()\n", by_child):
        script = mark.format(1) + opens + mark.format(2) + f"open('{log}').close()"
        subprocess.run([*STRACE, "-o", str(log), sys.executable, "-S", "-c", script], check=True)
        assert opened_elsewhere(log) == {1: str(outside)}


def spoilt_files_read(name, reader, path):
    """Read spoilt files, as many as the profile of Hypothesis says."""

    @settings(max_examples=max(settings().max_examples // SHARE, 1))
    @given(seed=st.integers(0, 2**32))
    def read(seed):
        rng = random.Random(seed)
        path.write_bytes(reader.form(rng, rng.choice(reader.good)))
        note(f"{name}, {path}")
        begun = time.process_time()
        try:
            reader.read(path)
        except QuasistaticError as refusal:
            sentence = str(refusal)
            assert sentence
            assert "\n" not in sentence
            assert "bad_alloc" not in sentence
            assert len(sentence) <= LONGEST
        assert time.process_time() - begun < SECONDS

    read()

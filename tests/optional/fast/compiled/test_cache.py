"""The folder of the compiled library: only what is mine, whole and closed to others is loaded."""

import os
import subprocess
import sys

import pytest

from quasistatic_ref.formats.quoting import clipped
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.optional.fast.compiled.cache import Cache, CompileError
from tests.optional.fast.compiled.test_fast import needs_compiler
from validation.tools.scripts import ROOT

KEY = "0123456789abcdef"


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache, in which `kept` has put a library of some bytes."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return Cache(KEY)


def kept_library(cache):
    made = cache.folder / "made.so"
    made.write_bytes(b"a library")
    return cache.keep(made)


def test_what_is_kept_is_found_by_the_next_process(cache):
    file = kept_library(cache)
    assert Cache(KEY).library() == file
    assert file.stat().st_mode & 0o777 == 0o700
    assert Cache("f" * 16).library() is None


def cut_short(file):
    file.write_bytes(file.read_bytes()[:3])


def empty_file(file):
    file.write_bytes(b"")


def flip_bit(file):
    text = bytearray(file.read_bytes())
    text[4] ^= 1
    file.write_bytes(text)


def fifo(file):
    file.unlink()
    os.mkfifo(file)


def link(file):
    other = file.with_name("other")
    file.rename(other)
    file.symlink_to(other)


def writable(file):
    file.chmod(0o722)


@pytest.mark.parametrize("spoil", [cut_short, empty_file, flip_bit, fifo, link, writable])
def test_a_library_that_is_not_what_was_kept_is_removed(cache, spoil):
    file = kept_library(cache)
    spoil(file)
    assert cache.library() is None
    assert not os.path.lexists(file)


def test_a_folder_in_the_place_of_the_library_is_refused(cache):
    file = kept_library(cache)
    file.unlink()
    (file / "more").mkdir(parents=True)
    with pytest.raises(CompileError, match=r"is not a library of this user, and cannot be removed"):
        cache.library()


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o707])
def test_a_folder_in_which_others_may_write_is_refused(cache, mode):
    """Another user could put a library there, or exchange the one that is kept."""
    kept_library(cache)
    cache.folder.chmod(mode)
    with pytest.raises(CompileError, match=r"^others may write in .* by chmod go-w$"):
        Cache(KEY)


def test_a_link_in_the_place_of_the_folder_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "quasistatic_ref").symlink_to("elsewhere")
    with pytest.raises(CompileError, match="is no folder"):
        Cache(KEY)


def test_a_folder_of_another_user_is_refused(cache, monkeypatch):
    other = os.stat(cache.folder).st_uid + 1
    monkeypatch.setattr("os.getuid", lambda: other)
    monkeypatch.setattr("os.geteuid", lambda: other)
    with pytest.raises(CompileError, match="belongs to another user"):
        Cache(KEY)


def test_a_load_that_does_not_end_is_known_to_the_next_process(cache):
    ends_the_process = (
        "import os\n"
        "from quasistatic_ref.optional.fast.compiled.cache import Cache\n"
        f"with Cache({KEY!r}).loading():\n"
        "    os._exit(9)\n"
    )
    assert not cache.was_left()
    assert subprocess.run([sys.executable, "-c", ends_the_process], check=False).returncode == 9
    assert cache.was_left()
    with cache.loading():
        pass
    assert not cache.was_left()


IN_A_PROCESS = (
    "from quasistatic_ref.optional.fast.compiled.library import why_not; print(why_not())"
)


def reason(folder, command):
    """Why a process with this cache and compiler has no library; and what it says."""
    settings = {"XDG_CACHE_HOME": str(folder), "QUASISTATIC_REF_CC": command}
    done = subprocess.run(
        [sys.executable, "-c", IN_A_PROCESS],
        cwd=ROOT, env=os.environ | settings, capture_output=True, text=True, timeout=100,
        check=True,
    )  # fmt: skip
    return done.stdout.strip(), done.stderr


@needs_compiler
def test_a_library_that_ends_the_process_is_tried_in_another_one_and_replaced(tmp_path):
    """Its bytes are those that were kept: another machine may have made them."""
    script = tmp_path / "cc"
    script.write_text("#!/bin/sh\nexit 1\n")
    script.chmod(0o755)
    folder = tmp_path / "quasistatic_ref"
    folder.mkdir(mode=0o700)
    crash = tmp_path / "crash.c"
    crash.write_text("__attribute__((constructor)) void f(void) { __builtin_trap(); }")
    made = folder / "made.so"
    subprocess.run([*library.compiler(), "-shared", "-fPIC", "-o", made, crash], check=True)
    with pytest.MonkeyPatch.context() as here:
        here.setenv("XDG_CACHE_HOME", str(tmp_path))
        Cache(library.key([str(script)])).keep(made)
    with pytest.raises(subprocess.CalledProcessError):
        reason(tmp_path, str(script))
    why, said = reason(tmp_path, str(script))
    assert "the library is replaced: it was ended by signal" in said
    assert why == clipped(f"{script} could not compile it: without a word")

"""The compiled library: what is said where it cannot be made, is missing, or is another's."""

import cffi
import pytest

from quasistatic_ref.optional.compiled import build, library
from tests.processes import printed_text

AN_ERROR = r"""sh -c 'printf "\377 an error\n" >&2; exit 1'"""
REASONS = {
    "$CC cannot be read as a command: No closing quotation": {"CC": "gcc '"},
    "/nowhere/cc cannot be run: No such file or directory": {"CC": "/nowhere/cc"},
    "false could not compile it: exit status 1": {"CC": "false"},
    "sh could not compile it: \ufffd an error": {"CC": AN_ERROR},
    "true could not compile it: exit status 0": {"CC": "true"},
    "there was no C compiler, cc or $CC": {"PATH": "/nowhere"},
    "QUASISTATIC_REF_COMPILED was 0": {build.VARIABLE: "0"},
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder in which libraries are made and sought in the place of the package's."""
    for name in ("CC", build.VARIABLE):
        monkeypatch.delenv(name, raising=False)
    for module in (build, library):
        monkeypatch.setattr(module, "LIBRARY", tmp_path / "compiled.so")
        monkeypatch.setattr(module, "PROBLEM", tmp_path / "not_compiled.txt")
    library._loaded.cache_clear()
    yield tmp_path
    library._loaded.cache_clear()


def test_compiled_code_is_of_the_sources_that_stand_here():
    why = library.missing() or ""
    assert "other sources" not in why, f"{why}: python quasistatic_ref/optional/compiled/build.py"


@pytest.mark.parametrize("reason", REASONS)
def test_a_library_that_is_not_made_leaves_the_reason(folder, reason):
    with pytest.MonkeyPatch.context() as patch:
        for name, value in REASONS[reason].items():
            patch.setenv(name, value)
        assert build.build() == folder / "not_compiled.txt"
    assert [file.name for file in folder.iterdir()] == ["not_compiled.txt"]
    when = "it was not compiled when the package was installed: "
    assert library.missing() == when + reason


@pytest.mark.extra("compiled")
def test_a_library_that_is_made_is_loaded_and_one_of_other_sources_is_not(folder, monkeypatch):
    assert build.build() == folder / "compiled.so"
    assert library.missing() is None
    assert [file.name for file in folder.iterdir()] == ["compiled.so"]
    library._loaded.cache_clear()
    monkeypatch.setattr(library, "digest", lambda: "of other sources")
    assert library.missing().startswith("it was compiled from other sources than those here")


def test_a_file_that_is_no_library_is_not_loaded(folder):
    (folder / "compiled.so").write_bytes(b"not a library")
    assert library.missing().startswith("it cannot be loaded: ")


def test_a_package_that_was_copied_says_so(folder):
    assert library.missing().endswith("installed: the package was copied")


def test_no_flag_comes_from_the_environment(folder, monkeypatch):
    """Products and sums stay apart whatever CFLAGS says: an echo in the compiler's place."""
    monkeypatch.setenv("CFLAGS", "-ffast-math")
    monkeypatch.setenv("CC", "sh -c 'echo error: $* >&2; exit 1' sh")
    build.build()
    reason = library.missing()
    assert "-ffp-contract=off" in reason
    assert "fast-math" not in reason


def test_the_declarations_are_what_cffi_makes_of_the_header(tmp_path):
    """``declared.py`` is committed, so that who installs needs no parser of C."""
    ffi = cffi.FFI()
    ffi.cdef((build.FOLDER / "declared.h").read_text("utf-8"))
    ffi.set_source("declared", None)
    ffi.emit_python_code(str(tmp_path / "declared.py"))
    made = (tmp_path / "declared.py").read_text("utf-8")
    assert made == (build.FOLDER / "declared.py").read_text("utf-8"), "make it again in this way"


def test_without_cffi_there_is_no_compiled_code_and_the_reason_is_said():
    """A light installation has NumPy and python-flint alone. In a process of its own."""
    asked = printed_text(
        "import sys",
        "sys.modules['_cffi_backend'] = None",
        "from quasistatic_ref.optional.compiled import library",
        "library.LIBRARY = __import__('pathlib').Path(library.__file__)  # a file that is there",
        "print(library.missing())",
    )
    assert asked == "cffi, which calls it, is not installed"

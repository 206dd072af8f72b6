"""Wrong provers that the self-test has to refuse: ``python -m validation.make.prover_mutants``.

Each operator of the C files that prove optima is replaced by another one, one at a time, as a wrong
compiler would. Each such library is compiled and tested like a new one (``selftest.py``), in a
process of its own. Compilers that change float64, and five that get one operation of integers
wrong, are tried, too. The page (``--out``) counts the libraries that are refused, and those of
which ``prover_mutants.toml`` says why they change no answer, and lists the others. Outcomes are
added to a file (``--kept``), with which the same command goes on where it was ended, as long as
sources and self-test are the same; with ``--known`` nothing more is tried. ``--every`` N takes one
operator of N; with ``--compilers`` what is said of a sample of them is printed as JSON. Exit status
1 if one passes without a reason. Takes hours.
"""

import hashlib
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

from quasistatic_ref.optional.fast.compiled import library, selftest
from quasistatic_ref.optional.fast.compiled.known_steps import known_steps
from validation.tools.scripts import ROOT, script_options, show_page

FILES = (
    "fixed_point.h", "rounding.c", "span.c", "kkt.c", "certificate.c", "groups.c", "contraction.c",
    "zeros.c", "walk.c",
)  # fmt: skip
"""Those that prove."""
REASONS = ROOT / "validation" / "make" / "prover_mutants.toml"
"""Of each file, lines, functions or all (``*``) that are not refused, and why these mutants change
no answer."""
SECONDS = 4
"""A mutant that takes longer of the processor does not end, and is refused."""
PATIENCE = 120
"""The same by the clock [s]: a mutant may sleep."""
BYTES = 4 << 30
"""Of memory, lest a mutant takes all."""
OTHER = {
    "+": "-", "-": "+", "*": "+", "/": "*", "%": "/", "<<": ">>", ">>": "<<", "&": "|", "|": "&",
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&",
    "+=": "-=", "-=": "+=", "|=": "&=", "&=": "|=", "++": "--", "--": "++",
}  # fmt: skip
TOKEN = re.compile(
    r"/\*.*?\*/|^#.*?$|'.'|->|<<|>>|&&|\|\||\+\+|--|[-+*/%&|<>=!]=|\w+(?:\.\w*)?(?:p[-+]\d+)?|[-+*/%&|<>]",
    re.DOTALL | re.MULTILINE,
)
DEFINED = re.compile(r"^\w[^;{}()]*?(\w+)\([^;{}]*\)\s*\{", re.MULTILINE)
"""Where a function begins."""
WRONG_COMPILERS = {
    "the low half of a product": (
        "to[j] += above + (__int128)digit[j] * low;",
        "to[j] += above + (((__int128)digit[j] * low) ^ ((digit[j] & low & 1024) != 0));",
    ),
    "the high half of a product": (
        "above = (__int128)digit[j] * high;",
        "above = (__int128)digit[j] * (int32_t)high;",
    ),
    "a carry": (
        "__int128 digit = sum->d[j] + carry;",
        "__int128 digit = sum->d[j] + (int64_t)(carry << 32 >> 32 << 32 >> 32) % (1 << 20);",
    ),
    "a borrow": (
        "carry = (digit + ((__int128)1 << (BITS - 1))) >> BITS;",
        "carry = (digit + ((__int128)1 << (BITS - 1))) / ((__int128)1 << BITS);",
    ),
    "the sign of a slack": (
        "m->refuted |= value(&x) < 0.0;",
        "m->refuted |= value(&x) < -1e300;",
    ),
}
"""What a compiler gets wrong: a text of the sources, and what it computes in its place."""

FLAGS = {
    "": "", "-O0": "", "-march=native": "",
    "-ffast-math": "x / ",  # by y or by 3, as the compiler likes
    "-ffp-contract=fast -mfma": "x y + z",
    "-fassociative-math -fno-signed-zeros -fno-trapping-math": "x + y - x",
    "-freciprocal-math": "x / 3",
    "-ffinite-math-only": "x == x",
    "-fno-signed-zeros": "0 - x",
    "-fsingle-precision-constant": "0.1 x",
}  # fmt: skip
"""After the package's own, and the first operation of which they change the bits, if any."""
COLUMNS = ("refused", "same code", "harmless", "passed", "not tried")
SAMPLE = ("-freciprocal-math", "a borrow")
"""Those that a test tries."""

PAGE = """# Wrong provers, and the self-test of the compiled library

Written by `python -m validation.make.prover_mutants --out FILE`. Operators of the C files that
prove optima, each replaced by another one. `refused`: the self-test has found a difference, the
library ended the process, or it did not end. `same code`: the compiler makes the same code of both.
`harmless`: `validation/make/prover_mutants.toml` says why it changes no answer. `passed`: no known
step shows what it changes. `not tried`: no outcome is kept; some of these do not compile.

| file | mutants | refused | same code | harmless | passed | not tried |
|---|---|---|---|---|---|---|
{counts}

Compilers, the first ones right, that change float64, or get an operation of 128-bit integers or a
sign wrong:

| compiler | outcome |
|---|---|
{compilers}

## Those that pass

| file | how many | in lines |
|---|---|---|
{left}
"""


class Mutant(NamedTuple):
    """A file of which one operator is another one.

    Parameters
    ----------
    file : str
    line : int
        Counted from 1.
    function : str
    code : str
        That line, mutated.
    text : str
        All of the file.
    """

    file: str
    line: int
    function: str
    code: str
    text: str


def mutants(file: str, every: int) -> Iterator[Mutant]:
    """One operator of so many of a file, replaced."""
    text = (library.SOURCE / file).read_text()
    found = [match for match in TOKEN.finditer(text) if match[0] in OTHER]
    for match in found[::every]:
        changed = text[: match.start()] + OTHER[match[0]] + text[match.end() :]
        line = text.count("\n", 0, match.start())
        function = [*DEFINED.finditer(text, 0, match.start())]
        name = function[-1][1] if function else ""
        yield Mutant(file, line + 1, name, changed.splitlines()[line].strip(), changed)


class Builder:
    """Libraries of changed sources; files that did not change are compiled once.

    Parameters
    ----------
    folder : Path
        Of what is made.
    plainly : str
        How files are compiled that did not change.
    """

    def __init__(self, folder: Path, plainly: str = "-O1") -> None:
        self.folder = folder
        self.plainly = plainly
        self.plain = {}
        for file in library.SOURCE.glob("*.[ch]"):
            (folder / file.name).write_text(file.read_text())
        self.objects = sorted(file.stem for file in library.SOURCE.glob("*.c"))
        assert self.compiles(self.objects, plainly)
        self.plain = {name: (folder / f"{name}.o").read_bytes() for name in self.objects}
        self.of_header = [
            name
            for name in self.objects
            if re.search('"(proof|forces).h"', (folder / f"{name}.c").read_text())
        ]

    def compiles(self, names: list[str], more: str) -> bool:
        """Compile some files, with `more` flags than the package's; whether that is done."""
        flags = [*(flag for flag in library.FLAGS if flag != "-shared"), *more.split()]
        files = [f"{name}.c" for name in names]
        strict = ["-Werror=incompatible-pointer-types", "-Werror=int-conversion", "-w"]
        command = [*library.compiler(), *flags, *strict, "-c", *files]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, check=False)
        return done.returncode == 0

    def outcome(self, file: str, text: str, more: str = "-O0") -> str:
        """What a library comes to of which a file is changed, or compiled with other flags.

        Returns
        -------
        str
            Why it is not used; empty if it is.
        """
        changed = self.folder / file
        before = changed.read_text()
        names = self.of_header if file.endswith(".h") else [changed.stem]
        try:
            changed.write_text(text)
            if not self.compiles(names, more):
                return "does not compile"
            out = self.folder / "mutant.so"
            objects = [f"{name}.o" for name in self.objects]
            linking = [*library.compiler(), "-shared", "-o", str(out), *objects, "-lm"]
            subprocess.run(linking, cwd=self.folder, check=True)
            said = selftest_words(out)
            if said or text == before:
                return said
            self.compiles(names, self.plainly)
            made = [(self.folder / f"{name}.o").read_bytes() for name in names]
            return "same code" if made == [self.plain[name] for name in names] else ""
        finally:
            changed.write_text(before)
            for name in names:
                (self.folder / f"{name}.o").write_bytes(self.plain[name])

    def compiler(self, name: str) -> str:
        """What the self-test says with a compiler."""
        if name in FLAGS:
            return self.outcome("arithmetic.c", (library.SOURCE / "arithmetic.c").read_text(), name)
        right, wrong = WRONG_COMPILERS[name]
        file = next(f for f in FILES if right in (library.SOURCE / f).read_text())
        return self.outcome(file, (library.SOURCE / file).read_text().replace(right, wrong))


def selftest_words(file: Path) -> str:
    """What the self-test says of a library, its proofs first; empty if it passes."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        signal.alarm(PATIENCE)
        try:
            library.chosen = str(file)
            found = selftest.wrong_proof() or selftest.wrong_parts(str(file)) or ""
        except BaseException as failure:  # whatever ends the process is no pass
            found = f"{type(failure).__name__}: {failure}"
        os.write(writing, found.encode()[:4000])
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as said:
        words = said.read()
    status = os.waitpid(child, 0)[1]
    return f"it was ended by signal {status}" if status else words


class Kept:
    """Outcomes of these sources and this self-test, each in a line of a file.

    Parameters
    ----------
    file : Path or None
        None keeps them in this process alone.
    """

    def __init__(self, file: Path | None) -> None:
        self.file = file
        parts = sorted(library.SOURCE.glob("*.[ch]"))
        parts += [library.SOURCE.parent / name for name in library.TESTED_BY]
        self.of = hashlib.sha256(b"".join(part.read_bytes() for part in parts)).hexdigest()
        lines = file.read_text().splitlines() if file and file.exists() else []
        every = [json.loads(line) for line in lines]
        self.known = {name: said for of, name, said in every if of == self.of}

    def outcome(self, name: str, found: Callable[[], str]) -> str:
        """The outcome of a name: what is known of it, or is found now."""
        if name not in self.known:
            self.known[name] = found()
            if self.file:
                with self.file.open("a") as lines:
                    print(json.dumps([self.of, name, self.known[name]]), file=lines)
        return self.known[name]


def of_file(
    builder: Builder, file: str, every: int, kept: Kept, known: bool
) -> tuple[str, list[str], int]:
    """The row of a file, that of its mutants that pass, and how many these are."""
    reasons = tomllib.loads(REASONS.read_text()).get(file, {})
    kinds = Counter()
    lines = []
    for one in mutants(file, every):
        name = f"{file} {one.line} {hashlib.sha256(one.text.encode()).hexdigest()}"
        if known and name not in kept.known:
            kinds["not tried"] += 1
            continue
        said = kept.outcome(name, partial(builder.outcome, one.file, one.text))
        if said == "does not compile":
            continue
        known_to_be = {one.code, one.function, "*"} & {*reasons}
        passes = "harmless" if known_to_be else "passed"
        kinds[said if said == "same code" else "refused" if said else passes] += 1
        if not said and passes == "passed":
            lines.append(str(one.line))
            print(file, one.line, one.code, file=sys.stderr, flush=True)
    cells = [kinds[kind] for kind in COLUMNS]
    row = f"| {file} | {kinds.total()} | {' | '.join(map(str, cells))} |"
    print(row, file=sys.stderr, flush=True)
    left = [f"| {file} | {len(lines)} | {', '.join(lines)} |"] if lines else []
    return row, left, len(lines)


def main() -> int:
    """Try all; exit status 1 if a wrong library passes without a reason."""
    options = script_options(__doc__, every=1, compilers=False, known=False, kept=Path, out=Path)
    known_steps()  # once, for all that are forked
    with tempfile.TemporaryDirectory() as folder:
        builder = Builder(Path(folder), "-O0" if options.compilers else "-O1")
        if options.compilers:
            print(json.dumps({name: builder.compiler(name) for name in SAMPLE}))
            return 0
        kept = Kept(options.kept)
        said = {
            name: kept.outcome(name, partial(builder.compiler, name))
            for name in (*FLAGS, *WRONG_COMPILERS)
        }
        rows = [
            of_file(builder, file, options.every, kept, options.known) for file in sorted(FILES)
        ]
    passed = sum(count for *_, count in rows) + sum(not said[name] for name in WRONG_COMPILERS)
    page = PAGE.format(
        counts="\n".join(row for row, *_ in rows),
        compilers="\n".join(
            f"| {shown_flags(name)} | {words[:80] or 'passes'} |" for name, words in said.items()
        ),
        left="\n".join(line for _, left, _ in rows for line in left),
    )
    show_page(page, options.out)
    return int(passed > 0)


def shown_flags(flags: str) -> str:
    """Flags in a table."""
    return flags or "no more flags"


if __name__ == "__main__":
    sys.exit(main())

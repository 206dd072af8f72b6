"""Compilers and caches that are not as they should be, and what steps come to with them.

Part of :mod:`validation.make.environments`. Each is tried in a process and a cache of its own; that
process is this module, with the name of what is tried.
"""

import hashlib
import json
import os
import pwd
import subprocess
import sys
import tempfile
from pathlib import Path

from quasistatic_ref import load_scenario, standard_form
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.optional.fast.compiled.library import why_not
from validation.tools.scripts import ROOT

STEPS = 10
PATIENCE = 600.0
"""What a compiler is given [s]; one that hangs, 1 s."""
LONGEST = 1200.0
"""A process that takes longer hangs [s]."""

FLAGS = ("", "-O0", "-march=native", "-ffast-math", "-mfpmath=387", "-fvisibility=hidden")
"""Before the package's own."""
LAST_FLAGS = ("-mfma -ffp-contract=fast", "-ffast-math")
"""After them, by a wrapper. Further flags are in the tests of the self-test."""
OUT = 'while [ "$1" != -o ]; do shift; done; '
ON_LOAD = (
    """echo '__attribute__((constructor)) void f(void) { %s }' > "$0.c"; exec gcc "$@" "$0.c" """
)
SCRIPTS = {
    "ends without a library": "exit 0",
    "fails without a word": "exit 1",
    "fails with bytes that are not UTF-8": r"printf '\377\376 error \200\n' >&2; exit 1",
    "fails with a million letters": "head -c 1000000 /dev/zero | tr '\\0' e >&2; exit 1",
    "kills itself": "kill -9 $$",
    "hangs": "sleep 1000",
    "hangs and ignores signals": "trap '' TERM INT HUP; sleep 1000 & wait; sleep 1000",
    "removes the cache": 'rm -rf "$XDG_CACHE_HOME"',
    "writes no library": f"{OUT}echo nonsense > $2",
    "writes a library without the symbols": f"{OUT}echo 'int x;' | gcc -shared -fPIC -x c - -o $2",
    "writes a library that crashes": ON_LOAD % "__builtin_trap();",
    "writes a library that hangs": ON_LOAD % "for (;;);",
    "writes a library that sets FTZ": ON_LOAD % "__builtin_ia32_ldmxcsr(0x9fc0);",
}
COMMANDS = {
    "an unbalanced quote": "gcc '-O3",
    "a lone backslash": "gcc \\",
    "no such file": "/nowhere/cc",
    "a folder": "/tmp",
    "an empty name": "''",
    "a program that reads": "cat",
}


def no_passwd_entry() -> None:
    """As in a container that runs under any number."""

    def unknown(_: int) -> None:
        raise KeyError

    pwd.getpwuid = unknown  # type: ignore[assignment]  # a fault planted in the standard library
    for name in ("HOME", "XDG_CACHE_HOME"):
        os.environ.pop(name, None)


def cache() -> Path:
    """The folder of the library."""
    return Path(os.environ["XDG_CACHE_HOME"]) / "quasistatic_ref"


def read_only() -> None:
    """A cache in which nobody may write, not even root by its rights."""
    cache().mkdir()
    cache().chmod(0o555)
    user = os.geteuid()
    if user == 0:
        os.seteuid(65534)
    why_not()
    os.seteuid(user)


def file_for_folder() -> None:
    """A file where the cache should be."""
    cache().write_text("")


def put_in_cache(text: bytes) -> None:
    """A library in the cache that is not what was compiled."""
    command = [
        sys.executable,
        "-c",
        "from quasistatic_ref.optional.fast.compiled.library import why_not; why_not()",
    ]
    subprocess.run(command, cwd=ROOT, capture_output=True, check=True)
    (file,) = cache().iterdir()
    file.write_bytes(text)


def kept_without_symbols() -> None:
    """Any other library."""
    named = subprocess.check_output(["gcc", "-print-file-name=libm.so.6"], text=True)
    put_in_cache(Path(named.strip()).read_bytes())


CACHES = {
    "no home and no passwd entry": no_passwd_entry,
    "a cache that cannot be written": read_only,
    "a file for the cache": file_for_folder,
    "nonsense in the cache": lambda: put_in_cache(b"nonsense" * 1000),
    "another library in the cache": kept_without_symbols,
}
PLAIN = "no compiler"


def environments(folder: Path) -> dict[str, str]:
    """The command of each, which for caches is the compiler that would be taken anyhow."""
    found = {PLAIN: "none"}
    found |= {f"gcc {flags}".strip(): f"gcc {flags}" for flags in FLAGS}
    scripts = {f"gcc ... {flags}": f'exec gcc "$@" {flags}' for flags in LAST_FLAGS}
    scripts |= {f"a compiler that {name}": text for name, text in SCRIPTS.items()}
    for i, (name, text) in enumerate(scripts.items()):
        file = folder / f"cc{i}"
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)
        found[name] = str(file)
    return found | COMMANDS | dict.fromkeys(CACHES, "gcc")


def steps_of(environment: str) -> dict[str, str | None]:
    """Why nothing is compiled in an environment, and the hash of what is unique of a few steps."""
    if environment in CACHES:
        CACHES[environment]()
    library.PATIENCE = 1.0 if "hangs" in environment else PATIENCE
    made = hashlib.sha256()
    for name in ("bunny_grasp", "sphere_spin"):
        scenario = load_scenario(name, fast=True)
        simulator = scenario.simulator()
        q = scenario.system.q_start
        for k in range(STEPS):
            result = simulator.step(q, scenario.targets(scenario.h * (k + 1)))
            q = result.q
            for array in (q, result.solution.delta_q, *standard_form(result.step)):
                made.update(array.tobytes())
    return {"why": why_not(), "steps": made.hexdigest()}


def steps_in(name: str, command: str) -> dict[str, str | None]:
    """The same from a process of its own; ``{"broke": ...}`` where that does not end well."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)  # for the other user of `read_only`
        settings = {"QUASISTATIC_REF_CC": command, "XDG_CACHE_HOME": folder}
        try:
            done = subprocess.run(
                [sys.executable, "-m", "validation.make.broken_compilers", name],
                cwd=ROOT, env=os.environ | settings, capture_output=True, text=True,
                timeout=LONGEST, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return {"broke": "it hangs"}
    if done.returncode:
        return {"broke": f"status {done.returncode}: {done.stderr[-300:]}"}
    return json.loads(done.stdout.replace(folder, "CACHE"))


def compiler_lines() -> list[str]:
    """Lines of the table: what each environment came to."""
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        every = environments(Path(folder))
        right = steps_in(PLAIN, every[PLAIN])["steps"]
        for name, command in every.items():
            found = steps_in(name, command)
            said = found.get("broke", found.get("why"))
            if "broke" in found or found["steps"] != right:
                said = f"BROKE: {said}"
            text = (
                "compiled"
                if said is None
                else said.replace(folder, "...").replace(f"{ROOT}/", "").replace("|", " ")
            )
            lines.append(f"| {name} | {' '.join(text.split())} |")
            print(lines[-1], file=sys.stderr, flush=True)
    return lines


if __name__ == "__main__":
    print(json.dumps(steps_of(sys.argv[1])))

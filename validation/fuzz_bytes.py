"""Fuzzing by bytes: atheris changes good TOML, JSON, XML and trajectory files at will.

Each reader runs in a process of its own, which is started again when it ends: libraries in C++
could end it. An input is a finding if it raises anything but a plain error, ends the process,
takes longer than 10 s, or more than 2 GiB.

    pip install "quasistatic-ref[fuzz]"
    python -m validation.fuzz_bytes --seconds 60
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

SLOWEST = 10
"""No input may take longer [s]."""
LARGEST = 20_000
"""Largest input [bytes]."""
RAISED = "raised.txt"
"""Where a worker leaves a word on what it raised."""
Target = Callable[[bytes], None]


def toml_target(folder: Path) -> Target:
    """Scenario files, loaded; `sphere.urdf` lies beside them."""
    from quasistatic_ref.resources import models_folder
    from quasistatic_ref.simulate.scenario import load_scenario

    urdf = models_folder() / "sphere_spin" / "sphere.urdf"
    (folder / "sphere.urdf").write_bytes(urdf.read_bytes())

    def run(path: Path) -> None:
        load_scenario(path)

    return _reader(folder / "scene.toml", run)


def step_target(folder: Path) -> Target:
    """Step files, read."""
    from quasistatic_ref.step.files import step_read

    return _reader(folder / "step.json", step_read)


def solution_target(folder: Path) -> Target:
    """Solution files of a good step, read and verified."""
    from quasistatic_ref.cli.verify import refutation
    from quasistatic_ref.step.files import step_read
    from quasistatic_ref.step.solution_files import solution_read
    from validation.fuzz_seeds import step_text

    good = folder / "good.json"
    good.write_text(step_text())
    step = step_read(good)
    return _reader(folder / "x.json", lambda path: refutation(step, solution_read(path, step)))


def urdf_target(folder: Path) -> Target:
    """URDF files, loaded through pinocchio."""
    from quasistatic_ref.model.system import Body, System

    return _reader(folder / "r.urdf", lambda path: System([Body("r", path, "floating")]))


def cloud_target(folder: Path) -> Target:
    """Point clouds: the first byte chooses the kind of file."""
    from quasistatic_ref.model.clouds import point_cloud

    kinds = (".xyz", ".csv", ".ply", ".obj")
    readers = [_reader(folder / f"c{kind}", point_cloud) for kind in kinds]
    return lambda content: readers[content[0] % 4 if content else 0](content[1:])


def trajectory_target(folder: Path) -> Target:
    """Trajectory files, and the first step in them."""
    from quasistatic_ref.simulate.trajectory import trajectory_read

    return _reader(folder / "x.npz", lambda path: trajectory_read(path).step_data(0))


TARGETS = {
    "toml": toml_target,
    "step": step_target,
    "solution": solution_target,
    "urdf": urdf_target,
    "cloud": cloud_target,
    "trajectory": trajectory_target,
}


def _reader(path: Path, read: Callable[[Path], object]) -> Target:
    """A function of bytes that may raise nothing but what it should not."""
    from quasistatic_ref.errors import InputError

    def one(content: bytes) -> None:
        path.write_bytes(content)
        try:
            read(path)
        except InputError as refusal:
            sentence = str(refusal)
            if not sentence or "\n" in sentence:
                raise AssertionError(sentence) from refusal
        except Exception as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            where = f"{Path(last.filename).name}:{last.lineno}"
            raised = f"{type(error).__name__} in {where}: {error}"
            (path.parent / RAISED).write_text(raised)
            raise

    return one


def worker(name: str, folder: Path, arguments: list[str]) -> None:
    """Fuzz one target until libFuzzer ends the process."""
    import atheris

    with atheris.instrument_imports(include=["quasistatic_ref", "tomllib", "json"]):
        target = TARGETS[name](folder)
    atheris.Setup([sys.argv[0], *arguments], target)
    atheris.Fuzz()


def fuzzed(name: str, seconds: float, keep: Path | None = None) -> dict[str, Any]:
    """Fuzz one target for some time, in processes of its own."""
    from validation.fuzz_seeds import scratch, seeds

    inputs, found, end, number = 0, [], time.monotonic() + seconds, 0
    with scratch() as text:
        folder = Path(text)
        corpus, crashes = folder / "corpus", folder / "crashes"
        corpus.mkdir()
        crashes.mkdir()
        for i, content in enumerate(seeds(name)):
            (corpus / f"seed{i}").write_bytes(content)
        while (left := end - time.monotonic()) > 1:
            number += 1
            options = [
                f"-max_total_time={int(left)}", f"-timeout={SLOWEST}", "-rss_limit_mb=2048",
                f"-max_len={LARGEST}", f"-seed={number}", "-print_final_stats=1",
                "-close_fd_mask=3", f"-artifact_prefix={crashes}/", str(corpus),
            ]  # fmt: skip
            ended = subprocess.run(
                [sys.executable, "-m", "validation.fuzz_bytes", "--worker", name, text, *options],
                capture_output=True, text=True, errors="replace", check=False,
            )  # fmt: skip
            executed = re.findall(r"number_of_executed_units: (\d+)", ended.stderr)
            progress = re.findall(r"^#(\d+)\s", ended.stderr, re.MULTILINE)
            inputs += int((executed or progress or ["0"])[-1])
            for crash in crashes.iterdir():
                raised = folder / RAISED
                said = raised.read_text() if raised.exists() else _last_words(ended.stderr)
                raised.unlink(missing_ok=True)
                found.append({"kind": crash.name.split("-")[0], "said": said})
                if keep is not None:
                    keep.mkdir(exist_ok=True)
                    (keep / f"{name}-{crash.name}").write_bytes(crash.read_bytes())
                crash.unlink()
            if ended.returncode and not progress:
                raise RuntimeError(f"the worker did not start: {ended.stderr[-2000:]}")
    return {"target": name, "processes": number, "inputs": inputs, "found": found}


def _last_words(said: str) -> str:
    """What libFuzzer says of a process that ended without a word of its own."""
    return " | ".join(line for line in said.splitlines() if "ERROR" in line or "SUMMARY" in line)


def main() -> int:
    """Fuzz each target in turn, and print what came of it."""
    if sys.argv[1:2] == ["--worker"]:
        worker(sys.argv[2], Path(sys.argv[3]), sys.argv[4:])
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="in all")
    parser.add_argument("--target", choices=sorted(TARGETS), action="append")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="for inputs that failed")
    options = parser.parse_args()
    names = options.target or list(TARGETS)
    failures = 0
    for name in names:
        report = fuzzed(name, options.seconds / len(names), options.keep)
        failures += len(report["found"])
        print(json.dumps(report, indent=1), flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

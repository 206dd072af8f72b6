"""What commands write: streams, full disks, results that are there, runs that cannot be.

``python -m validation.make.outputs`` runs the command line as a user does, in folders of its own,
and looks at bytes alone: it shares no code with the package. Exit status 1 if anything was lost.
"""

import itertools
import json
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from validation.tools.scripts import asked, shown

PAGE = """# What commands write

Written by `python -m validation.make.outputs --count {count}`. Each line is a kind of output, how
many commands were tried, and what was lost: bytes that were there before, or an answer that was not
written whole though the command ended with status 0.

| what | commands | lost |
|---|---:|---|
"""
PROGRAM = f"{sys.executable} -m quasistatic_ref"
KEPT = "a line that was there\n"
URDF = """<robot name="ball"><link name="ball">
<inertial><mass value="0.3"/>
<inertia ixx="3e-4" iyy="3e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.05"/></geometry></collision></link></robot>"""
SCENE = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 4
[bodies.ball]
urdf = "ball.urdf"
base = "floating"
actuated = []
pose = { xyz = [0, 0, 0.05] }
[[bodies.ball.wrenches]]
t = 0.0
force = [0.1, 0, 0]
torque = [0, 0, 0.001]
[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }
[contacts.floor]
alpha = "floor"
beta = "ball"
mu_v = 0.5
mu_omega = 0.01
rows = 6
"""
SUNK = "--set 'bodies.ball.pose.xyz=[0, 0, -0.04]'"
"""0.09 m deep: the first step is beyond the limit of 0.05 m."""
LONG = "--set steps=600 --set record=light"
PATIENCE = 120.0
"""For a run to save its first steps [s]."""

Found = tuple[str, str, str]
"""The kind of output, the command, and what was lost, if anything."""


def shell(folder: Path, command: str) -> subprocess.CompletedProcess[str]:
    """A command of bash, in which SOLVE, RUN and PROGRAM stand for those of the package."""
    words = {
        "SOLVE": f"{PROGRAM} solve step.json",
        "RUN": f"{PROGRAM} run scene.toml --out out --quiet",
        "PROGRAM": PROGRAM,
    }
    for word, meaning in words.items():
        command = command.replace(word, meaning)
    return subprocess.run(
        ["bash", "-c", command], cwd=folder, capture_output=True, text=True, check=False
    )


def contents(folder: Path) -> dict[str, bytes]:
    """Every file of a folder."""
    paths = folder.rglob("*")
    return {str(p.relative_to(folder)): p.read_bytes() for p in paths if p.is_file()}


def prepared(folder: Path) -> str:
    """Write the scene, its first run, and a step of it: the text of that step's solution."""
    (folder / "ball.urdf").write_text(URDF)
    (folder / "scene.toml").write_text(SCENE)
    for command in ("RUN", "PROGRAM extract out/scene.npz --step 1 -o step.json"):
        assert shell(folder, command).returncode == 0
    return shell(folder, "SOLVE").stdout


STREAMS = {
    # command: the file in which its output is
    "SOLVE -o /dev/stdout >> log": "log",
    "SOLVE -o /dev/stderr 2>> log": "log",
    "SOLVE -o /proc/self/fd/1 >> log": "log",
    "SOLVE -o /proc/thread-self/fd/1 >> log": "log",
    "SOLVE -o /dev/fd/3 3>> log": "log",
    "{ SOLVE; SOLVE -o /dev/stdout; } >> log": "log",
    "ln -s /dev/stdout link; SOLVE -o link >> log; test -L link": "log",
    "SOLVE -o /dev/stdout | cat >> log": "log",
    "mkfifo fifo; cat fifo >> log & SOLVE -o fifo; wait; test -p fifo": "log",
    "SOLVE -o >(cat >> log); sleep 0.5": "log",
    "SOLVE -o /dev/null >> log; SOLVE >> log; test -c /dev/null": "log",
    "touch there; ln -s there link; SOLVE -o link; test -L link && cat there >> log": "log",
    "PROGRAM extract out/scene.npz --step 1 -o /dev/stdout >> log": "log",
}


def streams(folder: Path, solution: str) -> Iterator[Found]:
    """Pipes, devices and logs: what was there stays, and the output follows it."""
    step = (folder / "step.json").read_text()
    for command, name in STREAMS.items():
        (folder / name).write_text(KEPT)
        ended = shell(folder, command)
        text = (folder / name).read_text()
        wanted = step if "extract" in command else solution
        lost = "" if text.startswith(KEPT) else "what was there"
        lost = lost or ("" if wanted in text else "the output")
        lost = lost or ("" if ended.returncode == 0 else f"status {ended.returncode}")
        for file in ("link", "fifo", "there"):
            (folder / file).unlink(missing_ok=True)
        yield "pipes, devices, logs that are appended to", command, lost


FULL = (
    "SOLVE -o /dev/full",
    "SOLVE > /dev/full",
    "SOLVE -o /dev/stdout > /dev/full",
    "ulimit -f 0; SOLVE -o solution.json",
    "ulimit -f 0; RUN",
    "ulimit -f 0; RUN --save-every 0",
    "ulimit -f 0; PROGRAM run scene.toml --out new",
)


def full(folder: Path, _: str) -> Iterator[Found]:
    """Disks without room: status 2, and nothing that was there is changed."""
    (folder / "solution.json").write_text(KEPT)
    before = contents(folder)
    for command in FULL:
        ended = shell(folder, command)
        lost = "" if contents(folder) == before else "what was there"
        said = ended.stderr.strip().splitlines()
        plain = ended.returncode == 2 and said and said[-1].startswith("quasistatic-ref: ")
        yield "full disks", command, lost or ("" if plain else f"no sentence: {said[-1:]}")


OTHERS = {
    # command: its status
    "RUN": 0,
    "RUN --set steps=3": 2,
    f"RUN {SUNK}": 3,
    "RUN --set h=0": 2,
    "RUN --set contacts.floor.mu_v=-1": 2,
    "RUN --certify nonsense": 2,
    "RUN --backend nonsense": 2,
    "RUN --backend none --certify off": 2,
    "RUN --resume --set steps=2": 2,
    "RUN --sweep cone=pyramid,ellipsoid --backend daqp": 2,
    "RUN --sweep contacts.floor.mu_v=0.5,-1": 2,
    "PROGRAM run scene.toml --out out/scene.npz": 2,
    "cp ball.urdf out/scene.npz; RUN": 2,
}


def others(folder: Path, _: str) -> Iterator[Found]:
    """Results that are there: a command that does not end well changes none of them."""
    good = (folder / "out/scene.npz").read_bytes()
    for command, status in OTHERS.items():
        (folder / "out/scene.npz").write_bytes(good)
        setup, _, last = command.rpartition("; ")
        shell(folder, setup)
        before = contents(folder)
        ended = shell(folder, last)
        after = contents(folder)
        lost = [name for name in before if after.get(name) != before[name]]
        new = [name for name in after if name not in before and status == 2]
        said = "" if ended.returncode == status else f"status {ended.returncode}, not {status}"
        yield "results that are there", command, said or ", ".join(lost + new)
    (folder / "out/scene.npz").write_bytes(good)


def ended_by(folder: Path, _: str) -> Iterator[Found]:
    """Runs ended by a signal over a result, then resumed: the result stays until it is whole."""
    assert shell(folder, f"RUN {LONG}").returncode == 0
    good = contents(folder)["out/scene.npz"]
    words = f"{PROGRAM} run scene.toml --out out --quiet --save-every 0".split()
    long = LONG.split()
    for sent in (signal.SIGINT, signal.SIGKILL, signal.SIGTERM):
        part = folder / "out/scene.npz.part"
        deadline = time.monotonic() + PATIENCE
        process = subprocess.Popen([*words, *long], cwd=folder, stderr=subprocess.DEVNULL)
        while not list(part.glob("*.npz")) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(sent)
        process.wait()
        there = contents(folder)
        lost = "" if there["out/scene.npz"] == good else "the result"
        shorter = shell(folder, "RUN --resume --set steps=1 --set record=light")
        unlike = contents(folder) != there or shorter.returncode != 2
        lost = lost or ("saved steps, by a shorter run" if unlike else "")
        resumed = shell(folder, f"RUN {LONG} --resume")
        same = resumed.returncode == 0 and contents(folder)["out/scene.npz"] == good
        yield "runs ended by signals, and resumed", sent.name, lost or ("" if same else "bits")


BACKENDS = ("clarabel", "daqp", "osqp", "piqp", "scs", "proxqp", "highs", "quadprog", "none")
COUNT = 100
"""How many of the choices are tried, of 306."""
CHOICES = list(
    itertools.product(
        (*BACKENDS, *(f"qpsolvers:{name}" for name in BACKENDS[:-1])),
        (False, True),
        ("pyramid", "ellipsoid", "product"),
        ("full", "residual", "off"),
    )
)


SERVER = """
import json, sys
from quasistatic_ref.cli.main import main
for line in sys.stdin:
    print("STATUS", main(json.loads(line)), flush=True)
"""
"""One process for many commands: most of the time of a command is its imports."""


def choices(folder: Path, count: int) -> Iterator[Found]:
    """Backends, speeds, cones and certificates at random: `inspect` and `run` say the same.

    Where they refuse, nothing is written; where not, each step is solved or fails by itself, and a
    failed run leaves the result that is there.
    """
    server = subprocess.Popen(
        [sys.executable, "-c", SERVER], cwd=folder, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip

    def status(*arguments: str) -> int:
        print(json.dumps(arguments), file=server.stdin, flush=True)
        said = next(line for line in server.stdout or () if line.startswith("STATUS "))
        return int(said.removeprefix("STATUS "))

    for name, fast, cone, certify in random.Random(0).sample(CHOICES, count):
        fields = {"solver.backend": name, "solver.certify": certify, "cone": cone}
        fields |= {"fast": "true"} if fast else {}
        sets = [word for key, value in fields.items() for word in ("--set", f"{key}={value}")]
        looked = status("inspect", "scene.toml", *sets)
        before = contents(folder)
        ran = status("run", "scene.toml", "--out", "out", "--quiet", *sets)
        after = contents(folder)
        lost = ""
        if (looked == 2) != (ran == 2) or ran not in (0, 2, 3):
            lost = f"inspect ends with {looked}, run with {ran}"
        elif ran == 2 and after != before:
            lost = "files were written"
        elif ran == 3 and after["out/scene.npz"] != before["out/scene.npz"]:
            lost = "the result"
        yield "backend, speed, cone, certificate", " ".join(sets), lost
    server.communicate()


def found(count: int) -> Iterator[Found]:
    """Everything that was tried, `count` of the last kind."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        solution = prepared(folder)
        for kind in (streams, full, others):
            yield from kind(folder, solution)
        yield from choices(folder, count)
        yield from ended_by(folder, solution)


def page(tried: list[Found], count: int) -> str:
    """The result as Markdown."""
    lines = [PAGE.format(count=count)]
    for kind in dict.fromkeys(kind for kind, _, _ in tried):
        own = [(command, lost) for other, command, lost in tried if other == kind]
        bad = "; ".join(f"`{command}`: {lost}" for command, lost in own if lost)
        lines.append(f"| {kind} | {len(own)} | {bad or 'nothing'} |\n")
    return "".join(lines)


def main() -> int:
    """Write the page; 1 if something was lost."""
    options = asked(__doc__, count=COUNT, out=Path)
    tried = list(found(options.count))
    shown(page(tried, options.count), options.out)
    return int(any(lost for _, _, lost in tried))


if __name__ == "__main__":
    sys.exit(main())

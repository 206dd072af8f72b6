"""A committed result made again by its command, and how its files differ from the commit.

Files are compared as bytes, pictures by their pixels.
"""

import io
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import image

ROOT = Path(__file__).parents[2]
CLI = "quasistatic_ref.cli.main"


@dataclass(frozen=True)
class Result:
    """Something that is committed, and the command that makes it.

    Parameters
    ----------
    name : str
    command : tuple of str
        Arguments of ``python -m``, run in the root of the repository; ``{temporary}`` is a folder.
    writes : tuple of str
        Committed files or folders that it makes, relative to the root.
    copied : tuple of (str, str)
        What is copied after it from the temporary folder: a pattern, and a committed folder.
    output : str
        The committed file that keeps the command's standard output, if one does.
    """

    name: str
    command: tuple[str, ...]
    writes: tuple[str, ...]
    copied: tuple[tuple[str, str], ...] = ()
    output: str = ""

    @property
    def available(self) -> bool:
        """Whether its module, or that of its command, exists in this checkout."""
        module = self.command[0]
        file = ROOT / Path(*module.split(".")).with_suffix(".py")
        if module != CLI:
            return file.exists()
        commands = ROOT / "quasistatic_ref" / "lab" / "commands"
        return (commands / f"{self.command[1]}.py").exists()


def written(name: str, file: str) -> Result:
    """The result that ``python -m validation.make.<name> --out <file>`` writes."""
    return Result(name, (f"validation.make.{name}", "--out", file), (file,))


def printed(name: str, file: str) -> Result:
    """The result that ``python -m validation.make.<name>`` prints, kept in a file."""
    return Result(name, (f"validation.make.{name}",), (file,), output=file)


def made(result: Result) -> bool:
    """Run a result's command, and put what it made where it belongs; False if it failed."""
    with tempfile.TemporaryDirectory() as temporary:
        arguments = [argument.format(temporary=temporary) for argument in result.command]
        command = [sys.executable, "-m", *arguments]
        done = subprocess.run(
            command, cwd=ROOT, stdout=subprocess.PIPE if result.output else None, check=False
        )
        if done.returncode:
            return False  # what it would have written is left as it was
        if result.output:
            (ROOT / result.output).write_bytes(done.stdout)
        for pattern, folder in result.copied:
            for file in sorted(Path(temporary).glob(pattern)):
                shutil.copy(file, ROOT / folder / file.name)
    return True


def git(*arguments: str) -> bytes:
    """Standard output of a git command in the repository."""
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True).stdout


def changes(paths: tuple[str, ...]) -> list[str]:
    """One line for each committed file among these paths that is now another, new or gone."""
    said = git("status", "--porcelain", "-z", "--untracked-files=all", "--", *paths).decode()
    lines = []
    for entry in filter(None, said.split("\0")):
        state, name = entry[:2].strip(), entry[3:]
        if state == "??":
            lines.append(f"{name}: new")
        elif state == "D":
            lines.append(f"{name}: gone")
        elif name.endswith(".png"):
            lines += [f"{name}: {said}"] if (said := picture_change(name)) else []
        else:
            added, removed, _ = git("diff", "--numstat", "HEAD", "--", name).decode().split("\t")
            lines.append(f"{name}: {removed} lines are now {added} others")
    return lines


def picture_change(name: str) -> str:
    """How a picture differs from the committed one; nothing if all its pixels are the same."""
    before = image.imread(io.BytesIO(git("show", f"HEAD:{name}")), format="png")
    after = image.imread(ROOT / name)
    if before.shape != after.shape:
        (old_height, old_width), (height, width) = before.shape[:2], after.shape[:2]
        return f"{old_width} x {old_height} pixels are now {width} x {height}"
    share = float((np.abs(before - after).max(axis=2) > 0).mean())
    return f"{100 * share:.2f} % of its pixels differ" if share else ""

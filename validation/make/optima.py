"""Exact optima of public programs: validation/optima/optima.jsonl, and a file for each answer.

    python -m validation.make.optima NAME_OF_SET FOLDER

FOLDER has the set's files, .qps, .mps or .sif, read as decimals. Each program is solved in a
process of its own, the smallest file first, for at most SECONDS of the processor. Lines of earlier
runs stay where the file's hash is the same, and answers are there.
"""

import hashlib
import json
import math
import resource
import subprocess
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from flint import fmpq
from tqdm import tqdm

import quasistatic_ref as qr
from quasistatic_ref.exact.qp.numbers import as_fraction
from quasistatic_ref.exact.qp.substitution import exact_point
from quasistatic_ref.numbers.precision import nearest_fraction
from quasistatic_ref.optional.qp_files.load import file_programs
from quasistatic_ref.optional.qp_files.qps import qps_names
from quasistatic_ref.text.content import text_written

OPTIMA = Path(__file__).parents[1] / "optima" / "optima.jsonl"
SECONDS = 120
"""Of the processor, for a program [s]."""
LONGEST = 200
"""Characters of a fraction that is written whole; of longer ones its nearest float64 alone."""
MOST_CHARACTERS = 100_000
"""Of an answer in fractions; of longer ones the nearest float64 numbers are written."""
SUFFIXES = (".qps", ".mps", ".sif")
FIELDS = {"active", "least_norm", "direction"}


def main(of_set: str, folder: str) -> int:
    """Write the lines of a set."""
    lines = {(line["set"], line["name"]): line for line in read()}
    files = [path for path in Path(folder).iterdir() if path.suffix.lower() in SUFFIXES]
    for path in tqdm(sorted(files, key=lambda path: path.stat().st_size)):
        key = of_set, path.stem.upper()
        sha256 = hashlib.sha256(path.read_bytes()).hexdigest()
        line = lines.get(key, {"status": ""})
        answer_file = OPTIMA.parent / of_set / f"{key[1]}.json"
        if line.get("sha256") == sha256 and (line["status"] != "optimal" or answer_file.exists()):
            continue
        head = {"set": of_set, "name": key[1], "sha256": sha256}
        command = [sys.executable, "-m", "validation.make.optima", str(path)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode and done.returncode >= 0:
            print(f"{path.name}: {done.stderr.strip().splitlines()[-1]}")
            continue
        answer = json.loads(done.stdout or f'{{"status": "not ended in {SECONDS} s"}}')
        if (numbers := answer.pop("answer", None)) is not None:
            answer_file.parent.mkdir(exist_ok=True)
            text_written(answer_file, f"{json.dumps(numbers)}\n")
        lines[key] = head | answer
        text_written(OPTIMA, "".join(f"{json.dumps(line)}\n" for _, line in sorted(lines.items())))
    return 0


def read() -> list[dict[str, Any]]:
    """The lines that are there."""
    return [*map(json.loads, OPTIMA.read_text().splitlines())] if OPTIMA.exists() else []


def line_of(path: str) -> dict[str, Any]:
    """What is said of one program, by itself."""
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    (program,) = file_programs(path).values()
    names = qps_names(Path(path).read_text("utf-8", errors="replace"))
    rows = sum(len(getattr(program, name)) for name in ("G", "A"))
    size = {"n": len(program.q), "rows": rows}
    start = process_time()
    try:
        answer = qr.exact_qp(program)
    except qr.QPNotConvex:
        return size | {"status": "not convex"}
    except (qr.QPInfeasible, qr.QPUnbounded) as proof:
        return size | {"status": proof.status, "seconds": round(process_time() - start, 2)}
    seconds = process_time() - start
    x, multipliers = exact_point(program, {name: getattr(answer, name) for name in FIELDS})
    objective = exact_objective(program, [*map(as_fraction, x)])
    assert answer.obj == float(objective)
    return size | {
        "status": "optimal",
        "objective": answer.obj,
        "fraction": str(objective) if short(objective) else None,
        "x_unique": answer.x_unique,
        "multipliers_unique": answer.multipliers_unique,
        "seconds": round(seconds, 2),
        "active": [names[name] for name in answer.active],
        "answer": numbers_of(
            {name: v for name, v in zip(columns(names), x, strict=True) if v},
            {names[name]: v for name, v in multipliers.items()},
        ),
    }


def columns(names: dict[str, str]) -> list[str]:
    """The names of unknowns, in order."""
    return [name.removesuffix(" >=") for key, name in names.items() if key.startswith("lb")]


def numbers_of(x: dict[str, fmpq], multipliers: dict[str, fmpq]) -> dict[str, dict[str, Any]]:
    """What is not zero of an answer: fractions as texts, or of a long one the nearest float64."""
    every = {"x": x, "multipliers": multipliers}
    parts = [part for some in every.values() for v in some.values() for part in (v.p, v.q)]
    digits = sum(int(part).bit_length() for part in parts) * math.log10(2)
    write = str if digits + 10 * len(parts) <= MOST_CHARACTERS else nearest_fraction
    return {key: {name: write(v) for name, v in some.items()} for key, some in every.items()}


def short(v: Fraction) -> bool:
    """Whether a fraction is written whole."""
    bits = v.numerator.bit_length() + v.denominator.bit_length()
    return bits < 4 * LONGEST and len(str(v)) <= LONGEST


def exact_objective(program: qr.QuadraticProgram, x: list[Fraction]) -> Fraction:
    """The objective in fractions, of x in fractions, which holds every row by substitution."""
    constant = program.exact.get("constant", {}).get(0, program.constant)
    linear = sum((v * x[j] for (j,), v in entries(program, "q")), Fraction(constant))
    return linear + sum((v * x[i] * x[j] for (i, j), v in entries(program, "P")), Fraction(0)) / 2


def entries(program: qr.QuadraticProgram, name: str) -> Iterator[tuple[Any, Fraction]]:
    """Places and exact numbers of an array that are not zero."""
    array, others = getattr(program, name), program.exact.get(name, {})
    for place in np.flatnonzero(array).tolist():
        at = np.unravel_index(place, array.shape)
        yield at, Fraction(others.get(place, float(array.flat[place])))


if __name__ == "__main__":
    if len(sys.argv) == 2:
        print(json.dumps(line_of(sys.argv[1])))
    else:
        sys.exit(main(*sys.argv[1:]))

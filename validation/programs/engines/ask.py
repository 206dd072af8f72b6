"""One engine asked everything: ``python -m validation.programs.engines.ask MODULE``, JSON out.

An engine has a process of its own, so that the others are asked when it ends in the middle.
"""

import json
import os
import sys
from importlib import import_module
from types import ModuleType
from typing import Any

from validation.programs.engines.phenomena import PHENOMENA, Phenomenon
from validation.programs.engines.scenes import TIME_STEP, NotMeaningful, simulated


def value(engine: ModuleType, setting: dict[str, Any], phenomenon: Phenomenon) -> float:
    """What a phenomenon measures in an engine.

    Raises
    ------
    ValueError
        If a state is no number.
    """
    h = setting.get("h", TIME_STEP)
    motions = [simulated(scene, engine.Engine(scene, setting), h) for scene in phenomenon.scenes]
    return phenomenon.measure(motions)


def cell(engine: ModuleType, setting: dict[str, Any], phenomenon: Phenomenon) -> dict[str, Any]:
    """One cell: a value, the reason why there is none, or what went wrong."""
    if phenomenon.torsion and engine.NO_TORSION:
        return {"not_meaningful": engine.NO_TORSION}
    try:
        return {"value": value(engine, setting, phenomenon)}
    except NotMeaningful as reason:
        return {"not_meaningful": str(reason)}
    except Exception as error:
        return {"failed": f"{type(error).__name__}: {error}"}


def main() -> int:
    """Ask the engine named, and print its cells as they come."""
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # engines print to standard output
    try:
        engine = import_module(f"validation.programs.engines.{sys.argv[1]}")
    except ImportError as error:
        print(json.dumps({"missing": str(error)}), file=out)
        return 2
    head = {"name": engine.NAME, "not_default": engine.NOT_DEFAULT}
    print(json.dumps(head), file=out, flush=True)
    for setting, values in engine.SETTINGS.items():
        for name, phenomenon in PHENOMENA.items():
            answer = cell(engine, values, phenomenon)
            print(
                json.dumps({"setting": setting, "phenomenon": name, **answer}), file=out, flush=True
            )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

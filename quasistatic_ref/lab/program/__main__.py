"""The program's command: answer the files of the vectors, or a challenge."""

import json
import sys
from pathlib import Path

from .layers import LAYERS, TO_SIX_DIGITS, plain

IMPLEMENTATION = "plain NumPy program"


def whole(value, shapes):
    """A case with the shapes that its file keeps in a table."""
    if isinstance(value, dict):
        if value.get("kind") == "shared":
            return shapes[value["name"]]
        return {key: whole(v, shapes) for key, v in value.items()}
    return [whole(v, shapes) for v in value] if isinstance(value, list) else value


def answers(layer, inputs):
    """The content of answers/LAYER.json."""
    shapes = inputs.get("shapes", {})
    known = LAYERS | TO_SIX_DIGITS
    outputs = [
        {"id": case["id"], "output": plain(known[layer](whole(case["input"], shapes)))}
        for case in inputs["cases"]
    ]
    return {"format": "quasistatic-ref/vectors-answers", "version": 1, "layer": layer,
            "implementation": IMPLEMENTATION, "answers": outputs}  # fmt: skip


def answer_challenge():
    """Answer the cases of a challenge: one a line in, one a line out."""
    greeting = {"protocol": 1, "implementation": IMPLEMENTATION, "layers": list(LAYERS)}
    print(json.dumps(greeting), flush=True)
    for text in sys.stdin:
        case = json.loads(text)
        try:
            answer = {"output": plain(LAYERS[case["layer"]](case["input"]))}
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps({"id": case["id"], **answer}), flush=True)


def main(vectors, out, *layers):
    """Answer every layer that has inputs."""
    Path(out).mkdir(parents=True, exist_ok=True)
    for layer in layers or LAYERS:
        path = Path(vectors, "inputs", f"{layer}.json")
        if path.exists():
            text = json.dumps(answers(layer, json.loads(path.read_text())))
            Path(out, f"{layer}.json").write_text(text + "\n")


if __name__ == "__main__":
    if len(sys.argv) == 2:
        sys.exit("name two folders, of the vectors and for the answers; or none, for a challenge")
    main(*sys.argv[1:]) if sys.argv[1:] else answer_challenge()

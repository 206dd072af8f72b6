"""Changes of a port's formulas, one place at a time: of each kind one in turn."""

import hashlib
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

FILES = {
    "go": ("vector.go", "mechanism.go", "distance.go", "contact.go", "qp.go", "step.go"),
    "cpp": ("geometry.hpp", "mechanism.hpp", "distance.hpp", "contact.hpp", "qp.hpp", "step.hpp"),
}
"""Of each port, the files that hold formulas."""
BEGINS = {
    "go": re.compile(r"^func (?:\([^)]*\) )?(\w+)\("),
    "cpp": re.compile(
        r"^(?:  )?(?:inline |explicit |static )*(?:[\w:<>, ]+[ &*]+)?(operator\S+|\w+)\([^;]*\)"
        r"(?: const)?(?: :.*)? \{"
    ),
}
"""The line with which a function begins."""
ATOM = r"(?:[\w.]+(?:\([^()]*\)|\[[^\][]*\])*|\([^()]*\))"
"""A number, a name, a call or an entry without others in it, or brackets."""
END = r"(?<=[\w)\]])"
"""Behind an operand."""
POSE = r"\b(at|bt|made\.pose|at\.pose|pose)\.R"
PAIRS = {
    "linear": "angular", "alpha": "beta", "Alpha": "Beta", "D1": "D2", "d1": "d2", "n_a": "n_v",
    "Mu_v": "Mu_omega", "mu_v": "mu_omega", "Force": "Torque", "force": "torque", "u": "v",
    "Alpha_body": "Beta_body", "alpha_body": "beta_body", "at": "bt", "shift": "turn",
    "first": "second", "Max": "Min", "max": "min", "Sin": "Cos", "sin": "cos", "sinc": "cosc",
}  # fmt: skip
"""Names, each of which may stand in the place of the other."""
OTHER_NAME = PAIRS | {b: a for a, b in PAIRS.items()} | {"cubic": "cosc"}
NUMBERS = {
    "0.25": "0.3", "1e-9": "1e-3", "0.5": "1.0", "2": "3", "12": "13", "16": "15", "25": "24",
}  # fmt: skip
Word = str | Callable[[re.Match[str]], str]


def _renamed(match: re.Match[str]) -> str:
    return match[0].replace(match["name"], OTHER_NAME[match["name"]])


def _names(*names: str) -> str:
    return f"(?P<name>{'|'.join(names)})"


RULES: tuple[tuple[str, str, Word], ...] = (
    ("sign", rf"{END} \+ (?=[\w(])", " - "),
    ("sign", rf"{END} - (?=[\w(])", " + "),
    ("sign", rf"{END}\+(?=[\w(])", "-"),
    ("sign", rf"{END}-(?=[\w(])", "+"),
    ("sign", r"\+=", "-="),
    ("sign", r"-=", "+="),
    ("sign", r"(?<=[ ({,])-(?=[\w(])", ""),
    ("sign", r"\badd\(", "sub("),
    ("sign", r"\bsub\(", "add("),
    ("sign", r"\bplus\(", "minus("),
    ("sign", r"\bminus\(", "plus("),
    ("frame", r"\bconjugate\((\w[\w.]*)\)", r"\1"),
    ("frame", r"\brotate\((\w[\w.]*),", r"rotate(conjugate(\1),"),
    ("frame", r"\btranspose\((\w[\w.]*)\)", r"\1"),
    ("frame", rf"{POSE}\b \*", r"transpose(\1.R) *"),
    ("frame", r"\brotate\(\w[\w.]*, (\w[\w.\[\]]*|axis\(\w\))\)", r"\1"),
    ("frame", rf"{POSE} \* ", ""),
    ("frame", r"\binverse\((\w+\([^()]*\))\)", r"\1"),
    ("order of a product", rf"\b(cross|product|compose)\(({ATOM}), ({ATOM})\)", r"\1(\3, \2)"),
    ("order of a product", rf"\b([A-Za-z_]\w*) \* (?:::)?({ATOM})(?=[;,)}}])", r"\2 * \1"),
    ("order of a product", r"\b([A-Za-z_]\w*) \* (exp6\(.*\));", r"\2 * \1;"),
    ("factor", rf"(?<![\w.)\]])({ATOM}) ?\* ?(?={ATOM})", ""),
    ("factor", rf"{END} ?\* ?{ATOM}", ""),
    ("factor", rf"{END} ?/ ?{ATOM}", ""),
    ("factor", rf"\bscale\([^(),]+, ({ATOM})\)", r"\1"),
    ("missing term", rf"{END} ?[+-] ?{ATOM}(?= [+-]|[;,)\n]|$)", ""),
    ("missing term", rf"\badd\(({ATOM}), {ATOM}\)", r"\1"),
    ("missing term", rf"\badd\({ATOM}, ({ATOM})\)", r"\1"),
    ("missing term", rf"\bsub\(({ATOM}), {ATOM}\)", r"\1"),
    ("missing term", rf"\balong\(({ATOM}), {ATOM}, -?{ATOM}\)", r"\1"),
    ("missing term", r"^\s+[\w.\[\]+ ]+ [+-]= .*$", ""),
    ("missing term", r"^(\s+)(\S.*) && (.*)$", r"\1\2 && true"),
    ("index", r"\[0\]", "[1]"),
    ("index", r"\[1\]", "[2]"),
    ("index", r"\[2\]", "[0]"),
    ("index", r"\[3\]", "[2]"),
    ("index", r"\[i\]\[j\]", "[j][i]"),
    ("index", r"\[i\]\[j\]", "[i][i]"),
    ("off by one", r"(?<=< )([3-8])\b", lambda match: str(int(match[1]) - 1)),
    ("off by one", r"(?<=[\w\])]) ?\+ ?1\b(?!\.)", ""),
    ("off by one", r" (<|>)= (?=k\b)", r" \1 "),
    ("off by one", r"> (k|pair\.K)\b", r">= \1"),
    ("off by one", r"(?<== )(0)(?=;|$)", "1"),
    ("tie", r" < (?=[\w(])", " <= "),
    ("tie", r" > (?=[\w(])", " >= "),
    ("tie", r" <= (?=[\w(])", " < "),
    ("tie", r" >= (?=[\w(])", " > "),
    ("comparison", r" < (?=[\w(])", " > "),
    ("comparison", r" > (?=[\w(])", " < "),
    ("comparison", rf"\b(?:math\.|std::){_names('Max', 'Min', 'max', 'min')}\(", _renamed),
    ("function", rf"\b(?:math\.|std::){_names('Sin', 'Cos', 'sin', 'cos')}\(", _renamed),
    ("function", rf"\b{_names('sinc', 'cosc', 'cubic')}\(", _renamed),
    ("function", r"\b(math\.Abs|std::abs|abs|unit|normalised)\(", "("),
    ("function", rf"\b(math\.Atan2|std::atan2)\(({ATOM}), ({ATOM})\)", r"\1(\3, \2)"),
    ("other quantity", rf"\b{_names(*OTHER_NAME)}\b(?!\(|\"| :?=|,? [\w, ]+:=)", _renamed),
    ("other quantity", rf"\"{_names(*OTHER_NAME)}\"", _renamed),
    ("number", rf"(?<![\w.\[])({'|'.join(map(re.escape, NUMBERS))})\b(?!\.|\])",
     lambda match: NUMBERS[match[1]]),
)  # fmt: skip
"""Kind, what is looked for in a line, and what stands in its place."""
PASSIVE = re.compile(
    r"\s*(//|import|package|type|#|struct|using|template|\"|case |default"
    r"|for \(?(const|size_t|auto|_, )|(func|inline) (?!.*return))"
)
"""Lines without a formula."""


@dataclass(frozen=True)
class Change:
    """A change of one place.

    Parameters
    ----------
    name : str
        Port, file, line, function, and what became of the line.
    kind, place, file : str
        The place is a function.
    line : int
        Counted from 0.
    old, new : str
    """

    name: str
    kind: str
    place: str
    file: str
    line: int
    old: str
    new: str


def changes(port: Path) -> Iterator[Change]:
    """All changes of a port, of each kind one in turn; which is first follows from their names."""
    by_line: list[list[Change]] = []
    for file in FILES[port.name]:
        place = ""
        for i, line in enumerate((port / file).read_text("utf-8").splitlines(keepends=True)):
            if begins := BEGINS[port.name].match(line):
                place = begins[1]
            if not place or PASSIVE.match(line):
                continue
            found: dict[str, Change] = {}
            for kind, new in changed_lines(line):
                said = " ".join(new.split()) or "(nothing)"
                name = f"{port.name} {file} {i + 1} {place}: {said}"
                found.setdefault(new, Change(name, kind, place, file, i, line, new))
            if found:
                by_line.append(sorted(found.values(), key=lambda one: _hash(one.name)))
    by_line.sort(key=lambda line: _hash(line[0].name))
    by_kind: dict[str, list[Change]] = {kind: [] for kind, _, _ in RULES}
    for number in range(max(map(len, by_line))):
        for line in by_line:
            if number < len(line):
                by_kind[line[number].kind].append(line[number])
    for number in range(max(map(len, by_kind.values()))):
        yield from (ones[number] for ones in by_kind.values() if number < len(ones))


def changed_lines(line: str) -> Iterator[tuple[str, str]]:
    """The kinds of changes of a line, and what it becomes."""
    signature = re.match(r"\s*(func|inline) .*?\{", line)
    begin = signature.end() if signature else 0
    loop = line.lstrip().startswith("for ")
    for kind, pattern, by in RULES:
        if loop and kind in ("comparison", "tie"):
            continue
        for match in re.finditer(pattern, line):
            word = match.expand(by) if isinstance(by, str) else by(match)
            new = (line[: match.start()] + word + line[match.end() :]).rstrip("\n") + "\n"
            if match.start() >= begin and new != line:
                yield kind, new


def switched_line(change: Change, number: int) -> str | None:
    """A line of C++ that is the new one if ``MUTANT`` is the number; None if it cannot be both."""
    old, new = change.old.strip(), change.new.strip()
    chosen = f"MUTANT == {number}"
    if one := re.match(r"(.*?\) (?:const )?\{)(.*)\}$", old):
        if not re.match(r"(static |inline |[\w:]+ operator)", old):
            return None
        return f"{one[1]} if ({chosen}) {{{new[len(one[1]) : -1]}}} else {{{one[2]}}} }}"
    if not old.endswith(";") or old.startswith("{"):
        return None
    if one := re.match(r"((?:const )?(double|int|Vec|Mat|Pose|Number|bool|Quat)) \w+ = ", old):
        if not new.startswith(one[0]) or re.search(r", \w+ = ", old):
            return None
        texts = (text[one.end() : -1] for text in (new, old))
        both = (f"{one[2]}{t}" if t.startswith("{") else f"{one[2]}({t})" for t in texts)
        return f"{one[0]}{chosen} ? {' : '.join(both)};"
    declared = r"(?!return |throw |else |if |for )(const |auto |[\w:]+(<.*>)? [&*]?\w+( = |[;,(]))"
    if re.match(declared, old):
        return None  # a declaration
    return f"if ({chosen}) {{ {new} }} else {{ {old} }}"


def _hash(name: str) -> str:
    return hashlib.sha256(name.encode()).hexdigest()

"""Inputs with fewer parts: contacts, pairs, wrenches, points, rows, bodies, coordinates."""

import copy
from collections.abc import Iterator, Sequence

from quasistatic_ref.lab.vectors.converters import places
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.trees import Path, nodes

LISTS = {"contacts": 1, "pairs": 0, "wrenches": 0, "second_order": 1, "phi": 1,
                "points": 1, "vertices": 1}  # fmt: skip
"""Lists of which parts are left out, and how many are left at least."""


def replaced(case: Json, path: Path, value: Json) -> Json:
    """A copy with another value in one place."""
    changed = copy.deepcopy(case)
    _at(changed, path[:-1])[path[-1]] = copy.deepcopy(value)
    return changed


def fewer_parts(case: Json) -> Iterator[Json]:
    """One contact, pair, wrench, block, group, point or row alone, or all but one."""
    for path, value in nodes(case):
        name = str(path[-1]) if path else ""
        if isinstance(value, list) and (name in LISTS or path[:-1] == ("phi",)):
            for part in _fewer_values(value):
                if len(part) >= LISTS.get(name, 0):
                    yield _without_unused_shapes(replaced(case, path, part))
        elif name == "k":
            yield from (replaced(case, path, k) for k in range(1, value))
    if "bodies" in case:  # of the layer wrench
        for name in case["bodies"]:
            rest = {key: value for key, value in case["bodies"].items() if key != name}
            yield {**case, "bodies": rest, "contacts": _loose_contacts(case["contacts"], name)}
    if "A" in case:
        for kept in _fewer_values(range(len(case["b"]))):
            yield {**case, **{key: [case[key][i] for i in kept] for key in ("A", "b")}}


def _fewer_values(values: Sequence[Json]) -> Iterator[list[Json]]:
    """Half of them, one alone, all but one."""
    if len(values) > 3:
        half = len(values) // 2
        yield from (list(values[:half]), list(values[half:]))
    if len(values) > 1:
        yield from ([value] for value in values[:8])
    for i in range(len(values)):
        yield [*values[:i], *values[i + 1 :]]


def _without_unused_shapes(case: Json) -> Json:
    """A step without shapes that no pair names."""
    if "shapes" not in case:
        return case
    named = {pair[side] for pair in case["pairs"] for side in ("alpha", "beta")}
    return {**case, "shapes": {k: v for k, v in case["shapes"].items() if k in named}}


def _loose_contacts(contacts: Json, name: str) -> Json:
    """Contacts on the world in the place of a body."""
    sides = ("alpha_body", "beta_body")
    loose = [{**c, **{s: None for s in sides if c[s] == name}} for c in contacts]
    return [c for c in loose if any(c[s] is not None for s in sides)]


def fewer_bodies(case: Json) -> Iterator[Json]:
    """Without a body that carries nothing; or a body on the world instead of its parent."""
    bodies = case.get("mechanism", {"bodies": []})["bodies"]
    for body in reversed(bodies):
        carries = any(
            other["parent"] == body["name"] or other.get("mimic", {}).get("of") == body["name"]
            for other in bodies
        )
        if not carries and len(bodies) > 1:
            yield _without_body(case, body["name"])
    for k, body in enumerate(bodies):
        if body["parent"] is not None:
            rest = [*bodies[:k], {**body, "parent": None}, *bodies[k + 1 :]]
            yield {**case, "mechanism": {"bodies": rest}}


def _without_body(case: Json, name: str) -> Json:
    """The case without a body, its entries of q and delta_q, its contacts, shapes and wrenches."""
    q = slice(0, 0)
    v = slice(0, 0)
    for body, own_q, own_v in places(case["mechanism"]):
        if body["name"] == name:
            q = own_q
            v = own_v
    bodies = [body for body in case["mechanism"]["bodies"] if body["name"] != name]
    changed = {**case, "mechanism": {"bodies": bodies}, "q": _cut(case["q"], q)}
    if "delta_q" in case:
        changed["delta_q"] = _cut(case["delta_q"], v)
    if "contacts" in case:
        changed["contacts"] = _loose_contacts(case["contacts"], name)
    if "shapes" in case:
        on = {key for key, entry in case["shapes"].items() if entry["body"] == name}
        changed["pairs"] = [p for p in case["pairs"] if not {p["alpha"], p["beta"]} & on]
        changed["wrenches"] = [w for w in case.get("wrenches", []) if w["body"] != name]
        changed["K_q"] = _cut([_cut(row, v) for row in case["K_q"]], v)
        changed["q_bar_a"] = _cut(case["q_bar_a"], q)
        changed = _without_unused_shapes(changed)
    return changed


def _cut(values: Json, part: slice) -> Json:
    """Without a part; a part beyond the end is none of theirs."""
    return [*values[: part.start], *values[part.stop :]]


def fewer_coordinates(case: Json) -> Iterator[Json]:
    """Without a column of J, or of H and A."""
    matrices = [path for path, value in nodes(case) if path[-1:] in (("J",), ("F",), ("A",))]
    counts = [len(row) for path in matrices for row in _at(case, path)]
    counts.append(len(case.get("g", [])))
    for k in range(max(counts) if max(counts) > 1 else 0):
        one = slice(k, k + 1)
        changed = copy.deepcopy(case)
        if "H" in case:
            changed["H"] = _cut([_cut(row, one) for row in case["H"]], one)
            changed["g"] = _cut(case["g"], one)
        for path in matrices:
            _at(changed, path)[:] = [_cut(row, one) for row in _at(case, path)]
        yield changed


def _at(case: Json, path: Path) -> Json:
    for key in path:
        case = case[key]
    return case

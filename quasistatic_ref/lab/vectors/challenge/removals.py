"""Inputs with fewer parts: contacts, pairs, wrenches, points, rows, bodies, coordinates."""

from collections.abc import Iterator, Sequence
from typing import Final

from quasistatic_ref.lab.vectors.converters import places
from quasistatic_ref.lab.vectors.expected import Json

LISTS: Final = ("contacts", "pairs", "wrenches", "second_order")


def fewer_parts(case: Json) -> Iterator[Json]:
    """One contact, pair, wrench, block, group or point alone, or all but one."""
    for name in LISTS:
        if len(case.get(name, [])) > (name in ("contacts", "second_order")):
            for part in _fewer(case[name]):
                yield _used({**case, name: part})
    for i, pair in enumerate(case.get("pairs", [])):
        for k in range(1, pair["k"]):
            pairs = [*case["pairs"][:i], {**pair, "k": k}, *case["pairs"][i + 1 :]]
            yield {**case, "pairs": pairs}
    if "bodies" in case:  # of the layer wrench
        for name in case["bodies"]:
            rest = {key: value for key, value in case["bodies"].items() if key != name}
            yield {**case, "bodies": rest, "contacts": _loose(case["contacts"], name)}
    if "k" in case:
        yield from ({**case, "phi": part} for part in _fewer(case["phi"]) if part)
        for i, phi in enumerate(case["phi"]):
            for part in _fewer(phi):
                yield {**case, "phi": [*case["phi"][:i], part, *case["phi"][i + 1 :]]}
        if case["k"] > 1:
            yield {**case, "k": 1}
    if "A" in case:
        rows = list(zip(case["A"], case["b"], strict=True))
        for part in _fewer(rows):
            yield {**case, "A": [row for row, _ in part], "b": [b for _, b in part]}
    for side in ("alpha", "beta"):
        if "pose_alpha" in case and case[side]["kind"] == "cloud":
            for points in _fewer(case[side]["points"]):
                if points:
                    yield {**case, side: {**case[side], "points": points}}
    for name, entry in case.get("shapes", {}).items():
        for key in ("points", "vertices"):
            for some in _fewer(entry["shape"].get(key, [])):
                shape = {**entry["shape"], key: some}
                yield {**case, "shapes": {**case["shapes"], name: {**entry, "shape": shape}}}


def _fewer(values: Sequence[Json]) -> Iterator[list[Json]]:
    """Half of them, one alone, all but one."""
    if len(values) > 3:
        half = len(values) // 2
        yield from (list(values[:half]), list(values[half:]))
    if len(values) > 1:
        yield from ([value] for value in values[:8])
    for i in range(len(values)):
        yield [*values[:i], *values[i + 1 :]]


def _used(case: Json) -> Json:
    """A step without shapes that no pair names."""
    if "shapes" not in case:
        return case
    named = {pair[side] for pair in case["pairs"] for side in ("alpha", "beta")}
    return {**case, "shapes": {k: v for k, v in case["shapes"].items() if k in named}}


def _loose(contacts: Json, name: str) -> Json:
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
            yield _without(case, body["name"])
    for k, body in enumerate(bodies):
        if body["parent"] is not None:
            rest = [*bodies[:k], {**body, "parent": None}, *bodies[k + 1 :]]
            yield {**case, "mechanism": {"bodies": rest}}


def _without(case: Json, name: str) -> Json:
    """The case without a body, its entries of q and delta_q, its contacts, shapes and wrenches."""
    q, v = slice(0, 0), slice(0, 0)
    for body, own_q, own_v in places(case["mechanism"]):
        if body["name"] == name:
            q, v = own_q, own_v
    bodies = [body for body in case["mechanism"]["bodies"] if body["name"] != name]
    changed = {**case, "mechanism": {"bodies": bodies}, "q": _cut(case["q"], q)}
    if "delta_q" in case:
        changed["delta_q"] = _cut(case["delta_q"], v)
    if "contacts" in case:
        changed["contacts"] = _loose(case["contacts"], name)
    if "shapes" in case:
        on = {key for key, entry in case["shapes"].items() if entry["body"] == name}
        changed["pairs"] = [p for p in case["pairs"] if not {p["alpha"], p["beta"]} & on]
        changed["wrenches"] = [w for w in case.get("wrenches", []) if w["body"] != name]
        changed["K_q"] = _cut([_cut(row, v) for row in case["K_q"]], v)
        changed["q_bar_a"] = _cut(case["q_bar_a"], q)
        changed = _used(changed)
    return changed


def _cut(values: Json, part: slice) -> Json:
    """Without a part; a part beyond the end is none of theirs."""
    return [*values[: part.start], *values[part.stop :]]


def fewer_coordinates(case: Json) -> Iterator[Json]:
    """Without a column of J, or of H and A."""
    if "H" in case:
        for k in range(len(case["g"]) if len(case["g"]) > 1 else 0):
            one = slice(k, k + 1)
            changed = {**case, "H": _cut([_cut(row, one) for row in case["H"]], one)}
            changed["g"] = _cut(case["g"], one)
            if "A" in case:
                changed["A"] = [_cut(row, one) for row in case["A"]]
            else:
                changed["second_order"] = [
                    {**block, "F": [_cut(row, one) for row in block["F"]]}
                    for block in case["second_order"]
                ]
            yield changed
    contacts = case.get("contacts", [])
    if contacts and "J" in contacts[0]:
        for k in range(len(contacts[0]["J"][0]) if len(contacts[0]["J"][0]) > 1 else 0):
            one = slice(k, k + 1)
            cut = [{**c, "J": [_cut(row, one) for row in c["J"]]} for c in contacts]
            yield {**case, "contacts": cut}

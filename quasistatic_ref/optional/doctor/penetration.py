"""Bodies that start in each other."""

from collections.abc import Iterator

from quasistatic_ref.optional.doctor.start import Said, Start, least, slices, table
from quasistatic_ref.tolerances import SUNK


def penetration(start: Start) -> Iterator[Said]:
    """Of each table of contacts the deepest pair, where it is deep for its smaller shape."""
    deepest: dict[str, Said] = {}
    if start.points is None:
        return
    for pair, own in slices(start.pairs):
        depth = -float(start.points.phi[own].min(initial=0.0))
        name = table(pair)
        deeper = name not in deepest or 1e3 * depth > deepest[name].numbers["depth_mm"]
        if depth > SUNK * least(pair) and deeper:
            deepest[name] = Said(
                f"start {pair.alpha.name} and {pair.beta.name} {1e3 * depth:.3g} mm farther apart",
                f"{pair.name} is {1e3 * depth:.3g} mm deep at the start, and a step undoes that at "
                f"once, with {depth / start.h**2:.3g} N for each kilogram",
                {"depth_mm": 1e3 * depth},
            )
    yield from deepest.values()

"""What the prediction of pushes came to, as plain data and as a page."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from quasistatic_ref.lab.reality.errors import errors_of, summary
from quasistatic_ref.lab.reality.identify import Identified
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.predictions import Row, poses
from quasistatic_ref.lab.reality.pushes import Pushes
from quasistatic_ref.lab.reality.settings import Settings

HEAD = ("pair", "pushes", "moved [mm]", "[deg]", "error [mm]", "95 %", "[deg]", "95 %",
        "published [mm]", "[deg]")  # fmt: skip


def reality_record(
    settings: Settings,
    ratios: Mapping[str, float],
    pushes: Mapping[str, Pushes],
    rows: Mapping[str, Sequence[Row]],
) -> dict[str, Any]:
    """Settings, errors by pair and pooled, and how steps were certified: plain data.

    Parameters
    ----------
    settings : Settings
    ratios : mapping of str to float
        mu_omega / mu_v of each pair [m].
    pushes : mapping of str to Pushes
    rows : mapping of str to sequence of dict
        The predictions, in the same order.
    """
    kinds: Counter[str] = Counter()
    for of_pair in rows.values():
        for row in of_pair:
            kinds.update(row["steps"])
    bounds = [row["error_bound"] for of_pair in rows.values() for row in of_pair]
    errors = {name: errors_of(poses(of_pair), pushes[name]) for name, of_pair in rows.items()}
    return {
        "format": "quasistatic-ref/reality-summary",
        "version": 1,
        "settings": settings.record(),
        "mu_omega_over_mu_v": dict(ratios),
        "steps": dict(sorted(kinds.items())),
        "largest_error_bound": None if None in bounds else max(bounds),
        "pairs": summary(errors),
    }


def predictions_text(rows: Mapping[str, Sequence[Row]]) -> str:
    """The predictions as CSV, seven digits: poses [m, rad], steps by certificate and by grip."""
    lines = ["surface,shape,push,x1,y1,theta1,exact,enclosure,sticks,slides"]
    for name, of_pair in rows.items():
        for row in of_pair:
            pose = ",".join(f"{x:.7g}" for x in row["pose"])
            steps = ",".join(str(row["steps"].get(kind, 0)) for kind in ("exact", "enclosure"))
            grip = f"{row['sticks']},{row['slides']}"
            lines.append(f"{name.replace('/', ',')},{row['push']},{pose},{steps},{grip}")
    return "\n".join([*lines, ""])


def identified_record(identified: Identified | None) -> dict[str, Any]:
    """An identified ratio as plain data."""
    if identified is None:
        return {"identifiable": False, "count": 0}
    return vars(identified) | {"identifiable": identified.identifiable}


def error_rows(record: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """The table of a record: one line a pair, the mean over pairs last."""
    table: list[tuple[str, ...]] = [HEAD]
    for name, entry in record["pairs"].items():
        moved = entry["moved"]
        error = entry["error"]
        other = entry.get("published")
        cells = [name, f"{entry['pushes']:,}", f"{moved['mean'][0]:.1f}", f"{moved['mean'][1]:.1f}"]
        for k in (0, 1):
            span = f"{error['low'][k]:.2f} - {error['high'][k]:.2f}"
            cells += [f"{error['mean'][k]:.2f}", span]
        cells += ["-", "-"] if other is None else [f"{x:.2f}" for x in other["mean"]]
        table.append(tuple(cells))
    return table


def certified_words(record: Mapping[str, Any]) -> str:
    """One sentence on how the steps were certified."""
    kinds = record["steps"]
    total = sum(kinds.values())
    counts = ", ".join(f"{count:,} {kind}" for kind, count in kinds.items())
    bound = record["largest_error_bound"]
    bounds_words = (
        "some have no error bound" if bound is None else f"the largest error bound is {bound:.1e}"
    )
    return f"{total:,} steps: {counts}; {bounds_words}"


def identified_rows(
    pairs: Sequence[Pair], by_pair: Mapping[str, Identified | None]
) -> list[tuple[str, ...]]:
    """The table of identified ratios: one line a pair."""
    table: list[tuple[str, ...]] = [
        ("pair", "loads", "mu_omega / mu_v [mm]", "95 %", "bootstrap", "reverse [mm]",
         "published [mm]", "misfit", "mu_v N [N]", "verdict")
    ]  # fmt: skip
    for pair in pairs:
        identified = by_pair[pair.name]
        published = "-" if pair.published is None else f"{1e3 * pair.published:.1f}"
        if identified is None:
            table.append((pair.name, "0", *["-"] * 4, published, "-", "-", "not identifiable"))
            continue
        table.append((
            pair.name, str(identified.count), f"{1e3 * identified.ratio:.1f}",
            f"{1e3 * identified.low:.1f} - {1e3 * identified.high:.1f}",
            f"{1e3 * identified.drawn_low:.1f} - {1e3 * identified.drawn_high:.1f}",
            "-" if identified.reverse is None else f"{1e3 * identified.reverse:.1f}", published,
            f"{identified.misfit:.3f}", f"{identified.friction:.2f}",
            "identified" if identified.identifiable else "not identifiable",
        ))  # fmt: skip
    return table

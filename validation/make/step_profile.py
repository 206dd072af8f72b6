"""The time of a step in numbers: the table behind the figure of the claim ``step_time``.

Run ``python -m validation.make.step_profile --out FILE`` (ten seconds; the extra ``test`` brings
DAQP). docs/speed.md compares it with the paper's Fig. 4.
"""

from pathlib import Path

from quasistatic_ref.lab.bench.profile import PARTS, SOLVE, Microseconds, share, step_profiles
from quasistatic_ref.lab.machine import machine
from quasistatic_ref.lab.page.markdown import markdown_table
from validation.tools.scripts import script_options, show_page


def main() -> None:
    """Measure, and write the page."""
    options = script_options(__doc__, out=Path)
    found = step_profiles()
    m = machine()
    words = (
        f"Written by `python -m validation.make.step_profile` on {m['processor']}, {m['cores']} "
        f"cores, Python {m['python']}. Every step of `bunny_grasp`, native interface, "
        "accuracy 1e-12; wall time [us], share of the lap `solve` and of the solver's call alone "
        f"[%]. By brute force a step evaluates {found['all']} signed distances, with the tracker "
        f"{found['tracked']:.0f} in the mean."
    )
    lines = ["# The time of a step", "", words]
    for title, of_profile in (("Medians", "typical"), ("Means", "mean")):
        names = ("backend, distances", *PARTS, "step", "solve [%]", "call alone [%]")
        profiles = found["profiles"].all
        rows = [(profile.name, *_row(getattr(profile, of_profile))) for profile in profiles]
        lines += ["", f"## {title}", "", *markdown_table(names, rows)]
    show_page("\n".join(lines), options.out)


def _row(times: Microseconds) -> list[str]:
    shares = [f"{100 * share(times, *parts):.0f}" for parts in (SOLVE, SOLVE[:1])]
    return [f"{us:.0f}" for us in (*times.values(), sum(times.values()))] + shares


if __name__ == "__main__":
    main()

"""Every answer of ``contact-qp`` proved again, and a tenth of them by fractions alone.

Run ``python -m validation.make.proved_problems``; some minutes. ``--every N`` takes each N-th
problem only. The first proof is that of ``study problems check --exact``. The second shares no code
with it, nor with the package: the files are read by the lines of the set's README, and the
solution of the optimality conditions is proved in integers.
Exit status 1 if an answer is refuted.
"""

import re
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.study.problems.checking import refutation
from quasistatic_ref.lab.study.problems.folder import manifest, set_read
from quasistatic_ref.lab.study.problems.problem import EXACT
from tests.oracles import rational_kkt
from validation.tools.scripts import script_options, show_page

SHARE = 9
"""One of so many problems of a family, from its first on, is proved in fractions: a tenth and more.
Scenes of a family alternate, so that the number is odd."""
LARGEST = 110
"""Coordinates of a problem that is proved in fractions, at most: a minute."""
HEAD = ("family", "problems", "coordinates", "refuted", "time [s]",
        "in fractions", "coordinates", "refuted", "time [s]")  # fmt: skip
Read = tuple[dict[str, Any], dict[str, Any]]
"""Facts and numbers of a problem."""


def reader() -> Callable[[Path, str], Iterator[Read]]:
    """The function ``problems(folder, family)`` of the set's README."""
    page = (problem_set_folder(CONTACT_QP) / "README.md").read_text("utf-8")
    (lines,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    names = {}
    exec(lines, names)
    return names["problems"]


def refuted_in_fractions(one: Read) -> str | None:
    """Why an answer is wrong; None if it is proved."""
    facts, numbers = one
    A = numbers["A"].toarray()
    if facts["farkas"]:
        return rational_kkt.farkas_refutation(A, numbers["b"], facts["farkas"])
    answer = (numbers[name] for name in ("x", "net", "slack", "lam"))
    return rational_kkt.refutation(numbers["H"].toarray(), numbers["g"], A, numbers["b"], *answer)


def refuted_and_time(judge: Callable[[Any], str | None], some: Sequence[Any]) -> tuple[int, str]:
    """How many are refuted, and the processor time that it takes [s]."""
    begin = time.process_time()
    refuted = [why for one in some if (why := judge(one)) is not None]
    return len(refuted), f"{time.process_time() - begin:.1f}"


def lines(every: int) -> Iterator[tuple[str, ...]]:
    """A line for each family; of a sample, each so-many-th problem."""
    folder = problem_set_folder(CONTACT_QP)
    read = reader()
    members = set_read(folder)
    for family in manifest(folder)["families"]:
        own = [one for one in members if one.facts["family"] == family][::every]
        small = [one for one in read(folder, family)
                 if one[0]["n"] <= LARGEST and one[0]["answer"]["kind"] == EXACT]  # fmt: skip
        share = small[:: SHARE * every]
        wrong, seconds = refuted_and_time(refutation, own)
        wrong_again, seconds_again = refuted_and_time(refuted_in_fractions, share)
        largest = max(one.facts["n"] for one in own)
        largest_again = max((facts["n"] for facts, _ in share), default="")
        yield (f"`{family}`", str(len(own)), f"{largest}", str(wrong), seconds,
               str(len(share)), f"{largest_again}", str(wrong_again), seconds_again)  # fmt: skip


def main() -> None:
    """Write the page; exit status 1 if an answer is refuted."""
    options = script_options(__doc__, every=1, out=Path)
    found = list(lines(options.every))
    proved, refuted, again, refuted_again = (
        sum(int(line[i]) for line in found) for i in (1, 3, 5, 7)
    )
    text = (
        f"# Answers of contact-qp, proved again\n\n{proved} answers by the exact method from the "
        "rows that the files name, by an enclosure (`ellipsoid`) or by a bound (`sparse`): "
        f"{refuted} refuted. {again} exact ones, one in {SHARE} of those of up to {LARGEST} "
        "coordinates in each family, proved in Python's integers, read by the lines of the set's "
        f"README: {refuted_again} refuted. Processor time; the number of "
        "coordinates is the largest.\n\n" + "\n".join(markdown_table(HEAD, found))
    )
    show_page(text, options.out)
    raise SystemExit(int(refuted + refuted_again > 0))


if __name__ == "__main__":
    main()

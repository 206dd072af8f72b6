"""Whether a built site holds together.

Run ``python -m validation.tools.check_site OUT``.

Of every page: each link and each picture inside the site exists, with the place in the page that a
link names; and no picture stands twice in one page, which is how a name taken twice shows. The
paper's equations have the paper's numbers. Of README and the Markdown pages of the repository: each
relative link leads to a file. That nothing comes from elsewhere is seen in a browser
(``check_in_browser``).

Prints one line for each fault, and exits with status 1 if there is any.
"""

import re
import sys
from collections import Counter
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from validation.tools.scripts import ROOT

EQUATION = re.compile(r'id="equation-eq-(\d+)">\s*<span class="eqno">\((\d+)\)')
MARKDOWN_LINK = re.compile(r"\]\(([^()\s]+)\)")
FENCE = re.compile(r"^(```+).*?^\1", re.MULTILINE | re.DOTALL)


class Page(HTMLParser):
    """What one page links to, which pictures it shows, and where it can be linked to.

    Attributes
    ----------
    links, pictures : list of str
        Addresses.
    names : set of str
        Ids of places.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links = []
        self.pictures = []
        self.names = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take up one element."""
        attributes = dict(attrs)
        self.names |= {attributes.get("id"), attributes.get("name")}
        if tag == "a" and "href" in attributes:
            self.links.append(attributes["href"] or "")
        if tag == "img" and "src" in attributes:
            self.pictures.append(attributes["src"] or "")


def site_faults(site: Path) -> Iterator[str]:
    """One sentence for each fault of a built site."""
    pages = {path: Page(path.read_text("utf-8")) for path in sorted(site.rglob("*.html"))}
    if not pages:
        yield f"{site} holds no page"
    for path, page in pages.items():
        for picture, times in Counter(page.pictures).items():
            if times > 1:
                yield f"{path.relative_to(site)} shows {picture} {times} times"
        for address in (*page.links, *page.pictures):
            yield from link_faults(path, address, pages, site)


def link_faults(path: Path, address: str, pages: dict[Path, Page], site: Path) -> Iterator[str]:
    """Faults of one link of a page; links to other sites are not followed."""
    if urlsplit(address).scheme or address.startswith("//"):
        return
    target = _target(path, address)
    place = unquote(urlsplit(address).fragment)
    where = path.relative_to(site)
    if not target.exists():
        yield f"{where} links to {address}, which is not there"
    elif place and target in pages and place not in pages[target].names:
        yield f"{where} links to {address}, a place that the page does not have"


def equation_faults(page: str) -> Iterator[str]:
    """Whether the paper's equations have the paper's numbers in a page: label eq-N, number (N)."""
    numbered = EQUATION.findall(page)
    expected = [(str(n), str(n)) for n in range(1, 14)]
    if numbered != expected:
        yield f"equations and their numbers are {numbered}, not 1 to 13"


def markdown_faults(root: Path) -> Iterator[str]:
    """Relative links of README and other Markdown files of a repository that lead nowhere."""
    folders = ("docs", "models", "validation", "quasistatic_ref")
    files = [*root.glob("*.md"), *(p for f in folders for p in sorted((root / f).rglob("*.md")))]
    for path in files:
        for address in MARKDOWN_LINK.findall(FENCE.sub("", path.read_text("utf-8"))):
            parts = urlsplit(address)
            if not parts.scheme and parts.path and not (path.parent / unquote(parts.path)).exists():
                yield f"{path.relative_to(root)} links to {address}, which is not there"


def _target(path: Path, address: str) -> Path:
    file = unquote(urlsplit(address).path)
    return (path.parent / file).resolve() if file else path


def main() -> None:
    """Check the site named on the command line, and the Markdown files of this repository."""
    if len(sys.argv) != 2:
        sys.exit("usage: python -m validation.tools.check_site OUT")
    site = Path(sys.argv[1]).resolve()
    equations = (site / "theory" / "equations.html").read_text("utf-8")
    faults = [*site_faults(site), *equation_faults(equations), *markdown_faults(ROOT)]
    print("\n".join(faults) or "every link leads somewhere")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()

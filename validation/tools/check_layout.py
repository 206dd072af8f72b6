"""Whether the pages of a built site fit a phone and a desktop, in a headless Chromium.

Run ``python -m validation.tools.check_layout SITE [FOLDER]``, where Debian's package chromium is;
with FOLDER, screenshots of every page stay there.

Every page is shown at each width of ``WIDTHS``. Nothing may be wider than the window or be cut by
a box that does not scroll: code, tables and equations scroll inside their own boxes. At the larger
width a command of the shell fits its box, because a comment that has to be scrolled into view is
not read. Listings of source, which are most of the pages, have one frame: it is loaded once.

Prints one line for each fault, page and element, and exits with status 1 if there is any.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path

from validation.tools.browser import Browser

WIDTHS = (360, 1280)
"""Of a small phone and of a small laptop [px]."""
HEIGHT = 900
LISTINGS = "_modules"
"""The folder of listings of source."""
TYPESET = "!window.MathJax || window.typeset"
"""True when MathJax has made its formulas, or a page has none."""

FAULTS = """
(commands => {
  const slack = 1.5;  // of rounding [px]
  const width = document.documentElement.clientWidth;
  const name = e => e.tagName.toLowerCase() + (e.id ? '#' + e.id : '')
    + (typeof e.className === 'string' && e.className.trim()
       ? '.' + e.className.trim().split(/\\s+/).join('.') : '')
    + ' "' + (e.innerText || e.alt || '').trim().replace(/\\s+/g, ' ').slice(0, 60) + '"';
  const faults = [];
  if (document.documentElement.scrollWidth > width + slack)
    faults.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  // What a reader cannot see, or what is out of the window until it is shown.
  const hidden = e => getComputedStyle(e).visibility === 'hidden'
    || (e.matches('.sidebar-drawer, .toc-drawer, .skip-to-content, .visually-hidden')
        && (r => r.right <= slack || r.left >= width - slack || r.bottom <= slack
                 || r.width <= 1)(e.getBoundingClientRect()));
  const look = (element, box) => {
    if (element.matches('script, style, mjx-assistive-mml, svg') || hidden(element)) return;
    const style = getComputedStyle(element), {left, right, width: own} =
      element.getBoundingClientRect();
    if (style.display === 'none') return;
    if (own && !box && (right > width + slack || left < -slack)) {
      faults.push(`${name(element)} reaches from ${Math.round(left)} to ${Math.round(right)} px`);
      return;  // what is inside it reaches as far
    }
    const [across, down] = [element.scrollWidth - element.clientWidth,
                            element.scrollHeight - element.clientHeight];
    const cuts = value => ['hidden', 'clip'].includes(value);
    if (own > 1 && element.clientWidth && ((cuts(style.overflowX) && across > slack)
        || (cuts(style.overflowY) && down > slack)))
      faults.push(`${name(element)} cuts ${Math.max(across, 0)} x ${Math.max(down, 0)} px`);
    if (element.matches('mjx-container')) return;  // MathJax cuts and hides as it likes
    const scrolls = ['auto', 'scroll'].includes(style.overflowX);
    if (commands && scrolls && across > slack && element.closest('.highlight-sh'))
      faults.push(`${name(element)} hides ${across} px of a command`);
    for (const child of element.children) look(child, box || scrolls);
  };
  look(document.body, false);
  return faults;
})
"""
"""JavaScript: the faults of the page that is open, one sentence each."""


EXCHANGED = """
(text => document.querySelector('.page').replaceWith(
  new DOMParser().parseFromString(text, 'text/html').querySelector('.page')))
"""
"""JavaScript: what another page has in the frame of the page that is open."""


def resize(browser: Browser, width: int) -> None:
    """Give the window a width [px], without scroll bars, which a phone has not."""
    browser.ask(
        "Emulation.setDeviceMetricsOverride",
        width=width, height=HEIGHT, deviceScaleFactor=1, mobile=False,
    )  # fmt: skip
    browser.ask("Emulation.setScrollbarsHidden", hidden=True)


def open_unfolded(browser: Browser, page: Path) -> None:
    """Load a page, with all formulas made and all boxes unfolded."""
    browser.open(page)
    browser.value("void window.MathJax?.startup?.promise.then(() => { window.typeset = true })")
    browser.until(TYPESET)
    browser.until("document.fonts.status === 'loaded'")
    browser.value("for (const folded of document.querySelectorAll('details')) folded.open = true")
    # Formulas for screen readers: not seen, and taller than the others in Chromium 156.
    browser.value("for (const one of document.querySelectorAll('mjx-assistive-mml')) one.remove()")


def page_faults(browser: Browser, page: Path, pictures: Path | None) -> Iterator[str]:
    """One sentence for each fault of the page that is shown, with the width at which it is one."""
    for width in WIDTHS:
        resize(browser, width)
        for fault in browser.value(f"{FAULTS}({str(width == WIDTHS[-1]).lower()})"):
            yield f"at {width} px: {fault}"
        if pictures:
            name = f"{'_'.join(page.with_suffix('').parts[-3:])}_{width}.png"
            (pictures / name).write_bytes(browser.screenshot(whole=True))


def main() -> None:
    """Check every page of the site named on the command line."""
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: python -m validation.tools.check_layout SITE [FOLDER]")
    site = Path(sys.argv[1]).resolve()
    pictures = Path(sys.argv[2]) if len(sys.argv) > 2 else None
    if pictures:
        pictures.mkdir(parents=True, exist_ok=True)
    pages = [path for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
    faults = [] if pages else [f"{site} holds no page"]
    framed = False
    with Browser() as browser:
        for page in pages:
            if framed and LISTINGS in page.parts:
                browser.value(f"{EXCHANGED}({json.dumps(page.read_text('utf-8'))})")
            else:
                open_unfolded(browser, page)
            framed = LISTINGS in page.parts
            where = page.relative_to(site)
            faults += [f"{where} {fault}" for fault in page_faults(browser, page, pictures)]
    found = "\n".join(faults).encode("utf-8", "replace").decode()  # a letter may be cut in half
    print(found or f"{len(pages)} pages fit {' and '.join(map(str, WIDTHS))} px")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()

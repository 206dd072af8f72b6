"""Pages in a browser: those of a built site fit into the window, those of the viewer play.

Run ``python -m validation.tools.check_in_browser SITE`` with a built site, the packages playwright
and meshcat, and Debian's package chromium. Every page is opened offline; an error in its console or
a request to the network is a fault. Exit status 1 if there is a fault.
"""

import io
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory

from playwright.sync_api import Page, sync_playwright

from quasistatic_ref.cli.main import main as command

WIDTHS = (360, 1280)
"""Of a small phone and of a small laptop [px]."""
HEIGHT = 900
LISTING = "_modules"
"""The folder of listings of source, which share one frame: the first one stands for all."""
SCENES = ("bunny_grasp", "peg_in_hole", "panda_push")
"""Of the viewer: a cloud, solids, a robot's meshes."""
BEYOND = """
() => {
  const width = document.documentElement.clientWidth + 1.5;  // rounding
  const scrolls = e => ['auto', 'scroll'].includes(getComputedStyle(e).overflowX);
  const inside = '.sidebar-drawer, .toc-drawer, .skip-to-content, .visually-hidden,'
    + 'mjx-container, svg *';
  const beyond = [];
  const look = element => {
    if (element.matches(inside) || scrolls(element)) return;
    const box = element.getBoundingClientRect();
    if (box.width && box.right > width) beyond.push(element.outerHTML.slice(0, 80));
    else for (const child of element.children) look(child);
  };
  look(document.body);
  return beyond;
}
"""
"""JavaScript: what reaches out of the window and stands in no box that scrolls."""
LISTINGS = """
() => [...document.querySelectorAll('article pre')].filter(e => {
  const wraps = e.closest('.highlight-sh, .highlight-console, .highlight-output');
  if (wraps) return e.scrollWidth > e.clientWidth + 2;
  const style = getComputedStyle(e);
  return style.whiteSpace !== 'pre' || !['auto', 'scroll'].includes(style.overflowX);
}).map(e => e.textContent.trim().slice(0, 60))
"""
"""JavaScript: lines of a shell, and sentences, wider than their box; other listings that wrap."""
RAW = """
() => {
  const text = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const markup = /^#+ |!\\[|\\]\\(|^:::|\\$\\$|\\{(eq|cite|download)|<(details|summary)>/;
  const raw = [];
  while (text.nextNode()) {
    const inside = text.currentNode.parentElement.closest('pre, code, script, mjx-container');
    const words = text.currentNode.data.trim();
    if (!inside && markup.test(words)) raw.push(words.slice(0, 80));
  }
  for (const formula of document.querySelectorAll('mjx-merror')) raw.push(formula.textContent);
  return raw;
}
"""
"""JavaScript: prose in which markup stands that nothing has read, and formulas with an error."""


@contextmanager
def offline_page() -> Iterator[tuple[Page, list[str]]]:
    """A page of a browser without network, and what goes wrong in it."""
    faults = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_context(offline=True).new_page()

        def requested(url: str) -> None:
            if not url.startswith(("file:", "data:", "blob:")):
                faults.append(f"{page.url} asks for {url}")

        def logged(kind: str, text: str) -> None:
            if kind == "error":
                faults.append(f"{page.url}: {text}")

        page.on("request", lambda request: requested(request.url))
        page.on("console", lambda message: logged(message.type, message.text))
        page.on("pageerror", lambda error: faults.append(f"{page.url}: {error}"))
        yield page, faults
        browser.close()


def layout_faults(page: Page, site: Path) -> Iterator[str]:
    """What is wider than the window, or shown as markup, of every page of the site."""
    paths = [path for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
    listings = [path for path in paths if LISTING in path.parts]
    for path in [path for path in paths if path not in listings[1:]]:
        page.goto(path.as_uri())
        page.wait_for_function("!window.MathJax?.startup || MathJax.startup.promise.then(() => 1)")
        for words in page.evaluate(RAW):
            yield f"{path.relative_to(site)} shows markup: {words}"
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": HEIGHT})
            for element in page.evaluate(BEYOND):
                yield f"{path.relative_to(site)} at {width} px: {element}"
        if LISTING not in path.parts:
            for code in page.evaluate(LISTINGS):
                yield f"{path.relative_to(site)}: cut off or wrapped: {code}"


def open_viewers(page: Page) -> None:
    """Open the pages of ``run --view``, and wait until they play."""
    for name in SCENES:
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            with redirect_stdout(io.StringIO()):
                command(["run", name, "--view", "--set", "steps=30", "--out", str(folder)])
            page.goto((folder / f"{name}.html").as_uri())
            page.wait_for_function("typeof viewer !== 'undefined' && viewer.animator.time > 0")


def main() -> int:
    """Print every fault of the pages of the site and of the viewer."""
    if len(sys.argv) != 2:
        sys.exit("usage: python -m validation.tools.check_in_browser SITE")
    site = Path(sys.argv[1]).resolve()
    with offline_page() as (page, faults):
        faults += layout_faults(page, site)
        open_viewers(page)
    print("\n".join(faults) or "all pages open, and fit")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

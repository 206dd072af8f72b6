"""A headless Chromium without network, spoken to through a pipe: no package, no port."""

import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome")
OPTIONS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL on a machine without a screen
    "--window-size=900,700", "--remote-debugging-pipe",
)  # fmt: skip
PATIENCE = 120.0
"""Longest wait for an answer [s]: Chromium's first start on a busy machine takes many."""


def browser_path() -> str:
    """Where Chromium is; ends the script where it is not: what needs it must not be skipped."""
    for name in NAMES:
        if path := shutil.which(name):
            return path
    sys.exit("no Chromium on this machine: install Debian's package chromium")


def check(wrong: bool, sentence: str) -> None:
    """End the script with a sentence if something of a page is wrong."""
    if wrong:
        sys.exit(f"the page is wrong: {sentence}")


class Browser:
    """A page in a headless browser; a context that ends the browser.

    ``events`` holds everything that the browser reported: requests, errors, console messages.
    """

    def __init__(self) -> None:
        self.events = []
        # Chromium's helper processes end after it and still write into the folder.
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_child, from_us = os.pipe()
        from_child, to_us = os.pipe()
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (to_child, to_us)]

        def take_pipe() -> None:  # Chromium reads from 3 and writes to 4
            os.dup2(ends[0], 3)
            os.dup2(ends[1], 4)

        command = [browser_path(), *OPTIONS, f"--user-data-dir={self._folder.name}", "about:blank"]
        self._process = subprocess.Popen(
            command, preexec_fn=take_pipe, pass_fds=(3, 4),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        for end in (to_child, to_us, *ends):
            os.close(end)
        self._write = from_us
        self._read = from_child
        self._left = b""
        self._last = 0
        self._session = ""
        (target,) = (t for t in self.ask("Target.getTargets")["targetInfos"] if t["type"] == "page")
        attached = self.ask("Target.attachToTarget", targetId=target["targetId"], flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.ask(f"{domain}.enable")
        self.ask(
            "Network.emulateNetworkConditions", offline=True, latency=0,
            downloadThroughput=-1, uploadThroughput=-1,
        )  # fmt: skip

    def __enter__(self) -> "Browser":
        return self

    def __exit__(self, *exception: object) -> None:
        self._process.terminate()
        self._process.wait(PATIENCE)
        os.close(self._write)
        os.close(self._read)
        self._folder.cleanup()

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The result of one command of the DevTools protocol."""
        self._last += 1
        message = {"id": self._last, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE
        while True:
            answer = self._next(until)
            if answer.get("id") == self._last:
                if "error" in answer:
                    sys.exit(f"{method}: {answer['error']['message']}")
                return dict(answer["result"])
            self.events.append(answer)

    def value(self, expression: str) -> Any:
        """What a JavaScript expression comes to; its error ends the script."""
        done = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in done:
            sys.exit(f"{expression}: {done['exceptionDetails']}")
        return done["result"].get("value")

    def open(self, page: Path) -> None:
        """Load a file, and wait until it has loaded."""
        self.ask("Page.navigate", url=page.resolve().as_uri())
        self.until("document.readyState === 'complete'")

    def until(self, condition: str) -> None:
        """Wait for an expression to be true."""
        end = time.monotonic() + PATIENCE
        while not self.value(condition):
            if time.monotonic() > end:
                sys.exit(f"in vain waited for {condition}")
            time.sleep(0.01)

    def faults(self) -> list[str]:
        """What was asked of the network, and errors, in the pages and in the console."""
        found = []
        for event in self.events:
            params = event.get("params", {})
            url = params.get("request", {}).get("url", "file:")
            level = params.get("entry", {}).get("level") or params.get("type")
            if not url.startswith(("file:", "data:", "blob:")):
                found.append(f"it asks for {url}")
            elif event.get("method") == "Runtime.exceptionThrown" or level == "error":
                found.append(f"an error: {params}")
        return found

    def screenshot(self, whole: bool = False) -> bytes:
        """The window as a PNG, or the whole page."""
        shot = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        return base64.b64decode(shot["data"])

    def _next(self, until: float) -> dict[str, Any]:
        while b"\0" not in self._left:
            if not select.select([self._read], [], [], max(until - time.monotonic(), 0))[0]:
                sys.exit("the browser does not answer")
            part = os.read(self._read, 1 << 20)
            if not part:
                sys.exit("the browser ended")
            self._left += part
        message, self._left = self._left.split(b"\0", 1)
        return dict(json.loads(message))

"""The checker of the site's layout finds a planted fault, and never passes without a browser."""

import shutil
import subprocess
import sys

from validation.tools.browser import NAMES
from validation.tools.check_layout import ROOT

WIDE = '<!doctype html><title>b</title><table id="wide" style="width:700px"><tr><td>y</table>'


def checked(site):
    command = [sys.executable, "-m", "validation.tools.check_layout", str(site)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


def test_an_element_that_is_too_wide_for_a_phone_is_named_with_its_page(tmp_path):
    (tmp_path / "guides").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>a</title><p>x</p>")
    (tmp_path / "guides" / "b.html").write_text(WIDE)
    done = checked(tmp_path)
    assert done.returncode == 1
    if not any(map(shutil.which, NAMES)):  # nothing was looked at, which is no success
        assert "no Chromium" in done.stderr
        return
    assert done.stdout.splitlines() == [
        "guides/b.html at 400 px: the page is 708 px wide",
        'guides/b.html at 400 px: table#wide "y" reaches from 8 to 708 px',
    ]


def test_an_empty_folder_is_no_site(tmp_path):
    done = checked(tmp_path)
    assert done.returncode == 1
    assert "holds no page" in done.stdout or "no Chromium" in done.stderr

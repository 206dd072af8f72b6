"""The port needs nothing of this package."""

import re

from validation.tools.ports import PORT

LIBRARIES = {"bufio", "encoding/json", "fmt", "math", "math/big", "os", "path/filepath", "sort"}
IMPORT = re.compile(r'^(?:import |\t)"([\w/]+)"$', re.MULTILINE)


def test_the_port_in_go_imports_its_own_library_alone():
    texts = [path.read_text("utf-8") for path in PORT.glob("*.go")]
    assert {name for text in texts for name in IMPORT.findall(text)} == LIBRARIES

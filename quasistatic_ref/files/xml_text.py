"""The XML of URDF and COLLADA files: parsed without declarations, and not without end."""

import re
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from quasistatic_ref.errors import ModelError

DEEPEST = 100
"""Most elements in one another; other readers of XML recurse, and end the process."""
MOST_ELEMENTS = 100_000
"""Most elements of a file, and most attributes: each takes some 200 bytes, and a few letters of the
file."""
LONGEST_WORD = 4000
"""Most characters of the name of an element or of an attribute, and of what an attribute of a URDF
says: paths have fewer."""


def xml_root(text: str) -> Element:
    """Root element of a document without a DOCTYPE.

    Raises
    ------
    ModelError
        If the text is not well-formed, is nested without end, has very many elements or very long
        names, or declares a document type:
        entities of its own are never needed in a model, and can expand without bound.
    """
    # It says nothing more of a text; where it is not at the start, other readers pass it over.
    text = re.sub(r"<\?xml\s[^>]*\?>", "", text, count=1)
    builder = TreeBuilder()
    parser = expat.ParserCreate()
    parser.buffer_text = True

    def refusal(*_: object) -> None:
        problem = "has a DOCTYPE, whose entities are not expanded; leave it out"
        raise ModelError(problem, field=f"line {parser.CurrentLineNumber}")

    parser.StartDoctypeDeclHandler = refusal
    depth = 0
    count = 0
    said = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count, said
        depth += 1
        count += 1
        said += len(attributes)
        problem = ""
        if depth > DEEPEST:
            problem = f"is nested deeper than {DEEPEST} elements"
        elif count > MOST_ELEMENTS:
            problem = f"has more than {MOST_ELEMENTS} elements"
        elif said > MOST_ELEMENTS:
            problem = f"has more than {MOST_ELEMENTS} attributes"
        elif max(map(len, (name, *attributes))) > LONGEST_WORD:
            problem = f"has a name of more than {LONGEST_WORD} characters"
        if problem:
            raise ModelError(problem, field=f"line {parser.CurrentLineNumber}")
        builder.start(name, attributes)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(name)

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        problem = f"is not well-formed XML: {expat.ErrorString(error.code)}"
        raise ModelError(problem, field=f"line {error.lineno}") from None
    return builder.close()

"""What the tests of this folder say: a name, the file to change, and what to write or to run."""


def sentences(these, those, missing, spare=""):
    """A sentence for each name of one set that the other has not.

    ``missing`` is said of a name of these that is not among those, ``spare`` of one of those that
    is not among these, which nothing is said of by default; {} in it is the name.
    """
    these, those = {*these}, {*those}
    yield from (missing.replace("{}", name) for name in sorted(these - those))
    if spare:
        yield from (spare.replace("{}", name) for name in sorted(those - these))


def assert_none(rows):
    """Of each row of two sets the names are the same, or among the others if none can be spare."""
    said = [sentence for row in rows for sentence in sentences(*row)]
    assert not said, "\n" + "\n".join(said)


def assert_alike(*row):
    """The two sets of names of one row are as they should be."""
    assert_none([row])

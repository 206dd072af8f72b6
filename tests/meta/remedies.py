"""What the tests of this folder say: a name, the file to change, and what to write or to run."""


def assert_alike(these, those, missing, spare):
    """Two sets of names are equal; if not, a sentence for each name that one of them has alone.

    ``missing`` is said of a name of these that is not among those, ``spare`` of one of those that
    is not among these; {} in it is the name.
    """
    these = set(these)
    those = set(those)
    said = [missing.replace("{}", name) for name in sorted(these - those)]
    said += [spare.replace("{}", name) for name in sorted(those - these)]
    assert not said, "\n" + "\n".join(said)


def assert_among(these, those, missing):
    """All names of these are among those; if not, a sentence for each that is not."""
    assert_alike(these, {*these} & {*those}, missing, "")

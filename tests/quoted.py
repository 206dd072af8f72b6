"""Numbers that a page of the documentation quotes, against the results that they come from."""

import re

NUMBER = re.compile(r"(?<![\w.])\d[\d,.]*(?:e[+-]?\d+)?")
NO_QUOTE = re.compile(r"`[^`]*`|\]\([^)]*\)")
"""Code and addresses of links."""
WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def word(number):
    """A small number as a word."""
    return WORDS[number] if number < len(WORDS) else f"{number:,}"


def flat(text):
    """A text in one line, single spaces."""
    return " ".join(text.split())


def filled(held):
    """The phrases of (phrase with braces, function that returns what fills them), as they read."""
    return [phrase.format(*values()) for phrase, values in held]


def stale(page, phrases):
    """The phrases, as they ought to read, that do not stand on a page."""
    return [phrase for phrase in phrases if phrase not in flat(page)]


def unheld(page, phrases, constants):
    """Numbers on a page that stand in none of the phrases, and are no constants of its text."""
    rest = flat("\n".join(line for line in page.splitlines() if not line.startswith("|")))
    for phrase in sorted(phrases, key=len, reverse=True):
        rest = rest.replace(phrase, " ")
    return list(NUMBER.findall(NO_QUOTE.sub(" ", constants.sub(" ", rest))))

"""Command lines of the program."""

WRITE_NOTHING = {"again", "reproduce", "check", "validate"}


def over(words):
    """A command line's words where it may replace what is there."""
    return [*words] if str(words[0]) in WRITE_NOTHING else [*words, "--overwrite"]

"""Errors that end the program with a message and an exit status."""

import sys


class PlotterError(Exception):
    """A message for people, and the exit status that the program ends with."""

    status = 1

    def __init__(self, message, status=None):
        super().__init__(message)
        self.status = self.status if status is None else status


class UsageError(PlotterError):
    """The command line asks for something that cannot be done."""

    status = 2


class InputError(PlotterError):
    """A file cannot be read or has mistakes."""

    status = 3


class OutputError(PlotterError):
    """The plot cannot be drawn or written."""

    status = 5


def status_of(name, plot, options):
    """The exit status of the plotter of this name, whose errors are printed."""
    try:
        plot(options)
    except PlotterError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return error.status
    return 0

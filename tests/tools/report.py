"""What scripts print of what they hold a program to."""

import sys


class Report:
    """Prints what was measured, and remembers whether anything failed."""

    def __init__(self):
        self.failures = 0

    def hold(self, condition, text):
        """`condition` must be true; comparisons with NaN are not."""
        self.failures += not condition
        print(("ok      " if condition else "FAILED  ") + text, flush=True)

    def end(self, hint=""):
        """Ends the program with exit status 1 where anything failed."""
        if self.failures:
            sys.exit(f"{self.failures} failed{hint}")

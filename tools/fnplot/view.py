"""What of time is drawn, and what of it counts. All times are in nanoseconds."""

from dataclasses import dataclass
from functools import cached_property

from fnplot.times import TimeAxis, exact_text


@dataclass(frozen=True)
class View:
    """The stretch of time that is drawn, and the stretch over which D, ∫g and still gain are meant."""

    begin_ns: int
    end_ns: int
    counted_begin_ns: int
    counted_end_ns: int
    duration_ns: int | None  # of the capture, where it is known

    @cached_property
    def axis(self):
        return TimeAxis(self.begin_ns, self.end_ns)

    @property
    def counts(self):
        """Whether anything does: a single control point has no extent."""
        return self.counted_begin_ns < self.counted_end_ns

    @property
    def counted_text(self):
        """`over the capture (3 s)`"""
        if self.duration_ns is not None:
            return f"over the capture ({exact_text(self.duration_ns)})"
        ends = f"{exact_text(self.counted_begin_ns)} to {exact_text(self.counted_end_ns)}"
        return f"over the control points ({ends})"


def make_view(functions, duration_ns=None, zoom_ns=None):
    """A view of all control points, and of the whole capture, with margins for the held ends.

    zoom_ns: (begin, end) to draw instead. It does not change what counts: the capture, and where its
    duration is not known what of the control points' extent lies after its start.
    """
    first_ns = min(function.first_ns for function in functions)
    last_ns = max(function.last_ns for function in functions)
    counted = (0, duration_ns) if duration_ns is not None else (max(first_ns, 0), max(last_ns, 0))
    if zoom_ns:
        return View(*zoom_ns, *counted, duration_ns)
    # A single time has no width; it is shown with the way to the capture's start, or 1 µs.
    from_start = duration_ns is not None or first_ns == last_ns
    begin_ns = min(first_ns, 0) if from_start else first_ns
    end_ns = max(last_ns, duration_ns or 0)
    if begin_ns == end_ns:
        end_ns += 1000
    margin_ns = -(-(end_ns - begin_ns) // 25)
    return View(begin_ns - margin_ns, end_ns + margin_ns, *counted, duration_ns)

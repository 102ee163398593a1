"""What is told of captures and pictures, field by field."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Literal, Optional, TypedDict, Union

if TYPE_CHECKING:
    from ._nutik import Picture as HeldPicture

Json = Union[None, bool, int, float, str, "list[Json]", "dict[str, Json]"]


Tiles = TypedDict("Tiles", {"still": int, "rows": int, "dense": int, "records": int})
Bound = TypedDict("Bound", {"light": float, "steps": float})


class Figures(TypedDict):
    """What a capture is. Times are nanoseconds, rate is samples a second, shutter_angle degrees."""

    samples: int
    duration_ns: int
    rate: Fraction
    is_constant_rate: bool
    shutter_angle: Fraction
    white: int
    transfer: str
    primaries: str
    pixel_aspect: Fraction
    tolerance: int
    blocks: int
    records: int
    tiles: Tiles
    file_bytes: int
    raw_bytes: int
    memory_bytes: int
    codec: str


class PlannedFunction(TypedDict):
    """A tag of the mask; live_ns is (first, last), support_ns D, by which the integral is divided."""

    tag: int
    pixels: int
    live_ns: tuple[int, int]
    samples: int
    still_gain: float
    support_ns: int
    integral_ns: float


class Plan(TypedDict, total=False):
    """What an exposure touched; samples_read is (first, one past the last)."""

    samples: int
    live_samples: int
    samples_read: tuple[int, int]
    blocks_read: int
    blocks: Optional[int]
    table_bytes: int
    map_bytes: int
    functions: list[PlannedFunction]


class Statistics(TypedDict, total=False):
    """What the rendering took; None where the driver does not time kernels."""

    read_ms: float
    expose_ms: Optional[float]
    develop_ms: Optional[float]
    payload_bytes: int
    device_bytes: int
    blocks: int
    launches: int


# What else a term has follows from its name (docs/explanation/uncertainty.md).
Term = TypedDict("Term", {
    "term": str, "is": Literal["bound", "deviation", "count", "no_bound"], "light": float, "codes": float,
    "float_steps": float, "share_of_bounds": float, "residual_pixels": float, "made_samples": float,
    "exposed_samples": float}, total=False)


class Uncertainty(TypedDict, total=False):
    """scale: S, the largest integral of |gain| / D of a function. bounds: the sum of all terms that are bounds."""

    scale: float
    terms: list[Term]
    bounds: Term


class PictureFigures(TypedDict, total=False):
    precision: str
    error_bound: Optional[Bound]
    uncertainty: Uncertainty
    bounds_maps: "dict[str, HeldPicture]"
    saturated: Optional[tuple[int, int]]
    plan: Plan
    statistics: Statistics
    warnings: list[str]
    reference_white: float

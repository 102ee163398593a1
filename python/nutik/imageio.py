"""Captures for imageio: once this module is imported, imageio reads .tik files, sample by sample.

    >>> import nutik.imageio, imageio                   # doctest: +SKIP
    >>> codes = imageio.volread("clip.tik")             # doctest: +SKIP
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ._captures import Capture, Codes
from ._sources import open

_Format: Any = import_module("imageio.core").Format  # it has no types


class CaptureFormat(_Format):  # type: ignore[misc]
    """Reads the codes that a capture holds; imageio's metadata are `figures`, and of a sample `time`, in seconds."""

    def _can_read(self, request: Any) -> bool:
        return str(request.filename).endswith(".tik")

    def _can_write(self, request: Any) -> bool:
        return False

    class Reader(_Format.Reader):  # type: ignore[misc]
        def _open(self, **stated: Any) -> None:
            self._capture: Capture = open(self.request.get_local_filename(), **stated)
            self._times = self._capture.times
            self._is_volume = self.request.mode[1] in "vV"  # all samples are one

        def _close(self) -> None:
            self._capture.close()

        def _get_length(self) -> int:
            return 1 if self._is_volume else len(self._capture)

        def _get_data(self, index: int) -> tuple[Codes, dict[str, float]]:
            if not 0 <= index < self._get_length():
                raise IndexError(f"sample {index} of {self._get_length()}")
            return self._capture[:] if self._is_volume else self._capture[index], {"time": float(self._times[index])}

        def _get_meta_data(self, index: Any) -> dict[str, object]:
            return {**self._capture.figures} if index is None else {"time": float(self._times[index])}


import_module("imageio").formats.add_format(CaptureFormat("NUTIK", "Captures of nutik-cl", ".tik", "iIvV"),
                                            overwrite=True)

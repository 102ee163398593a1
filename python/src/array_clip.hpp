// Clips that lie in memory or are made picture by picture: NumPy arrays, and iterators of them.
//
//   in:      an array [samples, height, width] or [samples, height, width, 3] of uint8 or uint16, however it is
//            strided; or an iterator of such pictures
//   always:  an array is read where it lies, without Python's lock, and lives as long as the clip. An iterator is
//            called with the lock held, on the thread that reads, and what it raises comes back to the caller
#pragma once

#include <pybind11/numpy.h>

#include "align/alignment.hpp"

namespace nutik::python {

// What its owner says of the pictures' codes and times, beside a SourceRequest.
struct PictureNotes {
  ClipTiming timing;
  Shape shape;
  std::uint32_t code_bytes = 1;
  std::uint64_t sample_count = 0;  // 0: an iterator does not say
  std::optional<double> white_light = std::nullopt;  // where codes are light that was rounded to the nearest
};

[[nodiscard]] OpenClip open_array(const pybind11::array& pictures, PictureNotes notes, ClipOptions options,
                                  std::string name);
// To be opened once.
[[nodiscard]] OpenClip open_iterator(const pybind11::iterator& pictures, PictureNotes notes,
                                     ClipOptions options, std::string name);

}  // namespace nutik::python

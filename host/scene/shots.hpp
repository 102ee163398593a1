// The shots of a capture: what was filmed without a cut.
//
//   always:  shots follow one another, from the first sample to the last; what lies between two is a dissolve or a fade
//            (scene/dissolves.hpp), and of neither. A flash is no cut, as the scene after it is the one
//            before it, nor a light that is switched on, nor a camera that turns fast, as all its pictures differ.
//            The first picture or the last is a shot of its own also where it replaces a sixteenth of the scene and the
//            eight pictures next to it hardly differ
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "imev/sample_cursor.hpp"
#include "scene/dissolves.hpp"

namespace nutik {

// Looks at every sample. Throws InputError where the capture is damaged.
[[nodiscard]] std::vector<SampleRange> shots_of(CaptureSource& capture);

// The samples that they begin with, as text; `part` is the number of the first.
[[nodiscard]] std::string starts_of(std::span<const SampleRange> shots, std::uint64_t part = 0);

// The same of rasters, one after the other.
class ShotFinder {
 public:
  explicit ShotFinder(const CaptureFormat& format);
  void add(std::span<const std::byte> raster);
  [[nodiscard]] std::vector<SampleRange> shots() const;

 private:
  CaptureFormat format_;
  std::vector<float> before_, last_;          // means of cells
  std::vector<double> steps_, double_steps_;  // from one sample, and from two, before each
  std::vector<double> correlations_;          // of the first two, the next two, …
  DissolveFinder dissolves_;
};

// Every so many pixels of a row and every so many rows of a sample, for what needs no more of it.
class ThinRaster {
 public:
  ThinRaster(const CaptureFormat& capture, std::uint32_t step);

  [[nodiscard]] const CaptureFormat& format() const { return thin_; }
  [[nodiscard]] std::span<const std::byte> raster() const { return raster_; }

  // Takes what tiles hold.
  void take(const SampleCursor& held, std::span<const std::uint32_t> tiles);

 private:
  template <typename Code, std::size_t kChannels>
  void take(const SampleCursor& held, std::span<const std::uint32_t> tiles);

  CaptureFormat thin_;
  Shape shape_;  // of the capture
  TileGrid grid_;
  std::uint32_t step_;
  std::vector<std::byte> raster_;
};

}  // namespace nutik

// The shots of a capture: what was filmed without a cut.
//
//   always:  shots follow one another, from the first sample to the last; what lies between two is a dissolve or a fade
//            (DissolveFinder), and of neither. A flash is no cut, as the scene after it is the one before it, nor a
//            light that is switched on, nor a camera that turns fast, as all its pictures differ.
//            The first picture or the last is a shot of its own also where it replaces a sixteenth of the scene and the
//            eight pictures next to it hardly differ
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "imev/sample_cursor.hpp"

namespace nutik {

// Looks at every sample. Throws InputError where the capture is damaged.
[[nodiscard]] std::vector<SampleRange> shots_of(CaptureSource& capture);

// The samples that they begin with, as text; `part` is the number of the first.
[[nodiscard]] std::string starts_of(std::span<const SampleRange> shots, std::uint64_t part = 0);

// Where one shot turns into another over several pictures: a dissolve, or a fade through black or white.
//
//   in:      each picture's means of cells, as shares of white
//   out:     the pictures that show something of both
//   always:  both ends differ in most cells and in their fine structure, and most cells of either are neither black nor
//            white. What lies between is their sum, with less and less of the first and more and more of the second.
//            Hence no flash, no lamp, no exposure that drifts, no pan or zoom, nothing that moves. Of a dissolve a
//            tenth of the cells may move; one between pictures that move more is not told from those
class DissolveFinder {
 public:
  // Pictures have so many cells, a channel beside the other.
  explicit DissolveFinder(const Shape& cells) : cells_(cells) {}

  void add(const std::vector<float>& means);
  // In order, apart from each other.
  [[nodiscard]] const std::vector<SampleRange>& found() const { return found_; }

 private:
  // A picture without its mean, and what is left of that without the mean of each cell's neighbours.
  struct Layer {
    std::vector<float> values;
    double square = 0;
  };
  struct Look {
    std::vector<float> means;
    Layer coarse, fine;
    bool is_exposed = false;  // most cells are neither black nor white
  };

  void test(std::size_t first);

  Shape cells_;
  std::deque<Look> looks_;  // at the last pictures
  std::uint64_t count_ = 0;
  std::vector<SampleRange> found_;
};

// The shots of rasters, one after the other.
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

// When places of a picture show what they hold longest as a whole.
//
//   in:      a capture, which of its pixels are uncertain, how far codes of the same light may lie apart
//   out:     a clock for each place, which is a group of connected uncertain pixels. It runs while most of the place
//            has its most frequent look; always, if it has that for less than an eighth of the time
//   always:  a subject that hardly stirs holds many of its pixels longer than the background does, but not all of them
//            at once for that long
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "capture/memory_needs.hpp"
#include "capture/noise_model.hpp"
#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "mask/region.hpp"
#include "scene/looks.hpp"

namespace nutik {

// How far apart codes of the same light may lie: by a camera's noise, or by so many codes.
//
// Codes are sorted into bins. Light is the same if the bins lie within a window, which is twice as wide as codes may
// stray to either side.
class CodeBand {
 public:
  // Codes stray at least so far, in shares of white: by compression, and by cameras that correct their exposure.
  static constexpr double kMinShare = 1.0 / 32;

  // Codes stray by up to `codes` to either side.
  static CodeBand of_codes(const CaptureFormat& capture, std::uint32_t codes);
  // By three standard deviations of the capture's noise, or kMinShare where that is more.
  static CodeBand of_noise(const CaptureFormat& capture, const CameraNoise& noise);

  [[nodiscard]] std::uint32_t bin(std::uint32_t channel, std::uint32_t code) const {
    return bins_[channel][code];
  }
  // How many bins stand for the same light.
  [[nodiscard]] std::uint32_t window() const { return window_; }
  // How many there are, over all channels.
  [[nodiscard]] std::uint32_t bin_count() const;

 private:
  std::vector<std::vector<std::uint32_t>> bins_;  // [channel][code], never decreasing
  std::uint32_t window_ = 1;
};

class PlaceTimes {
 public:
  // What is seen at a look holds until the next. `keep_going` is called often, by several threads; what it throws ends
  // the work. Throws InputError where the capture is damaged.
  PlaceTimes(CaptureSource& capture, const Region& uncertain, const CodeBand& band,
             const std::function<void()>& keep_going);

  // For how long the clock at an uncertain pixel ran until a sample began; sample_count() is the capture's end.
  [[nodiscard]] std::int64_t clock_ns(std::uint32_t x, std::uint32_t y, std::uint64_t sample) const;

  // Whether the place of an uncertain pixel has one look for long enough; otherwise its clock always runs.
  [[nodiscard]] bool has_look(std::uint32_t x, std::uint32_t y) const {
    return clock_of(x, y).before_ns.back() < timeline_.duration_ns();
  }

  // In pixels. What lies closer together is one place.
  [[nodiscard]] static std::uint32_t cell_side(const Shape& shape);
  [[nodiscard]] static MemoryNeeds needs(const CaptureFormat& capture);

 private:
  // From each look to the next: whether a place's clock runs, and how long it ran before.
  struct Clock {
    std::vector<std::uint8_t> runs;
    std::vector<std::int64_t> before_ns;
  };
  struct Spot {  // a pixel that is looked at
    std::uint32_t x, y;
  };

  [[nodiscard]] const Clock& clock_of(std::uint32_t x, std::uint32_t y) const {
    return clocks_[clock_of_cell_[std::size_t{y / side_} * columns_ + x / side_]];
  }
  // Finds places, and returns spots of each.
  std::vector<std::vector<Spot>> spots_of_places(const Region& uncertain);
  // `bins` are those of a place's spots, look by look.
  [[nodiscard]] Clock clock_of(const std::vector<std::uint16_t>& bins, std::uint32_t channels,
                               std::uint32_t reach, const std::function<void()>& keep_going) const;

  const Timeline& timeline_;
  Looks looks_;
  std::vector<std::int64_t> starts_ns_;  // of looks, and the capture's end
  struct Begin {
    std::int64_t since_look_ns;  // from its look's start
    std::uint32_t look;          // the last that is no later
  };
  // When each begins: told for each change of each pixel, which divisions would take long for.
  std::vector<Begin> samples_;
  std::uint32_t side_, columns_, rows_;  // of cells, in pixels; how many
  std::vector<std::size_t> clock_of_cell_;
  std::vector<Clock> clocks_;
};

}  // namespace nutik

// Series: exposures a step apart, and which of many frames are made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "session/requests/exposure_request.hpp"

namespace nutik {

// Frames by their numbers, in the words of render farms.
//
//   1-100      from 1 to 100; 100-1 are the same frames
//   1-100x3    every third: 1, 4, 7, …
//   1-100y3    those that 1-100x3 leaves out
//   1-100:4    all of them; a farm's order says nothing where frames come in their own
//   5,8,20-30  several, with commas or blanks between

class FrameRanges {
 public:
  // Throws UsageError naming `what` where the text is none.
  static FrameRanges parse(std::string_view text, std::string_view what);

  // Those of the first `count` frames, counted from 0, in order and once each. Numbers behind them are left out.
  [[nodiscard]] std::vector<std::uint64_t> below(std::uint64_t count) const;

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  struct Range {
    std::uint64_t least, most;
    std::uint64_t from, step;  // every step-th, from that one on to either side
    bool leaves_out;           // those, and takes the others
  };
  std::vector<Range> ranges_;
  std::string text_;
};

// Those of `ranges`, or all of the first `count` without ranges. Throws UsageError naming `what`, of which the `whole`
// has so many, where that is none.
[[nodiscard]] std::vector<std::uint64_t> chosen_numbers(const std::optional<FrameRanges>& ranges,
                                                        std::uint64_t count, std::string_view what,
                                                        std::string_view whole);

// `3, 7-9`: numbers in order, as they would be stated.
[[nodiscard]] std::string ranges_text(std::span<const std::uint64_t> numbers);

// The same exposure again and again, each a step later.
struct SeriesRequest {
  // More pictures than a folder is pleasant with, and than anybody means.
  static constexpr std::uint32_t kMaxExposures = 1'000'000;

  StatedTime every;                    // longer than nothing; pictures are whole ones
  std::optional<std::uint64_t> count;  // none: as many as end within the capture
  std::optional<FrameRanges> numbers = {};  // of the exposures to make; none: all
};

// The start of each exposure, exactly start + k · every: no drift, and what is added to it is rounded once with it.
// Counted in pictures where both are, else in time. Throws UsageError where one starts behind the capture's end,
// none ends within it, or more than kMaxExposures would and no count was stated.
[[nodiscard]] std::vector<StatedTime> starts_of(const SeriesRequest& series, const ExposureRequest& request,
                                                const Timeline& timeline);

}  // namespace nutik

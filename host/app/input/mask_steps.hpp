// The steps of a mask, as the command line lists them: each selects a region, changes the one before it or
// states the tag of those after it.
//
//   --tag 128 --moving --largest --grow 4 --tag 255 --ellipse 320,180,40,30
//
// selects what moves, keeps its largest part, grows that by 4 pixels and gives it tag 128; then an ellipse gets
// tag 255, over what it covers.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "app/command_line/options.hpp"
#include "mask/region.hpp"

namespace nutik::app {

// A picture file or a time of the capture, as written.
using PictureOrTime = std::string;

namespace select {
struct Whole {};
struct Shape {  // any of the mask's size
  std::function<Region(std::uint32_t width, std::uint32_t height)> draw;
};
struct Threshold {
  PictureOrTime picture;
  double low = 0.0;
  double high = 0.0;
  bool is_share = false;  // of white, in percent; else codes
};
struct Difference {
  PictureOrTime before;
  PictureOrTime after;
};
struct Motion {  // within all of the capture where no times are stated
  std::string from;
  std::string to;
};
struct Stillness {};
struct Grid {  // the whole picture; the cells get the step's tag and those after it
  std::uint32_t columns = 1;
  std::uint32_t rows = 1;
};
}  // namespace select

using Selection = std::variant<select::Whole, select::Shape, select::Threshold, select::Difference,
                               select::Motion, select::Stillness, select::Grid>;

struct MaskStep {
  std::string option;  // `--moving`, for messages
  std::uint8_t tag = 255;
  Selection selection;
  std::uint32_t by_codes = 0;  // what a change has to pass; 0: told from the pictures
  std::vector<std::function<Region(const Region&)>> changes;  // in order

  // Whether it compares codes, and so takes --by.
  [[nodiscard]] bool compares() const;
  // The last of its tags: of a grid that of its last cell, else its only one.
  [[nodiscard]] std::uint8_t last_tag() const;
  // Whether it needs a capture.
  [[nodiscard]] bool reads_capture() const;
  [[nodiscard]] std::vector<std::string> picture_files() const;
};

// All steps, in order. Throws UsageError naming the option whose value makes no sense, or which changes a
// region where none was selected.
[[nodiscard]] std::vector<MaskStep> mask_steps(const Options& options);

// Whether a word that can be a picture or a time is a time.
[[nodiscard]] bool is_time(const PictureOrTime& word);

// `640x360`; throws UsageError.
struct MaskSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const MaskSize&, const MaskSize&) = default;
};
[[nodiscard]] MaskSize parse_mask_size(const std::string& text);

}  // namespace nutik::app

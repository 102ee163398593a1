// A mask as it is asked for: steps, each of which selects a region, changes it, and gives its pixels a tag.
//
//   M128: what moves, its largest part, grown by 4 pixels; then M255: an ellipse
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/picture.hpp"
#include "mask/region.hpp"
#include "session/requests/stated_moments.hpp"
#include "system/shared.hpp"

namespace nutik {

struct NamedPicture {
  std::string name;
  Shared<Picture> picture;
  bool holds_light = false;  // its file does
  bool says_primaries = false;
};
// The capture's picture at a time, or one from elsewhere.
using PictureSource = std::variant<StatedTime, NamedPicture>;

namespace select {

struct Whole {};
struct Rectangle {
  Point corner;
  double width = 0.0;
  double height = 0.0;
};
struct Ellipse {
  Point centre;
  double radius_x = 0.0;
  double radius_y = 0.0;
};
struct Polygon {
  std::vector<Point> corners;
};
struct Grid {  // the whole picture; the cells get the step's tag and those after it
  std::uint32_t columns = 1;
  std::uint32_t rows = 1;
};
struct Threshold {
  PictureSource picture;
  double low = 0.0;
  double high = 0.0;
  bool is_share = false;  // of white, in percent; else codes
};
struct Difference {
  PictureSource before;
  PictureSource after;
};
struct Motion {  // within all of the capture, or between two times
  std::optional<std::pair<StatedTime, StatedTime>> between;
};
struct Subject {  // what differs from the capture's plate at a time
  StatedTime at;
  bool is_without_shadow = false;
};
struct Stillness {};

}  // namespace select

using Selection =
    std::variant<select::Whole, select::Rectangle, select::Ellipse, select::Polygon, select::Grid,
                 select::Threshold, select::Difference, select::Motion, select::Subject, select::Stillness>;

// A change to the region before it.
struct RegionChange {
  enum class Kind { largest, fill_holes, invert, within, grow, shrink, smooth };

  Kind kind = Kind::invert;
  double radius = 0.0;          // to grow, shrink and smooth by, in pixels
  select::Rectangle rectangle;  // to stay within
};

struct MaskStep {
  std::string name;  // for messages
  std::uint8_t tag = 255;
  Selection selection;
  std::optional<std::uint32_t> by_codes;  // only larger changes count; none: told from the pictures
  std::vector<RegionChange> changes;      // in order

  // Whether it compares codes.
  [[nodiscard]] bool compares() const;
  // The last of its tags: of a grid that of its last cell, else its only one.
  [[nodiscard]] std::uint8_t last_tag() const;
  [[nodiscard]] bool reads_capture() const;
  [[nodiscard]] bool needs_plate() const { return std::holds_alternative<select::Subject>(selection); }
  // The pictures that it looks at, without those of the capture.
  [[nodiscard]] std::vector<const NamedPicture*> pictures() const;
};

struct MaskSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const MaskSize&, const MaskSize&) = default;
};

// A mask's size, and where it comes from.
struct NamedSize {
  std::string name;
  MaskSize size;
};

struct NamedMask {
  std::string name;
  Shared<Mask> mask;
};

struct MaskRequest {
  std::optional<NamedMask> base;  // that steps are painted on; none: tag 0 everywhere
  // Needed if neither base, capture nor picture has one; must agree with theirs.
  std::optional<NamedSize> size;
  std::vector<MaskStep> steps;

  // Whether a step tells what moves from what rests, so that a moving camera confuses it.
  [[nodiscard]] bool tells_by_rest() const;
};

// Reads the pictures that the steps name, codes as they stand. Throws as read_picture() does.
void read_named_pictures(MaskRequest& request);

}  // namespace nutik

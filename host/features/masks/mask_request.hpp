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
#include "session/requests/moments.hpp"
#include "system/shared.hpp"

namespace nutik {

// How messages name a part of a request. It does not change what is asked for, so all labels are equal.
struct Label {
  std::string text;
  friend bool operator==(const Label&, const Label&) { return true; }
};

struct NamedPicture {
  Label name;
  Shared<Picture> picture;
  friend bool operator==(const NamedPicture&, const NamedPicture&) = default;
};
// The capture's picture at a time, or one from elsewhere.
using PictureSource = std::variant<StatedTime, NamedPicture>;

namespace select {

struct Whole {
  friend bool operator==(const Whole&, const Whole&) = default;
};
struct Rectangle {
  Point corner;
  double width = 0.0;
  double height = 0.0;
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};
struct Ellipse {
  Point centre;
  double radius_x = 0.0;
  double radius_y = 0.0;
  friend bool operator==(const Ellipse&, const Ellipse&) = default;
};
struct Polygon {
  std::vector<Point> corners;
  friend bool operator==(const Polygon&, const Polygon&) = default;
};
struct Grid {  // the whole picture; the cells get the step's tag and those after it
  std::uint32_t columns = 1;
  std::uint32_t rows = 1;
  friend bool operator==(const Grid&, const Grid&) = default;
};
struct Threshold {
  PictureSource picture;
  double low = 0.0;
  double high = 0.0;
  bool is_share = false;  // of white, in percent; else codes
  friend bool operator==(const Threshold&, const Threshold&) = default;
};
struct Difference {
  PictureSource before;
  PictureSource after;
  friend bool operator==(const Difference&, const Difference&) = default;
};
struct Motion {  // within all of the capture, or between two times
  std::optional<std::pair<StatedTime, StatedTime>> between;
  friend bool operator==(const Motion&, const Motion&) = default;
};
struct Subject {  // what differs from the capture's plate at a time
  StatedTime at;
  bool is_without_shadow = false;
  friend bool operator==(const Subject&, const Subject&) = default;
};
struct Stillness {
  friend bool operator==(const Stillness&, const Stillness&) = default;
};

}  // namespace select

using Selection =
    std::variant<select::Whole, select::Rectangle, select::Ellipse, select::Polygon, select::Grid,
                 select::Threshold, select::Difference, select::Motion, select::Subject, select::Stillness>;

// A change to the region before it.
struct RegionChange {
  enum class Kind { largest, fill, invert, within, grow, shrink, smooth };

  Kind kind = Kind::invert;
  double radius = 0.0;          // to grow, shrink and smooth by, in pixels
  select::Rectangle rectangle;  // to stay within
  friend bool operator==(const RegionChange&, const RegionChange&) = default;
};

struct MaskStep {
  Label name;
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

  friend bool operator==(const MaskStep&, const MaskStep&) = default;
};

struct MaskSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const MaskSize&, const MaskSize&) = default;
};

// A mask's size, and where it comes from.
struct NamedSize {
  Label name;
  MaskSize size;
  friend bool operator==(const NamedSize&, const NamedSize&) = default;
};

struct NamedMask {
  Label name;
  Shared<Mask> mask;
  friend bool operator==(const NamedMask&, const NamedMask&) = default;
};

struct MaskRequest {
  std::optional<NamedMask> base;  // that steps are painted on; none: tag 0 everywhere
  // Needed if neither base, capture nor picture has one; must agree with theirs.
  std::optional<NamedSize> size;
  std::vector<MaskStep> steps;

  // Whether a step tells what moves from what rests, so that a moving camera confuses it.
  [[nodiscard]] bool tells_by_rest() const;

  friend bool operator==(const MaskRequest&, const MaskRequest&) = default;
};

// Reads the pictures that the steps name, codes as they stand. Throws as read_picture() does.
void read_named_pictures(MaskRequest& request);

}  // namespace nutik

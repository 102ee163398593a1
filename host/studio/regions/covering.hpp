// Regions over each other: the first covers the rest.
//
//   in:      a document's state, and pixels that a region gets or loses
//   out:     the state with another mask; what is covered is kept beside it
//   always:  of a covered pixel the mask names a region before all that have it covered. Where a region loses a pixel
//            the next one appears that has it, else the background, which covers nothing and is covered by all
//
//   order     2 1        1 moved up:  1 2
//   mask      2222 11    2 has two    2211 11
//   covered   1:..11     covered      2:..11
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "mask/region.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

class Covering {
 public:
  // Begins with an open document's state. Without a mask all is background.
  explicit Covering(const Document& document);

  // What the region has, covered or not.
  [[nodiscard]] Region area_of(std::uint8_t tag) const;

  void give(const Region& pixels, std::uint8_t tag);
  void take(const Region& pixels, std::uint8_t tag);
  void take_from_all(const Region& pixels);  // the background appears
  // Exchanges its place with the region before it. False: it is the first.
  bool move_up(std::uint8_t tag);

  [[nodiscard]] DocumentState state() &&;

 private:
  [[nodiscard]] bool is_before(std::uint8_t a, std::uint8_t b) const { return rank_[a] < rank_[b]; }
  [[nodiscard]] Region& covered(std::uint8_t tag);  // to be changed
  [[nodiscard]] const Region* covered_now(std::uint8_t tag) const;
  void lose(std::size_t pixel);
  void rank();

  DocumentState state_;
  Mask mask_;
  std::map<std::uint8_t, Region> changed_;  // covered pixels
  std::array<int, kMaskValues> rank_{};
};

// Tidies what a file brought: covered pixels that the mask shows, or that nothing covers, are dropped.
void tidy_covered(DocumentState& state);

}  // namespace nutik::studio

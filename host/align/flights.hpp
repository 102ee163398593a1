// Small things that go further than they are large from one picture to the next: no place shows them twice, so that
// dense flow cannot follow them.
//
//   in:      two pictures of a clip, and what was filmed before and behind them
//   out:     what is found in both: its way, bent as the other pictures show, and its matte in each
//   always:  a thing is what one picture shows where two others agree on something else. A way is believed where the
//            thing, moved along it, explains what changed at both ends. The same pictures give the same flights
#pragma once

#include <cstdint>
#include <vector>

#include "align/flow.hpp"
#include "capture/picture.hpp"

namespace nutik {

// Pictures of one size, rows side by side, in grey of 0 … 255 that looks even to eyes.
struct GreyPictures {
  const std::uint8_t* first = nullptr;
  const std::uint8_t* second = nullptr;
  const std::uint8_t* before = nullptr;  // the first; none at the clip's beginning
  const std::uint8_t* after = nullptr;   // the second; none at its end
};

struct Flight {
  // In one of both pictures; values of each pixel of the box.
  struct Seen {
    Rectangle box;
    std::vector<float> cover;  // how far the other picture shows better what lies behind
    std::vector<float> hides;  // how much of what lies behind is not seen
  };
  FlowVector way;   // from the first picture to the second
  FlowVector bend;  // by how much the way to the next picture is longer
  float believed = 0;
  Seen first, second;

  // How far it has gone after a share of the time.
  [[nodiscard]] FlowVector at(float share) const {
    const float bent = share * (share - 1) / 2;
    return {share * way.x + bent * bend.x, share * way.y + bent * bend.y};
  }
};

[[nodiscard]] std::vector<Flight> find_flights(const GreyPictures& pictures, std::uint32_t width, std::uint32_t height);

}  // namespace nutik

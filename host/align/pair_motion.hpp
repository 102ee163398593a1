// What moved from one picture to the next.
//
//   in:      two pictures of a clip, and those filmed before and behind them
//   out:     how far what moves goes, each pixel's way in both directions, and how far it is believed
//
// Motion is believed where following it explains most of what changed, and where forwards and backwards agree. Small
// things that no dense flow can follow fly over what lies behind them (align/flights.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "align/flights.hpp"
#include "align/flow.hpp"
#include "capture/picture.hpp"

namespace nutik {

class PairMotion {
 public:
  static constexpr std::uint32_t kBlock = 8;      // pixels a side
  static constexpr float kNoise = 4.0F * 4.0F;    // of 255, squared: what differs less has not changed
  static constexpr float kDoubt = 2 * kNoise;     // added to both: little more than noise moves no light

  PairMotion(std::uint32_t width, std::uint32_t height);

  // Uses as many threads.
  void find(const GreyPictures& pictures, std::uint32_t max_threads);
  // How ways that were found are bent, as the pictures before and behind show.
  void find_bends(const GreyPictures& pictures, std::uint32_t max_threads);

  [[nodiscard]] static std::uint64_t bytes(std::uint32_t width, std::uint32_t height);

  // How far what could be followed goes, in pixels; 0 where nothing could.
  [[nodiscard]] double fastest() const { return fastest_; }
  // In how many steps that goes smoothly: a power of 2, so that the steps of slower things are some of them.
  [[nodiscard]] static std::uint32_t steps_for(double pixels);
  // Blocks of pixels that changed, and those whose motion is not believed.
  [[nodiscard]] std::uint64_t changed() const { return changed_; }
  [[nodiscard]] std::uint64_t unfollowed() const { return unfollowed_; }
  // Whether the second picture shows something else: most of it changed, and little of that moved.
  [[nodiscard]] bool is_cut() const;

 private:
  friend class InBetween;

  // How a block of pixels comes from the first picture to the second: in so many steps, a power of 2, of which each
  // moves nothing by much more than a pixel. One step: it holds until the middle.
  struct Way {
    std::uint8_t steps = 1;
    bool is_moved = false;  // else light goes in a straight line
    friend bool operator==(const Way&, const Way&) = default;
  };
  struct Weight {
    float agrees = 0;    // forwards and backwards
    float believed = 0;  // that it moved so
  };
  // Forwards, or backwards; within the box.
  struct Direction {
    std::unique_ptr<FlowFinder> finder;
    std::vector<FlowVector> flow;
    std::vector<FlowVector> bend;  // by how much the way on is longer than the way that led here; empty if unknown
    std::vector<Weight> weights;
    std::vector<float> missed;    // of each block: squared differences that are left along the motion
    std::vector<float> agrees;    // of each block: a mean
    std::vector<float> believed;  // of each block
  };

  void compare(const std::uint8_t* first, const std::uint8_t* second);
  bool choose_box();
  void fly(std::vector<bool>& is_flown);
  void weigh(const std::uint8_t* from, const std::uint8_t* to, Direction& way, const Direction& back,
             std::uint32_t max_threads);
  void believe(Direction& way, std::uint32_t max_threads);
  void mark(const Direction& way);
  // Whether a block's motion is believed and found back.
  [[nodiscard]] static bool is_followed(const Direction& way, std::size_t block);
  [[nodiscard]] FlowVector flow_of(const Direction& way, std::uint32_t column, std::uint32_t row) const;
  // How far off the straight way a pixel is after a share of the time.
  [[nodiscard]] FlowVector bent(std::size_t pixel, float share) const;

  std::uint32_t width_, height_, columns_, rows_;  // pixels, blocks
  std::vector<float> differ_;                      // of each block: squared differences, a mean
  std::vector<Way> ways_;                          // of each block
  Rectangle box_;                                  // what changed, and what lies round it: whole blocks, in pixels
  Direction forwards_, backwards_;
  std::vector<Flight> flights_;
  std::uint64_t changed_ = 0, unfollowed_ = 0;
  double fastest_ = 0;
};

}  // namespace nutik

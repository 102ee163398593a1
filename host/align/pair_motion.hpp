// What moved from one picture to the next, and the pictures between them.
//
//   in:      two pictures of a clip, and those filmed before and behind them
//   out:     how far what moves goes; pictures at any time between, each pixel fetched along the motion from both
//   always:  what did not change keeps its codes. Where the motion is not known light goes in a straight line from one
//            value to the other, and from one kind of place to the other there is no seam
//
// Motion is believed where following it explains most of what changed, and where forwards and backwards agree. Small
// things that no dense flow can follow fly over what lies behind them (align/flights.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "align/flights.hpp"
#include "align/flow.hpp"
#include "align/light_warp.hpp"
#include "capture/picture.hpp"

namespace nutik {

class PairMotion {
 public:
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

// Grey that looks even to eyes, of rasters of a format; each of its pixels is the mean of a square of theirs.
class EvenGrey {
 public:
  EvenGrey(const CaptureFormat& format, std::uint32_t side);

  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }
  // Throws CodeAboveWhite.
  void take(std::span<const std::byte> raster, std::vector<std::uint8_t>& grey, std::uint32_t max_threads) const;

 private:
  CaptureFormat format_;
  std::uint32_t side_, width_, height_;
  std::array<std::vector<float>, 3> looks_;  // of each channel's codes, as much as it counts
};

// Pictures between two.
class InBetween {
 public:
  explicit InBetween(const CaptureFormat& format);

  struct Picture {
    std::vector<std::byte> raster;   // empty: there is none
    std::vector<std::uint8_t> grey;  // empty until it is needed
  };
  // What was filmed before and behind two pictures, which stay until the next call.
  void take(Picture& first, Picture& second, Picture& before, Picture& after);
  // Behind `step` of so many steps from the first to the second. On all cores.
  void make(std::uint32_t step, std::uint32_t steps, std::span<std::byte> raster);

  [[nodiscard]] static std::uint64_t bytes(const CaptureFormat& format);

 private:
  // Four floats, so that a pixel is fetched at once; grey has one of them.
  using Light = float __attribute__((vector_size(16)));

  template <typename Code>
  void read_light(const Code* codes, std::vector<Light>& lights) const;
  template <typename Code>
  void make_block(std::uint32_t column, std::uint32_t row, float share, Code* raster) const;
  static float share_of(const PairMotion::Way& way, std::uint32_t step, std::uint32_t steps);
  [[nodiscard]] Light moved(std::uint32_t x, std::uint32_t y, float share) const;
  static Light at(const std::vector<Light>& lights, const Rectangle& box, float x, float y);
  // A thing that flies, taken out of the picture: its light, and in the last place how much it hides.
  struct Taken {
    Rectangle box;
    std::vector<Light> lights;
    [[nodiscard]] Light at(float x, float y) const;
  };
  [[nodiscard]] Taken taken(const Flight::Seen& seen, std::vector<Light>& lights,
                            const std::vector<Light>& behind) const;

  CaptureFormat format_;
  EvenGrey grey_;
  LightTables tables_;
  std::vector<float> light_;  // of each code, as of the tables
  PairMotion motion_;
  std::span<const std::byte> first_, second_;
  std::vector<Light> first_light_, second_light_;  // within the motion's box, without what flies
  std::vector<std::pair<Taken, Taken>> taken_;     // of each flight, out of both
  std::vector<std::byte> made_;                    // last
  std::vector<float> shares_;                      // of the way that each block of it has gone
};

}  // namespace nutik

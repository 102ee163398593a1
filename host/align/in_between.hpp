// Pictures between two filmed ones, each pixel fetched along the motion (align/pair_motion.hpp) from both.
//
//   always:  what did not change keeps its codes, and still ground beside what moves stays. Where the motion is not
//            known light goes in a straight line from one value to the other, and from one kind of place to the other
//            there is no seam
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "align/light_tables.hpp"
#include "align/pair_motion.hpp"
#include "capture/picture.hpp"

namespace nutik {

// Grey that looks even to eyes, of rasters of a format; each of its pixels is the mean of a square of theirs.
class EvenGrey {
 public:
  EvenGrey(const CaptureFormat& format, std::uint32_t side);

  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }
  // Throws CodeAboveWhite.
  void take(std::span<const std::byte> raster, std::vector<std::uint8_t>& grey,
            std::uint32_t max_threads) const;

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
  // At a place at that time: by how much the way through it is longer than both directions say together.
  struct Chosen {
    FlowVector more;
    float believed = 0;
  };

  // Four floats, so that a pixel is fetched at once; grey has one of them.
  using Light = float __attribute__((vector_size(16)));

  template <typename Code>
  void read_light(const Code* codes, std::vector<Light>& lights) const;
  template <typename Code>
  void make_block(std::uint32_t column, std::uint32_t row, float share, Code* raster) const;
  static float share_of(const PairMotion::Way& way, std::uint32_t step, std::uint32_t steps);
  [[nodiscard]] Light moved(std::uint32_t x, std::uint32_t y, float share) const;
  [[nodiscard]] FlowVector way_through(std::size_t pixel, float share) const;
  // What remains along a way, of what changes at the place otherwise, and how far the way is believed for that.
  struct Tried {
    float left = 0, believed = 0;
  };
  [[nodiscard]] Tried tried(std::uint32_t x, std::uint32_t y, const FlowVector& more, float share) const;
  void choose_ways(std::uint32_t column, std::uint32_t row, float share);
  [[nodiscard]] Chosen chosen_at(std::uint32_t x, std::uint32_t y) const;
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
  GreyPictures grey_pictures_;
  std::vector<Chosen> chosen_;        // of each place of a grid
  std::vector<float> chosen_shares_;  // of each block
  std::vector<std::byte> made_;       // last
  std::vector<float> shares_;         // of the way that each block of it has gone
};

}  // namespace nutik

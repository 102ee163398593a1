// The mean light of regions over time, from one look at a capture.
//
//   in:      a capture, the mask that it is exposed with, regions of the picture
//   out:     a course of light for each region and each function that exposes a part of it: the region's light in a
//            picture is Σ_m ∫ g_m · course_m / X_m
//   always:  each block is read once, however many regions there are
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "capture/transfer.hpp"
#include "exposure/compensated_sum.hpp"
#include "exposure/gain_function.hpp"
#include "exposure/mask.hpp"
#include "imev/capture_source.hpp"
#include "system/interruption.hpp"

namespace nutik {

// The light of a region over time, and its integral times a gain: every candidate exposure follows from that, without
// another look at the capture.
//
//   units:   time in nanoseconds, light of white is 1
//   always:  light holds while a sample is exposed and runs straight across gaps (docs/explanation/model.md).
//            Integrals are exact but for rounding: sums of products, of which none cancel that the gain does not
using ChannelLight = std::array<double, 3>;  // as many as there are channels, else 0

class LightCourse {
 public:
  // The light of the samples from `first` on. Before them nothing is known, and after the last of them it holds.
  LightCourse(const Timeline& timeline, std::uint64_t first, std::vector<ChannelLight> light);

  // What a course of so many samples takes.
  [[nodiscard]] static std::uint64_t bytes(std::uint64_t samples);

  // ∫ light · gain over the pieces.
  [[nodiscard]] ChannelLight integral_ns(std::span<const GainPiece> pieces) const;

 private:
  // Stretch 2 k is the exposure of the k-th sample, 2 k + 1 the gap behind it.
  [[nodiscard]] std::size_t stretch_at(std::int64_t time_ns) const;
  void add_stretch(std::size_t stretch, const GainPiece& piece, std::array<CompensatedSum, 3>& sums) const;

  // Runs of stretches, summed up about their middle.
  struct Run {
    std::int64_t begin_ns = 0, end_ns = 0;
    ChannelLight light_ns{};    // ∫ light
    ChannelLight moment_ns2{};  // ∫ light · (time − middle)
  };

  std::vector<ChannelLight> light_;
  std::vector<std::int64_t> edges_ns_;  // where stretches begin, and where the last one ends
  std::vector<Run> runs_;               // of kRun stretches each; those that are left over have none
};

// The pixels that meet all conditions; without conditions all of them.
struct LightRegion {
  std::optional<std::uint8_t> tag;   // of the exposure's mask: each pixel by the share that it has
  std::optional<std::uint8_t> mark;  // of a second mask
  std::optional<Rectangle> within;
  friend bool operator==(const LightRegion&, const LightRegion&) = default;
};

struct RegionLight {
  std::map<std::uint8_t, LightCourse> courses;  // by the mask value of the function that exposes them
  std::map<std::uint8_t, ChannelLight>
      plate;               // the same of the scene without what moves; empty where none was given
  double white_share = 0;  // of its light, over time, that is held at the white code
};

// The weights of a region's pixels, one after another.
class RegionPixels {
 public:
  // Masks outlive it. `marks` may be null where no region has a mark.
  RegionPixels(const Mask& mask, const Mask* marks) : mask_(mask), marks_(marks) {}
  // 0 where it is not in the region, at most 1.
  [[nodiscard]] double weight(const LightRegion& region, std::uint64_t pixel) const;

 private:
  const Mask& mask_;
  const Mask* marks_;
};

// The mean light of a region in a picture of light64, by channel.
[[nodiscard]] ChannelLight mean_light(const Picture& light, const RegionPixels& pixels,
                                      const LightRegion& region);

// The memory that measure_regions() takes for the same, beside a block and a plate.
[[nodiscard]] MemoryNeeds region_light_needs(const CaptureSource& capture, const Mask& mask,
                                             const Mask* marks, const std::vector<LightRegion>& regions,
                                             SampleRange samples);

// Measures `samples`, of which there must be some. `plate`, light64 of the same shape, may be null. Throws InputError
// for a damaged block; `progress` counts blocks.
[[nodiscard]] std::vector<RegionLight> measure_regions(
    CaptureSource& capture, const Transfer& transfer, const Mask& mask, const Mask* marks,
    const std::vector<LightRegion>& regions, const Picture* plate, SampleRange samples,
    const ReportedProgress& progress = {});

}  // namespace nutik

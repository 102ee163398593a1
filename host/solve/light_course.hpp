// How the light of a region goes over time, and the integral of that times a gain: what every candidate exposure is
// told from, without another look at the capture.
//
//   units:   time in nanoseconds, light of white is 1
//   always:  light holds while a sample is exposed and runs straight across gaps (docs/explanation/model.md).
//            Integrals are exact but for rounding: sums of products, of which none cancel that the gain does not
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/timeline.hpp"
#include "exposure/compensated_sum.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

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

}  // namespace nutik

// The lightest or the darkest sample of each pixel, with kernels/combine.cl: what the kernel reads beside blocks, and
// how what it leaves becomes light.
//
//   in:      a plan that lightens or darkens, and the gains of its samples
//   out:     tables for the kernel, a slice at a time; of a band that it went over the picture
//   always:  the reference's to the last bit (render/combining_renderer.hpp)
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "opencl/developer.hpp"
#include "opencl/gain_columns.hpp"
#include "render/combining_renderer.hpp"

namespace nutik {

// A picture of a rectangle, and how many of its pixels saturate.
struct CombinedPicture {
  const OutputFormat& output;
  const Rectangle& rectangle;
  Picture& picture;
  Saturation& saturation;
};

class SampleCombiner {
 public:
  // All that is given must live as long.
  SampleCombiner(const RenderPlan& plan, std::vector<SampleGains> gains);

  // False: codes are compared as they come, for each function has one gain for all samples.
  [[nodiscard]] bool scales() const { return scales_; }
  // Whether products are right without double, too: none is subnormal.
  [[nodiscard]] bool has_normal_products() const;

  // What a device compares in: codes, doubles, or the bits of doubles as whole numbers.
  [[nodiscard]] Precision precision_on(const DeviceInfo& device) const {
    if (!scales_) return Precision::single_;
    return device.has_double ? Precision::double_ : Precision::fixed;
  }

  // Beside expose_options().
  [[nodiscard]] std::string options() const;
  [[nodiscard]] std::vector<TableSlice> slices(const DeviceInfo& device, std::uint64_t max_bytes) const;
  // Without weights and boundaries.
  [[nodiscard]] SliceTables tables(const TableSlice& slice, DeviceMemory& memory) const;
  // The light of each code; where nothing is scaled, one that is not read.
  [[nodiscard]] std::span<const double> light() const { return std::span(light_).first(scales_ ? light_.size() : 1); }

  // What the kernel left of a band becomes part of a picture.
  void develop(const ExposedBand& combined, cl::CommandQueue& queue, const CombinedPicture& to) const;

 private:
  [[nodiscard]] double light_of_code(std::uint32_t code, std::size_t function) const;
  template <typename Result, typename LightOf>
  [[nodiscard]] Picture light_of(const ExposedBand& combined, std::span<const Result> results, const Rectangle& part,
                                 LightOf light_of_result) const;
  template <typename Code>
  void develop_codes(const ExposedBand& combined, std::span<const std::uint8_t> results,
                     const CombinedPicture& to) const;
  template <typename Result, typename LightOf>
  void develop_results(const ExposedBand& combined, cl::CommandQueue& queue, const CombinedPicture& to,
                       LightOf light_of_result) const;

  const RenderPlan& plan_;
  std::vector<SampleGains> gains_;
  bool scales_;
  std::uint32_t levels_ = 1;   // of gains
  std::vector<double> light_;  // of each code
};

}  // namespace nutik

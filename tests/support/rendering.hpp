// What the tests of the OpenCL renderer share: kernels built once for all of them, and how far
// apart two pictures are.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/error_bound.hpp"
#include "render/render_plan.hpp"
#include "support/bounds.hpp"

namespace nutik::test {

// NUTIK_TEST_SHAPE=pixels,tiles,lanes,group,rows,copies cuts the work another way than suits the device
// (OpenClOptions): GPUs' way on a CPU, say. NUTIK_TEST_DEVICE makes the device another one (support/device_traits.cpp).
inline OpenClOptions renderer_options(std::optional<Precision> precision) {
  OpenClOptions options;
  if (const char* shape = std::getenv("NUTIK_TEST_SHAPE")) {
    std::uint32_t copies = 0;
    if (std::sscanf(shape, "%u,%u,%u,%u,%u,%u", &options.item_pixels, &options.item_tiles, &options.lanes,
                    &options.group_items, &options.rows_at_once, &copies) != 6) {
      throw UsageError(std::string("NUTIK_TEST_SHAPE is not pixels,tiles,lanes,group,rows,copies: ") + shape);
    }
    options.table_copies = copies;
  }
  options.precision = precision;
  options.tests_itself = false;  // these tests are stricter
  options.cache_folder = std::filesystem::temp_directory_path() / "nutik-test-kernels";
  return options;
}

// The first device's arithmetics.
[[nodiscard]] inline std::span<const Precision> first_precisions() {
  const std::vector<DeviceInfo> devices = list_devices();
  return precisions_of(devices.front());
}

[[nodiscard]] inline bool has(Precision precision) {
  return std::ranges::count(first_precisions(), precision) > 0;
}

// Double, or pairs of floats on a device without it: where a test is about something else than arithmetic.
[[nodiscard]] inline Precision precise() {
  return has(Precision::double_) ? Precision::double_ : Precision::compensated;
}

// Tests of an arithmetic, where the device has it.
class OfPrecision : public testing::TestWithParam<Precision> {
 protected:
  void SetUp() override {
    if (!has(GetParam())) GTEST_SKIP() << "the device has no " << to_text(GetParam());
  }
  // Members are made before a test is skipped.
  [[nodiscard]] static OpenClOptions options() {
    return renderer_options(has(GetParam()) ? GetParam() : Precision::single_);
  }
};

// A device of which no more is known than what it allocates at a time.
inline DeviceInfo device_allocating(std::uint64_t bytes) {
  DeviceInfo device;
  device.name = "a small device";
  device.largest_allocation_bytes = bytes;
  return device;
}

// A part of a picture, by itself.
inline std::vector<std::byte> part_of(const Picture& picture, const Rectangle& part) {
  const std::size_t pixel_bytes = picture.shape.channels * value_bytes(picture.type);
  std::vector<std::byte> bytes;
  for (std::size_t y = part.y; y < std::size_t{part.y} + part.height; ++y) {
    const auto row =
        std::span(picture.bytes).subspan((y * picture.shape.width + part.x) * pixel_bytes, part.width * pixel_bytes);
    bytes.insert(bytes.end(), row.begin(), row.end());
  }
  return bytes;
}

// S of a value's pixel.
inline double scale_of(const RenderPlan& plan, std::uint64_t value) {
  return plan.error_scale(value / plan.capture.shape.channels);
}

struct Difference {
  double worst = 0.0;  // in S; infinite where a value is not a number
  std::uint64_t value = 0;
};

// Between two pictures of light64.
inline Difference difference_of(const RenderPlan& plan, const Picture& a, const Picture& b) {
  Difference difference;
  for (std::uint64_t i = 0; i < a.shape.value_count(); ++i) {
    const double light = std::fabs(a.values<double>()[i] - b.values<double>()[i]);
    double units = light == 0.0 ? 0.0 : light / scale_of(plan, i);
    if (std::isnan(units)) units = INFINITY;
    if (units > difference.worst) difference = {units, i};
  }
  return difference;
}

// The same, in what error_bound() promises for each value's pixel: at most 1.
inline Difference share_of_bound(const RenderPlan& plan, const ErrorBound& bound, const Picture& a,
                                 const Picture& b) {
  Difference difference;
  const PixelErrors bounds(plan, bound);
  for (std::uint64_t i = 0; i < a.shape.value_count(); ++i) {
    const double light = std::fabs(a.values<double>()[i] - b.values<double>()[i]);
    double share = light == 0.0 ? 0.0 : light / bounds.of(i / plan.capture.shape.channels).light;
    if (std::isnan(share)) share = INFINITY;
    if (share > difference.worst) difference = {share, i};
  }
  return difference;
}

// The same of a precision, for pictures of light64.
inline Difference share_of_bound(const RenderPlan& plan, Precision precision, const Picture& a,
                                 const Picture& b) {
  return share_of_bound(plan, error_bound(plan, precision, {ValueType::light64, 0}), a, b);
}

}  // namespace nutik::test

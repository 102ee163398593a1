#include "exposure/delay_map.hpp"

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kFinestSteps = DelayMap::kMaxDelays - 1;

// step_of(pixel) is in [0, steps].
template <typename StepOf>
DelayMap made(const Shape& shape, const DelayRange& range, std::uint32_t steps, StepOf step_of) {
  DelayMap map{shape.width, shape.height, {}, {}};
  map.delay_of_pixel.resize(shape.pixel_count());
  std::vector<bool> occurs(std::size_t{steps} + 1);
  for (std::uint64_t pixel = 0; pixel < map.delay_of_pixel.size(); ++pixel) {
    const std::uint32_t step = step_of(pixel);
    map.delay_of_pixel[pixel] = static_cast<std::uint16_t>(step);
    occurs[step] = true;
  }
  std::vector<std::int64_t> delay_of_step(occurs.size());
  for (std::uint32_t step = 0; step <= steps; ++step) {
    delay_of_step[step] = rounded_between(range.from, range.to, step, std::max<std::int64_t>(steps, 1));
    if (occurs[step]) map.delays_ns.push_back(delay_of_step[step]);
  }
  std::ranges::sort(map.delays_ns);
  map.delays_ns.erase(std::unique(map.delays_ns.begin(), map.delays_ns.end()), map.delays_ns.end());
  std::vector<std::uint16_t> number_of_step(occurs.size());
  for (std::uint32_t step = 0; step <= steps; ++step) {
    const auto found = std::ranges::lower_bound(map.delays_ns, delay_of_step[step]);
    if (occurs[step]) number_of_step[step] = static_cast<std::uint16_t>(found - map.delays_ns.begin());
  }
  for (std::uint16_t& number : map.delay_of_pixel) number = number_of_step[number];
  return map;
}

void check_side(std::uint32_t length, const char* what) {
  if (length <= DelayMap::kMaxDelays) return;
  throw UsageError(
      format("the picture has {} {}, and at most {} can have a delay of their own; crop it, or take a map",
             length, what, DelayMap::kMaxDelays));
}

// What is no light between black and white has no place in the range.
std::uint32_t step_of_light(double light, std::uint64_t pixel, std::uint32_t width, const std::string& name) {
  if (!(light >= 0.0 && light <= 1.0)) {
    throw InputError(
        format("{}: pixel {},{} is {}; in a map of delays in floating point 0 is the start of the range and "
               "1 its end",
               name, pixel % width, pixel / width, light));
  }
  return static_cast<std::uint32_t>(std::lround(light * kFinestSteps));
}

template <typename Value>
DelayMap by_light(const Picture& picture, const DelayRange& range, const std::string& name) {
  const auto values = picture.values<Value>();
  return made(picture.shape, range, kFinestSteps, [&](std::uint64_t pixel) {
    return step_of_light(values[pixel], pixel, picture.shape.width, name);
  });
}

template <typename Value>
DelayMap by_code(const Picture& picture, const DelayRange& range) {
  const auto values = picture.values<Value>();
  return made(picture.shape, range, picture.white_code, [&](std::uint64_t pixel) {
    return std::min<std::uint32_t>(values[pixel], picture.white_code);
  });
}

}  // namespace

DelayMap DelayMap::by_rows(const Shape& shape, const DelayRange& range) {
  check_side(shape.height, "rows");
  return made(shape, range, shape.height - 1,
              [&](std::uint64_t pixel) { return static_cast<std::uint32_t>(pixel / shape.width); });
}

DelayMap DelayMap::by_columns(const Shape& shape, const DelayRange& range) {
  check_side(shape.width, "columns");
  return made(shape, range, shape.width - 1,
              [&](std::uint64_t pixel) { return static_cast<std::uint32_t>(pixel % shape.width); });
}

DelayMap DelayMap::by_radius(const Shape& shape, const DelayRange& range) {
  // Twice the distances from the centre: whole numbers.
  const double half_width = shape.width - 1.0, half_height = shape.height - 1.0;
  const double corner = std::max(1.0, std::hypot(half_width, half_height));
  return made(shape, range, kRadialSteps, [&](std::uint64_t pixel) {
    const double x = 2.0 * static_cast<double>(pixel % shape.width) - half_width;
    const double y = 2.0 * static_cast<double>(pixel / shape.width) - half_height;
    return static_cast<std::uint32_t>(std::lround(kRadialSteps * std::min(1.0, std::hypot(x, y) / corner)));
  });
}

DelayMap DelayMap::by_picture(const Picture& picture, const DelayRange& range, const std::string& name) {
  if (picture.shape.channels != 1) {
    throw InputError(format(
        "{} is a colour picture; a map of delays has one value for each pixel: save it as grey", name));
  }
  switch (picture.type) {
    case ValueType::code8: return by_code<std::uint8_t>(picture, range);
    case ValueType::code16: return by_code<std::uint16_t>(picture, range);
    case ValueType::light32: return by_light<float>(picture, range, name);
    case ValueType::light64: break;
  }
  return by_light<double>(picture, range, name);
}

}  // namespace nutik

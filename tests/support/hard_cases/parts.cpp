#include "support/hard_cases/parts.hpp"

#include <algorithm>
#include <iterator>

namespace nutik::test {

StreamingCapture HardCase::open(std::uint32_t samples, TilePolicy tiles) const {
  const SampleRange needed = needed_samples(timeline, functions, mask, {});
  const auto next = [draw = sample, first = needed.first / samples * samples, count = timeline.sample_count(),
                     k = std::uint64_t{0}, raster = std::vector<std::byte>(capture.sample_bytes()),
                     span = std::span<const std::byte>()](
                        std::uint64_t) mutable -> std::span<const std::span<const std::byte>> {
    if (k == count) return {};
    if (k >= first) raster = draw(k);  // what lies before is not kept
    ++k;
    span = raster;
    return {&span, 1};
  };
  return {capture, timeline, needed, samples, tiles, next};
}

std::span<const NamedHardCase> hard_cases() {
  static const std::vector<NamedHardCase> all = [] {
    std::vector<NamedHardCase> cases;
    for (const auto& part : {hard_times(), hard_gains(), hard_captures()}) {
      std::ranges::copy(part, std::back_inserter(cases));
    }
    return cases;
  }();
  return all;
}

CaptureFormat format_of(Shape shape, Transfer transfer, std::uint32_t white_code) {
  return {.shape = shape, .code_bytes = white_code > 255 ? 2u : 1u, .white_code = white_code, .transfer = transfer};
}

namespace {

// 64 bits without pattern for each number: SplitMix64's output function.
std::uint64_t scramble(std::uint64_t number) {
  std::uint64_t bits = (number + 1) * 0x9E37'79B9'7F4A'7C15;
  bits = (bits ^ (bits >> 30)) * 0xBF58'476D'1CE4'E5B9;
  bits = (bits ^ (bits >> 27)) * 0x94D0'49BB'1331'11EB;
  return bits ^ (bits >> 31);
}

}  // namespace

DrawSample drawn_by(const CaptureFormat& capture,
                    std::function<std::uint64_t(std::uint64_t i, std::uint64_t k)> code_of) {
  return [capture, code_of = std::move(code_of)](std::uint64_t k) {
    std::vector<std::byte> raster(capture.sample_bytes());
    for (std::uint64_t i = 0; i < capture.shape.value_count(); ++i)
      set_code(capture, raster, i, static_cast<std::uint32_t>(code_of(i, k)));
    return raster;
  };
}

DrawSample noise(const CaptureFormat& capture) {
  return drawn_by(capture, [values = capture.shape.value_count(), codes = capture.white_code + 1](
                               std::uint64_t i, std::uint64_t k) { return scramble(k * values + i) % codes; });
}

DrawSample still(const CaptureFormat& capture) {
  return drawn_by(capture, [codes = capture.white_code + 1](std::uint64_t i, std::uint64_t) { return i * 37 % codes; });
}

HardCase taking_turns(const CaptureFormat& capture, Timeline timeline, DrawSample sample,
                      std::vector<GainFunction> functions) {
  FunctionSet set;
  for (GainFunction& function : functions) set.emplace(static_cast<std::uint8_t>(set.size()), std::move(function));
  Mask mask = Mask::uniform(capture.shape.width, capture.shape.height, 0);
  for (std::size_t i = 0; i < mask.tags.size(); ++i) mask.tags[i] = static_cast<std::uint8_t>(i % set.size());
  return {capture, std::move(timeline), std::move(sample), std::move(set), std::move(mask)};
}

HardCase noisy_case(const CaptureFormat& capture, Timeline timeline, std::vector<GainFunction> functions) {
  return taking_turns(capture, std::move(timeline), noise(capture), std::move(functions));
}

GainFunction pulse(std::int64_t time_ns, double gain) {
  return GainFunction({{time_ns - 1, 0.0}, {time_ns, gain}, {time_ns + 1, 0.0}});
}

}  // namespace nutik::test

#include "features/plate/plate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "align/alignment.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/masks/mask_making.hpp"
#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "noise/noise_estimator.hpp"
#include "render/code_scale.hpp"
#include "scene/clean_plate.hpp"
#include "scene/shots.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kRoughSamples = 64;  // of a plate that is only compared with

// Samples that the noise is measured on: several windows of the estimator, in the middle of the capture.
constexpr std::uint64_t kMeasuredSamples = 4 * kWindowSamples;
constexpr std::uint64_t kMeasuredPixels = 32 * 1024;  // or fewer, spread over the picture

// The noise that a capture holds; none where nothing tells it: all of it moves, or is black.
std::optional<CameraNoise> noise_of(CaptureSource& capture, const ReportedProgress& progress) {
  const CaptureFormat& format = capture.format();
  const std::uint64_t count = capture.timeline().sample_count();
  std::uint64_t sample = (count - std::min(count, kMeasuredSamples)) / 2;
  const Shape& shape = format.shape;
  std::uint32_t step = 1;
  while ((shape.width / step + 1) * std::uint64_t{shape.height / step + 1} > kMeasuredPixels) ++step;
  ThinRaster thin(format, step);
  NoiseEstimator estimator(thin.format());
  BlockCursor blocks(capture);
  std::optional<BlockView> block;
  std::optional<SampleCursor> samples;
  std::uint64_t next_block = 0;
  try {
    estimator.add_clip(
        "the capture",
        [&](std::span<std::byte> raster) {
          if (sample == count) return false;
          if (progress) progress(0, 0);
          while (!block || block->extent().range().last <= sample) {
            if (capture.block_extent(next_block++).range().last <= sample) continue;
            samples.reset();
            block.emplace(blocks.at(next_block - 1));
            samples.emplace(shape, *block);
          }
          thin.take(*samples,
                    samples->go_to(static_cast<std::uint32_t>(sample++ - block->extent().first_sample)));
          std::ranges::copy(thin.raster(), raster.begin());
          return true;
        },
        kMeasuredSamples);
    return estimator.estimate().noise;
  } catch (const UnknownNoise&) {
    return std::nullopt;
  }
}

}  // namespace

MemoryNeeds plate_making_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = plate_needs(capture);
  needs.add("noise", kWindowSamples * 2 * capture.shape.channels *
                         std::min(capture.shape.pixel_count(), kMeasuredPixels));
  return needs;
}

MadePlate make_plate(CaptureSource& capture, const std::string& capture_name, const PlateRequest& request,
                     const OutputFormat& output, const MemoryBudget& memory,
                     const ReportedProgress& progress) {
  const CaptureFormat& format = capture.format();
  if (capture.timeline().sample_count() < 2) {
    throw InputError(nutik::format("{}: a single sample does not tell what moves", capture_name));
  }
  if (request.by_codes.value_or(0) >= format.white_code) {
    throw UsageError(nutik::format("no codes of {} differ by more than {}, for white is {}; state fewer codes",
                                   capture_name, *request.by_codes, format.white_code));
  }
  std::uint64_t steps = 0;  // few plates need all of them: those that were not taken are done at the end
  const auto report = [&](std::uint64_t done, std::uint64_t total) {
    steps = total;
    if (progress) progress(done, total);
  };
  std::optional<CameraNoise> noise;
  if (!request.by_codes) noise = noise_of(capture, report);
  const auto least = static_cast<std::uint32_t>(std::ceil(CodeBand::kMinShare * format.white_code));
  const CodeBand band = noise ? CodeBand::of_noise(format, *noise)
                              : CodeBand::of_codes(format, request.by_codes.value_or(least));
  Plate plate = make_plate(capture, band, memory.bytes, request.max_samples, report);
  report(steps, steps);
  MadePlate made{{}, std::move(plate.uncertain), noise || request.by_codes, {}};
  made.picture = stored(std::move(plate.light), format, output, made.saturation, true);
  state_values(made.picture, format, output);
  return made;
}

MadePlate make_rough_plate(CaptureSource& capture, const std::string& capture_name,
                           const MemoryBudget& memory, const ReportedProgress& progress) {
  OutputFormat codes;
  codes.type = code_type(capture.format());
  codes.white_code = capture.format().white_code;
  return make_plate(capture, capture_name, {{}, kRoughSamples}, codes, memory, progress);
}

NeedsOfFormat mask_needs_of(const MaskRequest& request) {
  const bool needs_plate = std::ranges::any_of(request.steps, &MaskStep::needs_plate);
  const bool reads_pictures = std::ranges::any_of(request.steps, [](const MaskStep& step) {
    return step.compares() && !step.pictures().empty();
  });
  return [needs_plate, reads_pictures, looks_at_camera = request.tells_by_rest()](const CaptureFormat& capture) {
    MemoryNeeds needs = mask_making_needs(capture);
    if (reads_pictures) needs.add("light of a picture", capture.shape.value_count() * sizeof(double));
    if (looks_at_camera) needs.add(camera_check_needs(capture));
    if (needs_plate) needs.add(plate_making_needs(capture));
    return needs;
  };
}

}  // namespace nutik

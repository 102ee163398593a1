// Scenes that no cut parts: one fades into another, or is wiped away.
#include "features/study/study_shot.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include "align/registrar.hpp"
#include "media/clip.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kLooks = 48;
constexpr std::uint32_t kMaxSide = 240;  // of what is looked at
// Between two scenes that were found lies the middle of a dissolve, where neither has most of the texture. Before and
// behind it the dissolve goes on, for one in so many of the middle's pictures at most. Measured: for a fifth of all.
constexpr std::uint64_t kEndOfMiddle = 4;

using Raster = std::vector<std::byte>;

// For each look the one before it, or itself, that it and all between the two are registered to. The first picture that
// is not begins what follows. So a picture of two scenes has few behind it, for soon most of what it shows is gone, and
// the first that shows one alone has all the others of that. The rasters' order is time's or its opposite.
std::vector<std::size_t> beginnings_of(const CaptureFormat& format, std::span<const Raster* const> rasters) {
  std::vector<std::size_t> beginnings;
  std::unique_ptr<Registrar> registrar;
  Warp guess;
  for (std::size_t i = 0; i < rasters.size(); ++i) {
    if (registrar) {
      const Registered found = registrar->find(*rasters[i], CameraMotion::homography, guess);
      if (is_sure(found)) {
        guess = found.warp;
        beginnings.push_back(beginnings.back());
        continue;
      }
    }
    beginnings.push_back(i);
    guess = Warp();
    try {
      registrar = open_registrar(format, *rasters[i]);
    } catch (const TooLittleTexture&) {
      registrar.reset();
    }
  }
  return beginnings;
}

}  // namespace

std::vector<SampleRange> scenes_of(const SourceRequest& source, SampleRange shot) {
  ClipOptions part = source.clip;
  part.from = {static_cast<std::int64_t>(shot.first), true};
  part.to = {static_cast<std::int64_t>(shot.last), true};
  const std::unique_ptr<Clip> clip = open_clip(source.path, part);
  const CaptureFormat& format = clip->info().format;
  const std::uint32_t step = (std::max(format.shape.width, format.shape.height) - 1) / kMaxSide + 1;
  CaptureFormat thin = format;
  thin.shape.width = (format.shape.width - 1) / step + 1;
  thin.shape.height = (format.shape.height - 1) / step + 1;
  const std::uint64_t stride = (shot.size() - 1) / kLooks + 1;
  const std::size_t pixel_bytes = format.sample_bytes() / format.shape.pixel_count();
  std::vector<Raster> rasters;
  Raster raster(format.sample_bytes());
  for (std::uint64_t picture = 0; clip->read(raster); ++picture) {
    if (picture % stride != 0) continue;
    Raster& look = rasters.emplace_back();
    look.reserve(thin.sample_bytes());
    for (std::uint32_t y = 0; y < format.shape.height; y += step) {
      for (std::uint32_t x = 0; x < format.shape.width; x += step) {
        const auto pixel = raster.begin() + static_cast<std::ptrdiff_t>(
                                                (std::uint64_t{y} * format.shape.width + x) * pixel_bytes);
        look.insert(look.end(), pixel, pixel + static_cast<std::ptrdiff_t>(pixel_bytes));
      }
    }
  }
  const std::size_t count = rasters.size();
  std::array<std::vector<const Raster*>, 2> orders;
  for (std::size_t i = 0; i < count; ++i) {
    orders[0].push_back(&rasters[i]);
    orders[1].push_back(&rasters[count - 1 - i]);
  }
  std::array<std::vector<std::size_t>, 2> beginnings;
  parallel_for(2, [&](std::uint64_t i) { beginnings[i] = beginnings_of(thin, orders[i]); });
  std::vector<SampleRange> runs, scenes;
  for (std::size_t i = 0; i < count; ++i) {
    runs.push_back({beginnings[0][i], count - beginnings[1][count - 1 - i]});
  }
  std::ranges::stable_sort(runs, std::ranges::greater(), &SampleRange::size);
  if (count == 0 || runs.front().size() == count) return {};
  for (const SampleRange& run : runs) {
    const SampleRange scene{shot.first + run.first * stride,
                            run.last == count ? shot.last : shot.first + (run.last - 1) * stride + 1};
    const auto meets = [&](const SampleRange& other) { return scene.first < other.last && other.first < scene.last; };
    if (scene.size() >= kMinSamples && std::ranges::none_of(scenes, meets)) scenes.push_back(scene);
  }
  // What lies between two scenes is a dissolve's middle: its ends are within them.
  const std::vector<SampleRange> whole = scenes;
  for (SampleRange& scene : scenes) {
    std::uint64_t before = shot.first, behind = shot.last;
    for (const SampleRange& other : whole) {
      if (other.last <= scene.first) before = std::max(before, other.last);
      if (other.first >= scene.last) behind = std::min(behind, other.first);
    }
    const auto end_within = [&](std::uint64_t gap) { return std::max(gap / kEndOfMiddle, stride); };
    const std::uint64_t first = scene.first + (scene.first == shot.first ? 0 : end_within(scene.first - before));
    const std::uint64_t last = scene.last - (scene.last == shot.last ? 0 : end_within(behind - scene.last));
    scene = first < last ? SampleRange{first, last} : SampleRange{};
  }
  std::ranges::stable_sort(scenes, std::ranges::greater(), &SampleRange::size);
  if (scenes.empty()) return {};
  const std::uint64_t least = std::max({kMinSamples, scenes.front().size() / 2, shot.size() / kMinOfSamples});
  std::erase_if(scenes, [&](const SampleRange& scene) { return scene.size() < least; });
  return scenes;
}

}  // namespace nutik

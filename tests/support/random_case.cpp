#include "support/random_case.hpp"

#include <cstring>
#include <set>

#include "capture/format.hpp"

namespace nutik::test {

std::uint32_t code_at(const CaptureFormat& capture, const std::vector<std::byte>& raster,
                      std::uint64_t value) {
  std::uint16_t code = 0;
  std::memcpy(&code, raster.data() + value * capture.code_bytes, capture.code_bytes);
  return code;
}

void set_code(const CaptureFormat& capture, std::vector<std::byte>& raster, std::uint64_t value,
              std::uint32_t code) {
  const auto narrow = static_cast<std::uint16_t>(code);
  std::memcpy(raster.data() + value * capture.code_bytes, &narrow, capture.code_bytes);
}

Rasters random_rasters(Random& random, const CaptureFormat& capture, std::uint64_t sample_count) {
  const Shape& shape = capture.shape;
  std::vector<std::byte> raster(capture.sample_bytes());
  const auto redraw = [&](std::uint64_t pixel) {
    for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
      const auto code = static_cast<std::uint32_t>(random.whole(0, capture.white_code));
      set_code(capture, raster, pixel * shape.channels + channel, code);
    }
  };
  for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) redraw(pixel);
  // How often a pixel changes, by stripes of the picture, so that all kinds of tiles occur.
  const std::vector<double> shares{0.0, 0.02, 0.2, 1.0};
  std::vector<double> share_of_column(shape.width);
  for (std::uint32_t x = 0; x < shape.width; ++x) {
    share_of_column[x] = x % 8 == 0 || x == 0 ? random.pick(shares) : share_of_column[x - 1];
  }
  Rasters rasters;
  for (std::uint64_t sample = 0; sample < sample_count; ++sample) {
    if (sample > 0) {
      for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
        if (random.chance(share_of_column[pixel % shape.width])) redraw(pixel);
      }
    }
    rasters.push_back(raster);
  }
  return rasters;
}

CaptureFormat random_format(Random& random) {
  CaptureFormat capture;
  const std::vector<std::uint32_t> sides{1, 2, 3, 7, 8, 9, 15, 16, 17, 31, 33};
  capture.shape = {random.pick(sides), random.pick(sides), random.chance(0.5) ? 1u : 3u};
  capture.code_bytes = random.chance(0.7) ? 1 : 2;
  capture.white_code =
      capture.code_bytes == 1 ? 255 : random.pick(std::vector<std::uint32_t>{1023, 4095, 65'535});
  capture.transfer = random.pick(
      std::vector<Transfer>{Transfer::srgb(), Transfer::linear(), Transfer::bt709(), Transfer::gamma(2.2)});
  if (random.chance(0.3)) capture.noise.tolerance = static_cast<std::uint32_t>(random.whole(1, 20));
  return capture;
}

Timeline random_timeline(Random& random, std::uint64_t sample_count) {
  const Rational angle = random.pick(std::vector<Rational>{{360, 1}, {180, 1}, {1728, 10}, {1, 1}});
  if (sample_count == 1 || random.chance(0.6)) {
    const Rational rate =
        random.pick(std::vector<Rational>{{30, 1}, {30000, 1001}, {960, 1}, {1, 3}, {1'000'000, 1}});
    return Timeline::constant(rate, angle, sample_count);
  }
  if (random.chance(0.5)) {
    std::vector<std::int64_t> starts{random.whole(-1000, 1000)};
    while (starts.size() < sample_count) starts.push_back(starts.back() + random.whole(2, 50'000'000));
    return Timeline::irregular(starts, angle);
  }
  std::vector<Exposure> exposures;
  std::int64_t time = random.whole(-1000, 1000);
  while (exposures.size() < sample_count) {
    const std::int64_t length = random.whole(1, 20'000'000);
    exposures.push_back({time, time + length});
    time += length + (random.chance(0.3) ? 0 : random.whole(1, 20'000'000));
  }
  return Timeline::explicit_exposures(exposures);
}

GainFunction random_function(Random& random, const Timeline& timeline) {
  const std::int64_t duration = timeline.duration_ns();
  const auto some_sample = [&] {
    return static_cast<std::uint64_t>(
        random.whole(0, static_cast<std::int64_t>(timeline.sample_count()) - 1));
  };
  std::set<std::int64_t> times;
  const std::int64_t count = random.whole(1, 12);
  while (static_cast<std::int64_t>(times.size()) < count) {
    switch (random.whole(0, 4)) {
      case 0: times.insert(timeline.start_ns(some_sample()) + random.whole(-1, 1)); break;
      case 1: times.insert(timeline.end_ns(some_sample()) + random.whole(-1, 1)); break;
      case 2: times.insert(random.whole(-duration / 4, duration + duration / 4)); break;
      case 3: times.insert((times.empty() ? 0 : *times.rbegin()) + 1); break;
      default: times.insert(random.whole(0, duration)); break;
    }
  }
  std::vector<ControlPoint> points;
  for (const std::int64_t time : times) {
    points.push_back({time, random.chance(0.3) ? 0.0 : random.real(-2.0, 3.0)});
  }
  if (random.chance(0.6)) points.front().gain = 0.0;
  if (random.chance(0.6)) points.back().gain = 0.0;
  return GainFunction(std::move(points));
}

RandomCase::RandomCase(std::uint64_t case_seed) : RandomCase(Random(case_seed), case_seed, nullptr) {}

RandomCase::RandomCase(std::uint64_t case_seed, const CodeFormat& codes)
    : RandomCase(Random(case_seed), case_seed, &codes) {}

namespace {

CaptureFormat random_format(Random& random, const CodeFormat* codes) {
  CaptureFormat capture = random_format(random);
  if (codes != nullptr) {
    capture.shape.channels = codes->channels;
    capture.code_bytes = codes->code_bytes;
    capture.white_code = codes->white_code;
    capture.transfer = codes->transfer;
  }
  return capture;
}

std::uint64_t random_sample_count(Random& random) {
  return static_cast<std::uint64_t>(
      random.pick(std::vector<std::int64_t>{1, 2, 3, 63, 64, 65, random.whole(4, 150)}));
}

}  // namespace

RandomCase::RandomCase(Random random, std::uint64_t case_seed, const CodeFormat* codes)
    : seed(case_seed),
      capture(random_format(random, codes)),
      timeline(random_timeline(random, random_sample_count(random))),
      rasters(random_rasters(random, capture, timeline.sample_count())),
      block_samples(random.pick(std::vector<std::uint32_t>{1, 2, 5, 64, 64, 64, 300})),
      policy(random.pick(std::vector<TilePolicy>{TilePolicy::automatic, TilePolicy::automatic,
                                                 TilePolicy::dense, TilePolicy::rows, TilePolicy::records})),
      mask(Mask::uniform(capture.shape.width, capture.shape.height, 0)) {
  std::vector<std::uint8_t> tags{0};
  const std::int64_t tag_count = random.pick(std::vector<std::int64_t>{1, 2, 3, 20});
  for (std::int64_t i = 1; i < tag_count; ++i) {
    tags.push_back(static_cast<std::uint8_t>(random.whole(0, 255)));
  }
  for (const std::uint8_t tag : tags) functions.emplace(tag, random_function(random, timeline));
  // Regions: nothing, halves, or pixel by pixel.
  const std::int64_t regions = random.whole(0, 2);
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    if (regions == 1) mask.tags[pixel] = pixel % mask.width < mask.width / 2 ? tags.front() : tags.back();
    if (regions == 2) mask.tags[pixel] = random.pick(tags);
  }
}

std::string RandomCase::text() const {
  return format(
      "seed {}: {} x {} x {}, {} byte codes, white {}, {}, tolerance {}, {} samples in blocks "
      "of {}, tiles {}, {} functions",
      seed, capture.shape.width, capture.shape.height, capture.shape.channels, capture.code_bytes,
      capture.white_code, capture.transfer.text(), capture.noise.tolerance, timeline.sample_count(),
      block_samples, to_text(policy), functions.size());
}

}  // namespace nutik::test

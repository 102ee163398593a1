// One session, asked by four threads at once for different pictures, a third of which nobody wants any more: what comes
// is what one thread would have got.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "session/session.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

constexpr std::size_t kSessionThreads = 4;
constexpr std::size_t kSessionRequests = 36;

bool is_cancelled(std::size_t k) { return k % 3 == 2; }

struct AskedOfThread {
  ExposureRequest exposure;
  OutputFormat output;
  std::optional<Rectangle> rectangle;
};

// No two are alike: another function, brightness, format or part of the picture.
std::vector<AskedOfThread> requests_of(const RandomCase& random) {
  const std::array outputs{OutputFormat{ValueType::code8, 255},
                           OutputFormat{ValueType::code16, 65'535, NegativeLight::offset},
                           OutputFormat{ValueType::light32, 0}};
  const Shape& shape = random.capture.shape;
  const std::int64_t duration_ns = random.timeline.duration_ns();
  std::vector<AskedOfThread> requests;
  for (std::size_t k = 0; k < kSessionRequests; ++k) {
    AskedOfThread asked{{}, outputs[k % outputs.size()], std::nullopt};
    const auto step = static_cast<std::int64_t>(k);
    if (k % 2 == 0) {
      asked.exposure.gains =
          PlainInterval{StatedTime::of_nanoseconds(duration_ns / (2 + step) + 1), Shutter()};
      asked.exposure.start = StatedTime::of_nanoseconds(duration_ns / 40 * (step % 10));
    } else {
      asked.exposure.gains = Shared(random.functions);
      asked.exposure.mask = Shared(MaskWithRegions(random.mask));
    }
    asked.exposure.gain = 1.0 + 0.1 * static_cast<double>(k);
    if (k % 5 == 4) asked.rectangle = Rectangle{0, 0, (shape.width + 1) / 2, (shape.height + 1) / 2};
    requests.push_back(std::move(asked));
  }
  return requests;
}

// Once one thread gets a picture, or none because it is cancelled a little later than that.
std::optional<ExposedPicture> ask(Session& session, const AskedOfThread& asked, std::stop_token stop) {
  RenderControl control;
  control.stop = std::move(stop);
  control.rectangle = asked.rectangle;
  try {
    return session.render(asked.exposure, asked.output, control);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

void expect_same(const ExposedPicture& one, const ExposedPicture& other, std::size_t k) {
  EXPECT_EQ(one.picture.bytes, other.picture.bytes) << "request " << k;
  EXPECT_EQ(one.saturation, other.saturation) << "request " << k;
  EXPECT_EQ(one.precision, other.precision) << "request " << k;
  EXPECT_EQ(one.warnings, other.warnings) << "request " << k;
  EXPECT_EQ(one.figures.live_samples, other.figures.live_samples) << "request " << k;
}

void expect_threads_get_the_same(const RandomCase& random, const tik::Codec& codec,
                                 const ComputingRequest& computing) {
  const Scratch scratch;
  SourceRequest source;
  source.path = write_tik(random, codec, scratch);
  const std::vector<AskedOfThread> requests = requests_of(random);

  std::vector<ExposedPicture> expected;
  Session alone(source, computing);
  for (const AskedOfThread& asked : requests) expected.push_back(ask(alone, asked, {}).value());

  Session shared(source, computing);
  std::vector<std::optional<ExposedPicture>> got(kSessionRequests);
  std::atomic<std::size_t> next = 0;
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < kSessionThreads; ++t) {
      threads.emplace_back([&] {
        for (std::size_t k = next++; k < kSessionRequests; k = next++) {
          std::stop_source stop;
          // Before it begins, or while it is on its way.
          std::jthread impatient([&, k] {
            if (!is_cancelled(k)) return;
            std::this_thread::sleep_for(std::chrono::microseconds(100 * (k % 12)));
            stop.request_stop();
          });
          if (is_cancelled(k) && k % 2 == 0) impatient.join();
          got[k] = ask(shared, requests[k], stop.get_token());
        }
      });
    }
  }
  std::size_t cancelled = 0;
  for (std::size_t k = 0; k < kSessionRequests; ++k) {
    if (got[k]) {
      expect_same(*got[k], expected[k], k);
    } else {
      EXPECT_TRUE(is_cancelled(k)) << "request " << k;
      ++cancelled;
    }
  }
  EXPECT_GE(cancelled, kSessionRequests / 6) << "those that were cancelled before they began";
}

ComputingRequest computing(RendererKind kind) {
  ComputingRequest request;
  request.renderer = kind;
  request.cache_folder = std::filesystem::temp_directory_path() / "nutik-test-kernels";
  return request;
}

TEST(SessionThreads, GetWhatOneThreadGets) {
  expect_threads_get_the_same(RandomCase(31), {tik::CodecId::zstd, 0}, computing(RendererKind::opencl));
}

TEST(SessionThreads, GetWhatOneThreadGetsOfColourThatIsNotPacked) {
  expect_threads_get_the_same(RandomCase(32, {3, 2, 4095, Transfer::bt709()}), {tik::CodecId::none, 0},
                              computing(RendererKind::opencl));
}

// Whose sums of blocks and bundles are kept, and used by whoever comes next.
TEST(SessionThreads, GetWhatOneThreadGetsOfSteadyGains) {
  std::uint64_t seed = 40;
  while (RandomCase(seed, {1, 1, 255, Transfer::srgb()}).timeline.sample_count() < 8 * 16) ++seed;
  RandomCase random(seed, {1, 1, 255, Transfer::srgb()});
  random.block_samples = 16;
  for (auto& [tag, function] : random.functions) function = GainFunction({{0, 0.5 + 0.1 * tag}});
  std::ranges::fill(random.mask.tags, random.mask.tags.front());
  expect_threads_get_the_same(random, {tik::CodecId::zstd, 0}, computing(RendererKind::opencl));
}

TEST(SessionThreads, GetWhatOneThreadGetsFromTheReference) {
  expect_threads_get_the_same(RandomCase(33), {tik::CodecId::lz4, 0}, computing(RendererKind::reference));
}

}  // namespace
}  // namespace nutik::test

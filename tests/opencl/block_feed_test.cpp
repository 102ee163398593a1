// How blocks get to the device: in chunks, ahead of the kernel, and once only where their capture is resident.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "capture/error.hpp"
#include "opencl/opencl_renderer.hpp"
#include "support/random_case.hpp"
#include "support/raster_stream.hpp"
#include "support/rendering.hpp"
#include "support/watched_capture.hpp"

namespace nutik::test {
extern std::function<void()> before_waiting;  // support/device_traits.cpp
namespace {

// A capture that counts how often its blocks are read, and may have a damaged one.
class CountingCapture final : public test::WatchedCapture {
 public:
  explicit CountingCapture(MemoryCapture& capture)
      : WatchedCapture(capture, [this](std::uint64_t block) {
          if (block == damaged) throw InputError("damaged");
          ++reads;
        }) {}
  std::atomic<std::uint64_t> reads = 0;
  std::uint64_t damaged = ~std::uint64_t{0};
};

// A capture of 90 samples in blocks of 4, and functions that need different parts of it.
struct Scene {
  Scene() {
    Random random(77);
    format.shape = {21, 13, 3};
    timeline = Timeline::constant({100, 1}, Timeline::kFullShutter, 90);
    capture.emplace(format, timeline, random_rasters(random, format, 90), 4);
  }
  // From sample `first` up to `last`.
  [[nodiscard]] RenderPlan plan(std::int64_t first, std::int64_t last) {
    FunctionSet functions;
    functions.emplace(0, GainFunction::boxcar(first * 10'000'000, last * 10'000'000));
    return make_plan(*capture, functions, Mask::uniform(21, 13, 0), {});
  }

  CaptureFormat format;
  Timeline timeline = Timeline::constant({1, 1}, Timeline::kFullShutter, 1);
  std::optional<MemoryCapture> capture;
};

std::vector<std::byte> render(OpenClRenderer& renderer, const RenderPlan& plan, CaptureSource& source) {
  return renderer.render(plan, source, kLight).picture.bytes;
}

TEST(BlockFeed, ReadsBlocksOfAResidentCaptureOnce) {
  Scene scene;
  CountingCapture counted(*scene.capture);
  OpenClRenderer plain(renderer_options(precise()));
  OpenClRenderer holding(renderer_options(precise()));
  holding.keep_resident(&counted);
  const auto expect_same = [&](std::int64_t first, std::int64_t last, std::uint64_t reads) {
    const RenderPlan plan = scene.plan(first, last);
    const std::uint64_t before = counted.reads;
    EXPECT_EQ(render(holding, plan, counted), render(plain, plan, *scene.capture)) << first << " … " << last;
    EXPECT_EQ(counted.reads - before, reads) << first << " … " << last;
  };
  expect_same(40, 60, 5);  // blocks 10 … 14
  expect_same(40, 60, 0);
  expect_same(44, 56, 0);
  expect_same(20, 72, 13 - 5);  // 5 … 17
  expect_same(0, 90, 23 - 13);
  expect_same(0, 90, 0);
  holding.keep_resident(&counted);
  expect_same(0, 90, 23);
  holding.keep_resident(nullptr);
  expect_same(0, 90, 23);
  expect_same(0, 90, 23);
}

TEST(BlockFeed, KeepsNoMoreThanItsMemory) {
  Scene scene;
  CountingCapture counted(*scene.capture);
  const RenderPlan plan = scene.plan(0, 90);
  OpenClRenderer plain(renderer_options(precise()));
  const std::vector<std::byte> expected = render(plain, plan, *scene.capture);
  std::size_t block_bytes = 0;
  for (std::uint64_t block = 0; block < counted.block_count(); ++block) {
    block_bytes = std::max(block_bytes, scene.capture->view(block).payload().size());
  }
  for (const std::uint64_t resident_blocks : {0u, 1u, 5u, 22u}) {
    OpenClOptions options = renderer_options(precise());
    options.chunk_bytes = 1;  // a block each
    options.memory_bytes = std::max<std::uint64_t>(2 * resident_blocks * (block_bytes + 64), 1);
    OpenClRenderer renderer(options);
    renderer.keep_resident(&counted);
    const Rendered rendered = renderer.render(plan, counted, kLight);
    EXPECT_EQ(rendered.picture.bytes, expected);
    EXPECT_EQ(rendered.statistics.launches, 23u);
    const std::uint64_t before = counted.reads;
    EXPECT_EQ(render(renderer, plan, counted), expected);
    EXPECT_LE(counted.reads - before, 23 - resident_blocks);
    EXPECT_GT(counted.reads, before);  // all of them are more than it may hold
  }
}

// What an exposure does not need goes for what it needs, the blocks that were needed last after the others.
TEST(BlockFeed, KeepsWhatWasNeededLast) {
  Scene scene;
  CountingCapture counted(*scene.capture);
  std::size_t block_bytes = 0;
  for (std::uint64_t block = 0; block < counted.block_count(); ++block) {
    block_bytes = std::max(block_bytes, scene.capture->view(block).payload().size());
  }
  OpenClOptions options = renderer_options(precise());
  options.chunk_bytes = 1;  // a block each
  options.memory_bytes = 2 * 6 * (align_up(block_bytes, 4096));
  OpenClRenderer renderer(options), plain(renderer_options(precise()));
  renderer.keep_resident(&counted);
  const auto reads = [&](std::int64_t first, std::int64_t last) {
    const RenderPlan plan = scene.plan(first, last);
    const std::uint64_t before = counted.reads;
    EXPECT_EQ(render(renderer, plan, counted), render(plain, plan, *scene.capture)) << first << " … " << last;
    return counted.reads - before;
  };
  EXPECT_EQ(reads(0, 12), 3u);   // blocks 0 … 2
  EXPECT_EQ(reads(20, 32), 3u);  // 5 … 7: there is room for six
  EXPECT_EQ(reads(0, 12), 0u);
  EXPECT_EQ(reads(40, 52), 3u);  // 10 … 12, for 5 … 7
  EXPECT_EQ(reads(0, 12), 0u);
  EXPECT_EQ(reads(40, 52), 0u);
  EXPECT_EQ(reads(20, 32), 3u);
}

TEST(BlockFeed, ReadsInChunksOfAnySize) {
  Scene scene;
  const RenderPlan plan = scene.plan(3, 88);
  OpenClRenderer plain(renderer_options(precise()));
  const std::vector<std::byte> expected = render(plain, plan, *scene.capture);
  std::uint64_t launches = plan.blocks.size() + 1;
  for (const std::uint64_t chunk_bytes : {1u, 8'000u, 30'000u, 1'000'000u}) {
    OpenClOptions options = renderer_options(precise());
    options.chunk_bytes = chunk_bytes;
    OpenClRenderer renderer(options);
    const Rendered rendered = renderer.render(plan, *scene.capture, kLight);
    EXPECT_EQ(rendered.picture.bytes, expected) << chunk_bytes;
    EXPECT_LT(rendered.statistics.launches, launches) << chunk_bytes;
    launches = rendered.statistics.launches;
    EXPECT_EQ(rendered.statistics.blocks, plan.blocks.size());
  }
  EXPECT_EQ(launches, 1u);
}

// Whole numbers have one sum: a stream, whose blocks are cut by samples' size, gives the picture of the file, whose
// blocks are cut by what changes.
TEST(BlockFeed, GivesTheSameFixedPictureWhereverBlocksAreCut) {
  for (const std::uint64_t seed : {3u, 11u, 40u, 41u}) {
    RandomCase random(seed);
    random.capture.noise = {};
    OpenClRenderer renderer(renderer_options(Precision::fixed));
    const auto picture = [&](CaptureSource& capture) {
      return render(renderer, make_plan(capture, random.functions, random.mask, {}), capture);
    };
    MemoryCapture whole(random.capture, random.timeline, random.rasters, {64}, TilePolicy::automatic);
    MemoryCapture cut(random.capture, random.timeline, random.rasters,
                      {64, 2 * random.capture.sample_bytes()}, TilePolicy::automatic);
    StreamingCapture stream(random.capture, random.timeline, {0, random.rasters.size()}, 3, TilePolicy::automatic,
                            RasterStream(random.rasters));
    EXPECT_GE(cut.block_count(), whole.block_count());
    const std::vector<std::byte> expected = picture(whole);
    EXPECT_EQ(picture(cut), expected) << random.text();
    EXPECT_EQ(picture(stream), expected) << random.text();
  }
}

// Before a kernel's end is waited for, the blocks behind its own are being read.
TEST(BlockFeed, ReadsAheadWhileAKernelRuns) {
  Scene scene;
  const RenderPlan plan = scene.plan(0, 90);
  std::mutex mutex;
  std::condition_variable changed;
  std::uint64_t asked_for = 0;
  std::uint64_t exposed = 0;
  bool overlaps = true;
  test::WatchedCapture watched(*scene.capture, [&](std::uint64_t /*block*/) {
    const std::lock_guard lock(mutex);
    ++asked_for;
    changed.notify_all();
  });
  OpenClOptions options = renderer_options(precise());
  options.chunk_bytes = 1;  // a launch for each block
  OpenClRenderer renderer(options);
  const auto until_it_is_read = [&, exposer = std::this_thread::get_id()] {
    // A launch needs its own block, and the next one was read to find that it has no room: one more is read ahead.
    if (!overlaps || std::this_thread::get_id() != exposer || exposed + 2 >= plan.blocks.size()) return;
    std::unique_lock lock(mutex);
    overlaps = changed.wait_for(lock, std::chrono::seconds(20), [&] { return asked_for > exposed + 2; });
  };
  test::before_waiting = until_it_is_read;
  static_cast<void>(renderer.render(
      plan, watched, kLight, {.progress = [&](std::uint64_t blocks, std::uint64_t /*of*/) { exposed = blocks; }}));
  test::before_waiting = {};
  EXPECT_EQ(exposed, plan.blocks.size());
  EXPECT_TRUE(overlaps);
}

// What was read ahead for an exposure that failed is not taken for the next one's.
TEST(BlockFeed, RecoversFromADamagedBlock) {
  Scene scene;
  CountingCapture counted(*scene.capture);
  OpenClRenderer plain(renderer_options(precise()));
  for (const bool holds : {false, true}) {
    OpenClOptions options = renderer_options(precise());
    options.chunk_bytes = 1;
    OpenClRenderer renderer(options);
    for (const std::uint64_t damaged : {0u, 1u, 7u, 22u}) {
      if (holds) renderer.keep_resident(&counted);
      counted.damaged = damaged;
      EXPECT_THROW(static_cast<void>(render(renderer, scene.plan(0, 90), counted)), InputError) << damaged;
      counted.damaged = ~std::uint64_t{0};
      const RenderPlan plan = scene.plan(10, 50);
      EXPECT_EQ(render(renderer, plan, counted), render(plain, plan, *scene.capture)) << damaged;
    }
  }
}

}  // namespace
}  // namespace nutik::test

// Devices that make a picture together: the same picture as one of them alone, whatever is asked for. The first device
// of this machine is two or three devices here.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <set>
#include <span>
#include <thread>

#include "capture/memory_needs.hpp"
#include "opencl/device_team.hpp"
#include "support/delays.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/soft_mask.hpp"
#include "support/watched_capture.hpp"

namespace nutik::test {
namespace {

constexpr std::array<std::size_t, 2> kTwice{0, 0};
constexpr std::array<std::size_t, 3> kThrice{0, 0, 0};
constexpr OutputFormat kCodes{ValueType::code8, 255};

// 21 x 77 pixels in colour, 40 samples in blocks of 8: ten rows of tiles, the last one cut.
struct Scene {
  explicit Scene(std::uint64_t seed = 3) {
    format.shape = {21, 77, 3};
    Random random(seed);
    rasters = random_rasters(random, format, 40);
    for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
      mask.tags[pixel] = static_cast<std::uint8_t>(pixel % 5 == 0 ? 2 : pixel / 400);
    }
  }
  [[nodiscard]] MemoryCapture capture() const { return {format, timeline, rasters, 8}; }

  CaptureFormat format;
  Timeline timeline = Timeline::constant({100, 1}, {270, 1}, 40);
  Rasters rasters;
  Mask mask = Mask::uniform(21, 77, 0);
  FunctionSet functions{{0, GainFunction::boxcar(12'345'678, 333'333'333)},
                        {1, GainFunction({{0, -0.25}, {200'000'000, 1.5}, {390'000'000, 0.0}})},
                        {2, GainFunction::boxcar(100'000'000, 150'000'000)},
                        {3, GainFunction::boxcar(0, 400'000'000)},
                        {4, GainFunction::boxcar(50'000'000, 60'000'000)}};
};

// What both say of one request.
void expect_same(Renderer& alone, Renderer& team, const RenderPlan& plan, CaptureSource& source,
                 const OutputFormat& output, const RenderControl& control) {
  const Rendered one = alone.render(plan, source, output, control);
  const Rendered several = team.render(plan, source, output, control);
  EXPECT_EQ(several.picture, one.picture);
  EXPECT_EQ(several.precision, one.precision);
  EXPECT_EQ(several.saturation.below, one.saturation.below);
  EXPECT_EQ(several.saturation.above, one.saturation.above);
  EXPECT_EQ(several.passed_self_test, one.passed_self_test);
  EXPECT_EQ(several.warnings, one.warnings);
  EXPECT_EQ(several.choice->bound.worst.steps, one.choice->bound.worst.steps);
  EXPECT_EQ(several.choice->rejected.size(), one.choice->rejected.size());
}

TEST(DeviceTeam, MakesThePictureOfOneDevice) {
  const OpenClOptions options = renderer_options(std::nullopt);
  OpenClRenderer alone(options);
  DeviceTeam two(kTwice, options), three(kThrice, options);
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  std::vector<std::optional<Precision>> precisions(alone.precisions().begin(), alone.precisions().end());
  precisions.emplace_back(std::nullopt);
  for (Renderer* team : {static_cast<Renderer*>(&two), static_cast<Renderer*>(&three)}) {
    for (const std::optional<Precision> precision : precisions) {
      for (const OutputFormat& output :
           {kCodes, kLight, OutputFormat{ValueType::code16, 1000, NegativeLight::offset}}) {
        RenderControl control{.precision = precision};
        expect_same(alone, *team, plan, capture, output, control);
        for (const Rectangle& part :
             {Rectangle{0, 0, 1, 1}, Rectangle{20, 76, 1, 1}, Rectangle{3, 5, 11, 13}, Rectangle{0, 9, 21, 3},
              Rectangle{7, 7, 1, 70}, Rectangle{0, 8, 21, 64}}) {
          control.rectangle = part;
          expect_same(alone, *team, plan, capture, output, control);
        }
      }
    }
  }
}

// Masks of several values and soft ones, delays, blocks of all kinds: `fixed` has no rounding to hide behind.
TEST(DeviceTeam, MakesAnyPictureInFixed) {
  const OpenClOptions options = renderer_options(Precision::fixed);
  OpenClRenderer alone(options);
  DeviceTeam team(kTwice, options);
  int several = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomCase random(seed, {seed % 2 == 0 ? 3u : 1u, 1, 255, Transfer::srgb()});
    if (random.capture.shape.height <= kTileSide) continue;
    Random draw(seed);
    if (draw.chance(0.4)) soften(random.mask, random.functions, seed);
    PlanOptions how;
    if (draw.chance(0.4)) {
      how.delays = random_delays(draw, random.capture.shape, random.timeline.duration_ns());
    }
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, how);
    expect_same(alone, team, plan, capture, seed % 3 == 0 ? kLight : kCodes, {});
    if (HasFailure()) FAIL() << random.text();
    ++several;
  }
  EXPECT_GE(several, 20);
}

// Sums of the whole picture, of which each device needs its band.
TEST(DeviceTeam, KeepsSumsOfLight) {
  const CaptureFormat format{.shape = {24, 40, 1}};
  constexpr std::uint64_t kSamples = 50 * 32;
  Random random(4);
  MemoryCapture capture(format, Timeline::constant({1000, 1}, {180, 1}, kSamples),
                        random_rasters(random, format, kSamples), 32);
  const OpenClRenderer any(renderer_options(std::nullopt));
  for (const Precision precision : any.precisions()) {
    OpenClOptions options = renderer_options(precision);
    options.allocation_bytes = 0;  // that all sums have room
    OpenClRenderer alone(options);
    DeviceTeam team(kTwice, options);
    team.keep_resident(&capture);
    std::uint64_t kept = 0;
    for (const std::int64_t start_ms : {110, 111, 112, 114}) {
      const GainFunction boxcar = GainFunction::boxcar(start_ms * 1'000'000, (start_ms + 1250) * 1'000'000);
      const RenderPlan plan = make_plan(capture, {{0, boxcar}}, Mask::uniform(24, 40, 0), {});
      const Rendered rendered = team.render(plan, capture, kLight);
      EXPECT_EQ(rendered.picture.bytes, alone.render(plan, capture, kLight).picture.bytes);
      kept += rendered.statistics.kept_sums;
    }
    EXPECT_EQ(kept > 0, precision != Precision::fixed) << to_text(precision);
    team.keep_resident(nullptr);
  }
}

// Blocks that stay on the devices belong to each one's band.
TEST(DeviceTeam, KeepsTheResidentCapture) {
  const OpenClOptions options = renderer_options(Precision::fixed);
  OpenClRenderer alone(options);
  DeviceTeam team(kTwice, options);
  Scene scene;
  MemoryCapture capture = scene.capture();
  team.keep_resident(&capture);
  for (int k = 0; k < 6; ++k) {
    scene.functions.at(1) = GainFunction::boxcar(k * 20'000'000, 300'000'000 + k * 10'000'000);
    const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
    RenderControl control;
    if (k == 4) control.rectangle = Rectangle{2, 11, 15, 50};
    expect_same(alone, team, plan, capture, kCodes, control);
    expect_same(alone, team, plan, capture, kCodes, control);  // of sums that are there
  }
  team.keep_resident(nullptr);
}

TEST(DeviceTeam, SaysWhoMadeThePicture) {
  const OpenClOptions options = renderer_options(Precision::fixed);
  DeviceTeam team(kTwice, options);
  const std::string name = OpenClRenderer(options).name();
  EXPECT_EQ(team.name(), "2 x " + name);
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  EXPECT_EQ(team.render(plan, capture, kCodes).renderer, "2 x " + name);
  EXPECT_EQ(team.render(plan, capture, kCodes, {.rectangle = Rectangle{0, 16, 21, 8}}).renderer, name);
}

OpenClOptions block_by_block() {
  OpenClOptions options = renderer_options(Precision::fixed);
  options.chunk_bytes = 1;
  return options;
}

TEST(DeviceTeam, LeavesACaptureThatIsReadForwardToOneDevice) {
  OpenClRenderer alone(block_by_block());
  DeviceTeam team(kTwice, block_by_block());
  const Scene scene;
  MemoryCapture capture = scene.capture();
  std::vector<std::uint64_t> asked;
  WatchedCapture forward(
      capture, [&](std::uint64_t block) { asked.push_back(block); }, true);
  const RenderPlan plan = make_plan(forward, scene.functions, scene.mask, {});
  const Rendered rendered = team.render(plan, forward, kLight);
  EXPECT_EQ(asked, (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(rendered.renderer, alone.name());
  EXPECT_EQ(rendered.picture, alone.render(plan, capture, kLight).picture);
}

// What happens to one device ends the work of all, and is what is said; the next picture is whole.
TEST(DeviceTeam, EndsWhereOneDeviceFails) {
  OpenClRenderer alone(block_by_block());
  DeviceTeam team(kTwice, block_by_block());
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  for (int at = 0; at < 10; ++at) {
    std::atomic<int> calls{0};
    WatchedCapture damaged(capture, [&](std::uint64_t) {
      if (calls++ == at) throw InputError("a damaged block");
    });
    EXPECT_EQ(message_of<InputError>([&] { return team.render(plan, damaged, kCodes); }), "a damaged block");
    calls = 0;
    WatchedCapture lost(capture, [&](std::uint64_t) {
      if (calls++ == at) throw DeviceError("it is lost", {Setting::renderer});
    });
    EXPECT_EQ(message_of<DeviceError>([&] { return team.render(plan, lost, kCodes); }), "device 0: it is lost");
  }
  EXPECT_EQ(team.render(plan, capture, kCodes).picture, alone.render(plan, capture, kCodes).picture);
}

TEST(DeviceTeam, EndsWhenItIsCancelled) {
  DeviceTeam team(kTwice, block_by_block());
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  for (int at = 0; at < 8; ++at) {
    std::atomic<int> calls{0};
    std::stop_source stop;
    WatchedCapture stopping(capture, [&](std::uint64_t) {
      if (calls++ == at) stop.request_stop();
    });
    EXPECT_THROW(static_cast<void>(team.render(plan, stopping, kCodes, {.stop = stop.get_token()})), Cancelled);
  }
  EXPECT_NO_THROW(static_cast<void>(team.render(plan, capture, kCodes)));
}

// Pictures of their own, at the same time: the first one's block is not lent before the second one's is asked for.
TEST(DeviceTeam, MakesPicturesSideBySide) {
  OpenClRenderer alone(block_by_block());
  DeviceTeam team(kTwice, block_by_block());
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  std::atomic<int> began{0};
  std::atomic<bool> met{true};
  WatchedCapture waiting(capture, [&](std::uint64_t block) {
    if (block != 0) return;
    ++began;
    for (int i = 0; i < 3000 && began < 2; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (began < 2) met = false;
  });
  const auto render = [&] { return team.render(plan, waiting, kCodes, {.by_one_device = true}); };
  auto other = std::async(std::launch::async, render);
  const Rendered one = render(), two = other.get();
  EXPECT_TRUE(met);
  EXPECT_EQ(one.renderer, team.name());
  const Picture picture = alone.render(plan, capture, kCodes).picture;
  EXPECT_EQ(one.picture, picture);
  EXPECT_EQ(two.picture, picture);
}

// More pictures than devices, with what a device is lost at: its number is told, and it is free for the next one.
TEST(DeviceTeam, MakesPicturesOfOneDeviceEach) {
  const OpenClOptions options = renderer_options(Precision::fixed);
  OpenClRenderer alone(options);
  DeviceTeam team(kThrice, options);
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  const Picture picture = alone.render(plan, capture, kCodes).picture;
  for (int round = 0; round < 3; ++round) {
    std::vector<std::future<Rendered>> pictures;
    for (int i = 0; i < 9; ++i) {
      pictures.push_back(
          std::async(std::launch::async, [&] { return team.render(plan, capture, kCodes, {.by_one_device = true}); }));
    }
    for (auto& each : pictures) EXPECT_EQ(each.get().picture, picture);
    EXPECT_EQ(team.render(plan, capture, kCodes).picture, picture);  // in bands
    WatchedCapture lost(capture, [&](std::uint64_t) { throw DeviceError("it is lost"); });
    RenderControl own{.by_one_device = true};
    EXPECT_EQ(message_of<DeviceError>([&] { return team.render(plan, lost, kCodes, own); }), "device 0: it is lost");
    std::stop_source stop;
    stop.request_stop();
    own.stop = stop.get_token();
    EXPECT_THROW(static_cast<void>(team.render(plan, capture, kCodes, own)), Cancelled);
  }
}

// Pictures of one device each that overlap without end: one in bands has its turn among them.
TEST(DeviceTeam, KeepsBandsWaitingNoLongerThanPicturesTake) {
  DeviceTeam team(kTwice, renderer_options(Precision::fixed));
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  static_cast<void>(team.render(plan, capture, kCodes));  // its kernels are there
  WatchedCapture slow(capture, [](std::uint64_t block) {
    if (block == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  std::atomic<bool> is_done{false};
  std::vector<std::jthread> others;
  for (int i = 0; i < 4; ++i) {
    others.emplace_back([&] {
      while (!is_done) static_cast<void>(team.render(plan, slow, kCodes, {.by_one_device = true}));
    });
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  auto bands = std::async(std::launch::async, [&] { return team.render(plan, capture, kCodes); });
  EXPECT_EQ(bands.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  is_done = true;
}

// Half of the memory is too little for a picture of one device: both make it in bands, in which it has room.
TEST(DeviceTeam, MakesBandsWhereMemoryIsLittle) {
  const OpenClOptions options = renderer_options(Precision::fixed);
  OpenClRenderer alone(options);
  DeviceTeam team(kTwice, options);
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  RenderControl own{.by_one_device = true, .memory_bytes = 1};
  try {
    static_cast<void>(team.render(plan, capture, kCodes, own));
    FAIL() << "a byte is enough";
  } catch (const MemoryTooLittle& error) {
    own.memory_bytes = error.min_bytes();
  }
  EXPECT_EQ(team.render(plan, capture, kCodes, own).picture, alone.render(plan, capture, kCodes).picture);
}

TEST(DeviceTeam, NamesTheLeastMemoryThatItWorksWith) {
  const OpenClOptions options = renderer_options(Precision::fixed);
  OpenClRenderer alone(options);
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  const auto least_of = [&](Renderer& renderer) -> std::uint64_t {
    try {
      static_cast<void>(renderer.render(plan, capture, kCodes, {.memory_bytes = 1}));
    } catch (const MemoryTooLittle& error) {
      std::set<std::string> parts;
      for (const MemoryPart& part : error.needs.parts())
        EXPECT_TRUE(parts.insert(part.what).second) << part.what;
      return error.min_bytes();
    }
    ADD_FAILURE() << "a byte is enough";
    return 0;
  };
  const std::uint64_t of_one = least_of(alone);
  for (const auto devices : {std::span<const std::size_t>(kTwice), std::span<const std::size_t>(kThrice)}) {
    DeviceTeam team(devices, options);
    RenderControl control{.memory_bytes = least_of(team)};
    EXPECT_GE(control.memory_bytes, of_one + capture.format().shape.value_count());
    expect_same(alone, team, plan, capture, kCodes, control);
    --control.memory_bytes;
    EXPECT_THROW(static_cast<void>(team.render(plan, capture, kCodes, control)), MemoryTooLittle);
  }
}

// An arithmetic that a device computes wrongly is no part of the choice; who asks for it is refused, but for measuring.
TEST(DeviceTeam, ChoosesAmongWhatAllComputeRightly) {
  OpenClOptions options = renderer_options(std::nullopt);
  options.tests_itself = true;
  options.faults[Precision::single_] = "-DNUTIK_LIGHT=NUTIK_LIGHT_LINEAR";
  DeviceTeam team(kTwice, options);
  const Scene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  const Rendered rendered = team.render(plan, capture, kCodes);
  EXPECT_NE(rendered.precision, Precision::single_);
  EXPECT_TRUE(rendered.passed_self_test);
  RenderControl asked{.precision = Precision::single_};
  expect_error<DeviceError>([&] { return team.render(plan, capture, kCodes, asked); }, {"computes `single` wrongly"});
  asked.takes_wrong = true;
  const Rendered wrong = team.render(plan, capture, kCodes, asked);
  EXPECT_FALSE(wrong.passed_self_test);
  EXPECT_TRUE(wrong.warnings.empty());
}

}  // namespace
}  // namespace nutik::test

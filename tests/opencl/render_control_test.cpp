// What a render is asked for beside its picture: a rectangle of it, an arithmetic, an end before it is whole. And many
// of them at once.
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "render/reference_renderer.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/watched_capture.hpp"
#include "system/mapped_file.hpp"

namespace nutik::test {
namespace {

const CodeFormat kColour{3, 1, 255, Transfer::srgb()};

std::vector<Rectangle> rectangles_of(const Shape& shape) {
  const std::uint32_t right = shape.width - 1, bottom = shape.height - 1;
  return {{0, 0, 1, 1},
          {right, bottom, 1, 1},
          {0, bottom / 2, shape.width, 1},
          {right / 2, 0, 1, shape.height},
          {right / 3, bottom / 3, shape.width - right / 3, shape.height - bottom / 3},
          {right / 4, bottom / 4, shape.width / 2 + 1, shape.height / 2 + 1},
          Rectangle::whole(shape)};
}

void expect_rectangles(Renderer& renderer, const RandomCase& random, RenderControl control) {
  MemoryCapture capture = random.encode();
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  for (const OutputFormat& output :
       {OutputFormat{ValueType::code8, 255}, OutputFormat{ValueType::code16, 1000, NegativeLight::offset},
        OutputFormat{ValueType::light32, 0}, OutputFormat{ValueType::light64, 0}}) {
    control.rectangle.reset();
    const Picture whole = renderer.render(plan, capture, output, control).picture;
    for (const Rectangle& rectangle : rectangles_of(plan.capture.shape)) {
      control.rectangle = rectangle;
      const Picture part = renderer.render(plan, capture, output, control).picture;
      ASSERT_EQ(part.shape, (Shape{rectangle.width, rectangle.height, plan.capture.shape.channels}));
      EXPECT_EQ(part.bytes, part_of(whole, rectangle)) << rectangle.x << "," << rectangle.y << " " << rectangle.width
                                                       << " x " << rectangle.height << ": " << random.text();
    }
  }
}

// A driver that compiles while it launches has LLVM's handler in place of the program's.
TEST(RenderControl, LostFilesAreWatchedAfterADriverHasCompiled) {
  watch_mapped_files();
  const auto handler = [] {
    struct sigaction now {};
    sigaction(SIGBUS, nullptr, &now);
    return now.sa_sigaction;
  };
  const auto of_program = handler();
  OpenClRenderer renderer(renderer_options(std::nullopt));
  const RandomCase random(0, kColour);
  MemoryCapture capture = random.encode();
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  std::signal(SIGBUS, [](int) { std::_Exit(7); });
  static_cast<void>(renderer.render(plan, capture, {ValueType::light64, 0}, {}));
  EXPECT_EQ(handler(), of_program);
}

TEST(RenderControl, RectanglesArePartsOfThePicture) {
  OpenClOptions options = renderer_options(std::nullopt);
  OpenClRenderer usual(options);
  options.item_pixels = options.item_tiles = options.lanes = 1;
  options.group_items = 64;
  OpenClRenderer lane_by_lane(options);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const RandomCase random =
        seed % 4 == 3 ? RandomCase(seed, {1, 2, 1023, Transfer::linear()}) : RandomCase(seed, kColour);
    RenderControl control;
    for (const Precision precision : usual.precisions()) {
      control.precision = precision;
      expect_rectangles(seed == 1 ? lane_by_lane : usual, random, control);
    }
    ReferenceRenderer reference;
    expect_rectangles(reference, random, {});
  }
}

TEST(RenderControl, RefusesRectanglesThatAreNoPart) {
  const RandomCase random(1);
  MemoryCapture capture = random.encode();
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  const Shape& shape = plan.capture.shape;
  ReferenceRenderer reference;
  for (const Rectangle& rectangle : {Rectangle{0, 0, 0, 1}, Rectangle{shape.width, 0, 1, 1},
                                     Rectangle{0, 0, 1, shape.height + 1}, Rectangle{~0u, 0, 2, 1}}) {
    const auto render = [&] {
      return reference.render(plan, capture, {ValueType::code8, 255}, {.rectangle = rectangle});
    };
    expect_error<UsageError>(render, {"is no part of a picture of"});
  }
}

TEST(RenderControl, EndsWhenItIsCancelled) {
  const RandomCase random(3, kColour);
  MemoryCapture capture = random.encode(1, TilePolicy::automatic);
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {.live_all = true});
  const std::uint64_t last = capture.block_count() - 1;
  OpenClOptions options = renderer_options(std::nullopt);
  options.chunk_bytes = 1;
  OpenClRenderer opencl(options);
  ReferenceRenderer reference;
  const OutputFormat output{ValueType::code8, 255};
  for (Renderer* renderer : {static_cast<Renderer*>(&opencl), static_cast<Renderer*>(&reference)}) {
    for (const std::uint64_t block : {std::uint64_t{0}, last / 2}) {
      std::stop_source stop;
      WatchedCapture cancelling(capture, [&](std::uint64_t asked) {
        if (asked == block) stop.request_stop();
      });
      EXPECT_THROW(static_cast<void>(renderer->render(plan, cancelling, output, {.stop = stop.get_token()})),
                   Cancelled);
    }
    // The next render starts anew.
    EXPECT_NO_THROW(static_cast<void>(renderer->render(plan, capture, output)));
  }
}

// Each thread its own plans, arithmetics and rectangles; some give up. Everybody gets what is asked for.
TEST(RenderControl, ManyThreadsMayAskAtATime) {
  const RandomCase random(5, kColour);
  MemoryCapture capture = random.encode(7, TilePolicy::automatic);
  OpenClRenderer renderer(renderer_options(std::nullopt));
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  const OutputFormat output{ValueType::light64, 0};
  std::vector<Picture> expected;
  for (const Precision precision : renderer.precisions()) {
    expected.push_back(renderer.render(plan, capture, output, {.precision = precision}).picture);
  }
  renderer.keep_resident(&capture);
  const std::vector<Rectangle> rectangles = rectangles_of(plan.capture.shape);
  std::atomic<int> wrong{0}, cancelled{0};
  {
    std::vector<std::jthread> threads;
    for (std::size_t thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (std::size_t i = 0; i < 12; ++i) {
          const std::size_t p = (thread + i) % renderer.precisions().size();
          RenderControl control{.rectangle = rectangles[(thread * 3 + i) % rectangles.size()],
                                .precision = renderer.precisions()[p]};
          std::stop_source stop;
          control.stop = stop.get_token();
          if (i % 3 == 0) stop.request_stop();
          try {
            const Rendered rendered = renderer.render(plan, capture, output, control);
            wrong += rendered.precision != *control.precision ||
                     rendered.picture.bytes != part_of(expected[p], *control.rectangle);
          } catch (const Cancelled&) {
            ++cancelled;
          }
        }
      });
    }
  }
  renderer.keep_resident(nullptr);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(cancelled, 16);
}

}  // namespace
}  // namespace nutik::test

// Pictures on a device that allocates little at a time: the very ones that it makes when everything fits.
#include <gtest/gtest.h>

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/allocation_cuts.hpp"
#include "opencl/kernel_numbers.hpp"
#include "opencl/opencl_renderer.hpp"
#include "opencl/work_shape.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/raster_stream.hpp"
#include "support/rendering.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

constexpr std::uint64_t kPageBytes = 4096;

// 72 samples, most of them still: what is stored is smaller than a picture's sums, so that a limit can hold the one
// and not the other. Every kind of tile is among them; neither side is a multiple of 8. 128 functions, of which
// some tiles have one and some several, make tables worth cutting.
struct Scene {
  static constexpr std::uint64_t kSamples = 72;
  static constexpr std::uint32_t kFunctions = 128;

  explicit Scene(const CodeFormat& codes) {
    format.shape = {45, 123, codes.channels};
    format.code_bytes = codes.code_bytes;
    format.white_code = codes.white_code;
    format.transfer = codes.transfer;
    Random random(99);
    timeline = random_timeline(random, kSamples);
    std::vector<std::byte> raster(format.sample_bytes());
    for (std::uint64_t k = 0; k < kSamples; ++k) {
      for (std::uint64_t pixel = 0; pixel < format.shape.pixel_count(); ++pixel) {
        const std::uint64_t tile = TileGrid(format.shape)
                                       .tile_of(static_cast<std::uint32_t>(pixel % format.shape.width),
                                                static_cast<std::uint32_t>(pixel / format.shape.width));
        const double share = k == 0 ? 1.0 : tile % 31 == 3 ? 1.0 : tile % 17 == 4 ? 0.02 : 0.0;
        if (!random.chance(share)) continue;
        for (std::uint32_t channel = 0; channel < format.shape.channels; ++channel) {
          set_code(format, raster, pixel * format.shape.channels + channel,
                   static_cast<std::uint32_t>(random.whole(0, format.white_code)));
        }
      }
      rasters.push_back(raster);
    }
    for (std::uint32_t tag = 0; tag < kFunctions; ++tag) {
      functions.emplace(static_cast<std::uint8_t>(tag), random_function(random, timeline));
    }
    mask = Mask::uniform(format.shape.width, format.shape.height, 0);
    for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
      const std::size_t row = pixel / format.shape.width;
      mask.tags[pixel] = static_cast<std::uint8_t>(row < 30 ? row / 8 : random.whole(0, kFunctions - 1));
    }
  }

  [[nodiscard]] MemoryCapture encode(std::uint32_t block_samples, TilePolicy policy) const {
    return {format, timeline, rasters, block_samples, policy};
  }

  CaptureFormat format;
  Timeline timeline = Timeline::constant({1, 1}, Timeline::kFullShutter, 1);
  Rasters rasters;
  FunctionSet functions;
  Mask mask;
};

// The least that a device must allocate at a time for an exposure of this capture: a block's payload where it lies
// in a file, a block's tables, a row of tiles; and what is not cut.
std::uint64_t smallest_allocation(const RenderPlan& plan, const MemoryCapture& capture, Precision precision) {
  const OutputFormat codes{code_type(plan.capture), plan.capture.white_code};
  const CodeTables tables = code_tables(CodeKey::of(plan, precision, codes)).value();
  std::uint64_t bytes =
      sums_bytes(TileGrid(plan.capture.shape).columns(), plan.capture.shape.channels, precision);
  bytes = std::max({bytes, tables.thresholds.size(), tables.guesses.size() * sizeof(std::uint32_t)});
  for (const PlannedBlock& block : plan.blocks) {
    bytes =
        std::max({bytes, kPageBytes + align_up(capture.view(block.block).payload().size(), kBlockAlignment),
                  align_up(block.row_count(), WorkShape::kMaxTableRows) * plan.function_count() *
                      weight_bytes(precision)});
  }
  return bytes;
}

struct Pictures {
  std::vector<std::byte> codes, light;
  RenderStatistics statistics;  // of light
  friend bool operator==(const Pictures& a, const Pictures& b) {
    return a.codes == b.codes && a.light == b.light;
  }
};

class SmallAllocations : public OfPrecision {
 protected:
  [[nodiscard]] static OpenClOptions options(std::uint64_t allocation_bytes = 0) {
    OpenClOptions options = OfPrecision::options();
    options.allocation_bytes = allocation_bytes;
    return options;
  }

  static Pictures render(OpenClRenderer& renderer, const RenderPlan& plan, CaptureSource& source) {
    const OutputFormat codes{plan.capture.code_bytes == 1 ? ValueType::code8 : ValueType::code16,
                             plan.capture.white_code};
    std::vector<std::byte> of_codes = renderer.render(plan, source, codes).picture.bytes;
    Rendered light = renderer.render(plan, source, {ValueType::light64, 0});
    return {std::move(of_codes), std::move(light.picture.bytes), light.statistics};
  }
};

// A capture as a file, unpacked: blocks are read where they are mapped.
tik::Reader mapped(const Scene& scene, const MemoryCapture& capture, const Scratch& scratch) {
  return tik::Reader(write_tik(capture, scene.rasters.front(), tik::Codec::parse("none"), scratch));
}

// Codes and light, to the last bit, under limits that force bands, slices and chunks; of captures that are held,
// streamed and mapped, with tiles of all kinds.
TEST_P(SmallAllocations, GiveTheSamePictures) {
  const Scene scene({3, 1, 255, Transfer::srgb()});
  for (const auto& [policy, block_samples] :
       {std::pair{TilePolicy::automatic, 6u}, std::pair{TilePolicy::records, 5u},
        std::pair{TilePolicy::rows, 6u}, std::pair{TilePolicy::dense, 2u}}) {
    MemoryCapture capture = scene.encode(block_samples, policy);
    const Scratch scratch;
    tik::Reader file = mapped(scene, capture, scratch);
    ASSERT_FALSE(file.acquire(0).mapping().empty());
    const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
    OpenClRenderer plain(options());
    const Pictures expected = render(plain, plan, capture);
    EXPECT_EQ(expected.statistics.launches, 1u);
    const RenderPlan other = make_plan(capture, scene.functions, Mask::uniform(45, 123, 2), {});
    const Pictures others = render(plain, other, capture);
    const std::uint64_t smallest = smallest_allocation(plan, capture, GetParam());
    for (const std::uint64_t limit : {smallest, smallest * 5 / 4, smallest * 3 / 2, smallest * 3}) {
      const std::uint64_t bands =
          cut_picture(plan.capture.shape, Rectangle::whole(plan.capture.shape), GetParam(), device_allocating(limit))
              .size();
      const std::uint64_t slices = cut_tables(plan, TableNumbers::of(GetParam()), device_allocating(limit)).size();
      const std::string what = nutik::format("{}, blocks of {}, {} bytes at a time, {} bands, {} slices",
                                             to_text(policy), block_samples, limit, bands, slices);
      SCOPED_TRACE(what);
      const auto check = [&](const RenderStatistics& took) {
        const std::uint64_t launches = took.launches;
        EXPECT_EQ(launches % bands, 0u);
        EXPECT_GE(launches / bands, slices);
        EXPECT_EQ(took.blocks, plan.blocks.size());
        if (limit == smallest) {
          EXPECT_GE(bands, 2u);
          EXPECT_GE(slices, 2u);
          EXPECT_GT(launches / bands, slices);  // payloads do not fit either
        }
      };
      OpenClRenderer renderer(options(limit));
      const auto expect_same = [&](CaptureSource& source, const char* how) {
        const Pictures pictures = render(renderer, plan, source);
        EXPECT_TRUE(pictures == expected) << how;
        check(pictures.statistics);
      };
      expect_same(capture, "read");
      expect_same(file, "mapped");
      for (const bool codes : {false, true}) {
        StreamingCapture stream(scene.format, scene.timeline, {0, Scene::kSamples}, block_samples, policy,
                                RasterStream(scene.rasters));
        const OutputFormat output =
            codes ? OutputFormat{ValueType::code8, 255} : OutputFormat{ValueType::light64, 0};
        const Rendered rendered = renderer.render(plan, stream, output);
        EXPECT_TRUE(rendered.picture.bytes == (codes ? expected.codes : expected.light)) << "streamed";
        check(rendered.statistics);
      }
      renderer.keep_resident(&capture);
      for (const char* how : {"kept", "kept before"}) {
        // Functions that are not those of the exposure before.
        const RenderPlan again = make_plan(capture, scene.functions, scene.mask, {});
        EXPECT_TRUE(render(renderer, again, capture) == expected) << how;
      }
      EXPECT_TRUE(render(renderer, other, capture) == others) << "kept, and other slices";
    }
  }
}

// Codes of 16 bits in one channel, work-items as on a GPU and items that own more tiles than a band has.
TEST_P(SmallAllocations, GiveTheSamePicturesHoweverItemsAreCut) {
  const Scene scene({1, 2, 1023, Transfer::linear()});
  MemoryCapture capture = scene.encode(3, TilePolicy::automatic);
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  const std::uint64_t limit = smallest_allocation(plan, capture, GetParam());
  const std::uint64_t bands =
      cut_picture(plan.capture.shape, Rectangle::whole(plan.capture.shape), GetParam(), device_allocating(limit))
          .size();
  ASSERT_GE(bands, 2u);
  struct Items {
    std::uint32_t pixels, tiles, lanes, group;
  };
  for (const Items& items : {Items{1, 1, 1, 64}, Items{16, 1000, 8, 3}}) {
    OpenClOptions whole = options(), cut = options(limit);
    for (OpenClOptions* each : {&whole, &cut}) {
      each->item_pixels = items.pixels;
      each->item_tiles = items.tiles;
      each->lanes = items.lanes;
      each->group_items = items.group;
    }
    OpenClRenderer plain(whole), renderer(cut);
    const Pictures in_parts = render(renderer, plan, capture), at_once = render(plain, plan, capture);
    EXPECT_TRUE(in_parts == at_once) << items.pixels;
    EXPECT_EQ(at_once.statistics.launches, 1u);
    EXPECT_GT(in_parts.statistics.launches, bands);
  }
}

// Sums of whole numbers are the same in any order of a chunk's blocks, chunks and slices being in order.
TEST(SmallAllocationsOfWholeNumbers, GiveTheSamePicturesFromTheLastBlock) {
  const Scene scene({3, 1, 255, Transfer::srgb()});
  MemoryCapture capture = scene.encode(2, TilePolicy::automatic);
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  OpenClOptions options = renderer_options(Precision::fixed);
  OpenClRenderer plain(options);
  options.last_block_first = true;
  options.allocation_bytes = 2 * smallest_allocation(plan, capture, Precision::fixed);
  OpenClRenderer renderer(options);
  const OutputFormat light{ValueType::light64, 0};
  const Rendered rendered = renderer.render(plan, capture, light);
  EXPECT_TRUE(rendered.picture.bytes == plain.render(plan, capture, light).picture.bytes);
  const DeviceInfo device = device_allocating(options.allocation_bytes);
  const std::uint64_t bands =
      cut_picture(plan.capture.shape, Rectangle::whole(plan.capture.shape), Precision::fixed, device).size();
  EXPECT_GE(bands, 2u);
  EXPECT_GT(rendered.statistics.launches, bands);
  EXPECT_LT(rendered.statistics.launches, bands * plan.blocks.size());  // chunks of several blocks
}

// Saturation is counted, and a picture in which nothing is live is black, over all bands.
TEST_P(SmallAllocations, CountAndFillAllBands) {
  const Scene scene({3, 1, 255, Transfer::srgb()});
  MemoryCapture capture = scene.encode(6, TilePolicy::automatic);
  const RenderPlan plan = make_plan(capture, scene.functions, scene.mask, {});
  OpenClRenderer plain(options());
  OpenClRenderer renderer(options(smallest_allocation(plan, capture, GetParam())));
  const OutputFormat codes{ValueType::code8, 255};
  const Rendered expected = plain.render(plan, capture, codes);
  const Rendered rendered = renderer.render(plan, capture, codes);
  EXPECT_TRUE(rendered.picture.bytes == expected.picture.bytes);
  EXPECT_NE(expected.saturation, Saturation{});
  EXPECT_EQ(rendered.saturation, expected.saturation);

  const FunctionSet zero{{0, GainFunction({{0, 0.0}})}};
  const RenderPlan dark = make_plan(capture, zero, Mask::uniform(45, 123, 0), {});
  const Rendered black = renderer.render(dark, capture, codes);
  EXPECT_TRUE(std::ranges::all_of(black.picture.bytes, [](std::byte code) { return code == std::byte{0}; }));
  EXPECT_EQ(black.statistics.launches, 0u);
}

// A row of tiles is the least that is computed at a time, a block's tables and its payload the least that is uploaded.
// What is larger is refused with the way out, to the byte.
TEST_P(SmallAllocations, RefuseWhatCannotBeCut) {
  const Scene scene({3, 1, 255, Transfer::srgb()});
  const auto message = [&](std::uint64_t limit, const RenderPlan& plan, CaptureSource& source) {
    OpenClRenderer renderer(options(limit));
    return message_of<DeviceError>([&] { return render(renderer, plan, source); });
  };
  const auto expect_parts = [](const std::string& text, std::initializer_list<std::string> parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << ": " << text;
  };

  CaptureFormat wide = scene.format;
  wide.shape = {600, 9, 3};
  const Rasters still(Scene::kSamples, std::vector<std::byte>(wide.sample_bytes(), std::byte{70}));
  MemoryCapture wide_capture(wide, scene.timeline, still, 32);
  const RenderPlan of_row = make_plan(wide_capture, scene.functions, Mask::uniform(600, 9, 0), {});
  const std::uint64_t row_bytes = sums_bytes(75, 3, GetParam());
  EXPECT_EQ(message(row_bytes, of_row, wide_capture), "");
  const std::string row = message(row_bytes - 1, of_row, wide_capture);
  expect_parts(
      row, {"a row of tiles of a picture 600 pixels wide, in " + to_text(GetParam()) + " precision, takes",
            "allocates at most", "or the reference"});
  EXPECT_EQ(row.find("single precision, or") != std::string::npos, GetParam() != Precision::single_) << row;

  FunctionSet all;
  Mask each = Mask::uniform(600, 9, 0);
  for (std::size_t pixel = 0; pixel < each.tags.size(); ++pixel) {
    each.tags[pixel] = static_cast<std::uint8_t>(pixel % kMaskValues);
  }
  for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) {
    all.emplace(static_cast<std::uint8_t>(tag), GainFunction::boxcar(0, scene.timeline.duration_ns()));
  }
  MemoryCapture long_blocks(wide, scene.timeline, still, 2 * Scene::kSamples);
  const RenderPlan of_all = make_plan(long_blocks, all, each, {});
  const std::uint64_t table_bytes =
      kMaskValues * align_up(Scene::kSamples + 1, WorkShape::kMaxTableRows) * weight_bytes(GetParam());
  ASSERT_GT(table_bytes, row_bytes);
  EXPECT_EQ(message(table_bytes, of_all, long_blocks), "");
  expect_parts(message(table_bytes - 1, of_all, long_blocks),
               {"a table of 256 functions for a block of 72 samples takes", "allocates at most",
                "fewer samples a block", "fewer functions"});

  MemoryCapture dense = scene.encode(Scene::kSamples, TilePolicy::dense);
  const RenderPlan of_block = make_plan(dense, {{0, scene.functions.at(0)}}, Mask::uniform(45, 123, 0), {});
  const std::uint64_t block_bytes = dense.view(0).payload().size();
  EXPECT_EQ(message(align_up(block_bytes, kBlockAlignment), of_block, dense), "");
  expect_parts(message(block_bytes - 1, of_block, dense),
               {"a block of 72 samples takes", "allocates at most", "fewer samples a block"});
}

INSTANTIATE_TEST_SUITE_P(, SmallAllocations, testing::ValuesIn(kPrecisions),
                         [](const auto& instance) { return to_text(instance.param); });

}  // namespace
}  // namespace nutik::test

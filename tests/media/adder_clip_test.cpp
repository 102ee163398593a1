// ADΔER files: light is what was written, from the times on at which it begins, in every version, mode of time and kind
// of source; what is wrong with a file is told, or refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <set>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "support/bytes.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

struct File {
  unsigned version = 3, width = 5, height = 3, ticks_a_second = 120'000, interval = 5000, channels = 1, source = 6;
  bool absolute = true;

  [[nodiscard]] std::string header(const std::string& magic = "adder") const {
    std::string text = magic + big_endian(version, 1) + "b" + big_endian(width, 2) + big_endian(height, 2) +
                       big_endian(ticks_a_second, 4) + big_endian(interval, 4) + big_endian(interval * 24ull, 4) +
                       big_endian(channels == 1 ? 9 : 11, 1) + big_endian(channels, 1);
    if (version >= 1) text += big_endian(source, 4);
    if (version >= 2) text += big_endian(absolute ? 1 : 0, 4);
    if (version >= 3) text += big_endian(1, 4);
    return text;
  }
  [[nodiscard]] std::string event(unsigned x, unsigned y, unsigned channel, unsigned d, std::uint64_t t) const {
    return big_endian(x, 2) + big_endian(y, 2) + (channels > 1 ? "\x01" + big_endian(channel, 1) : "") +
           big_endian(d, 1) + big_endian(t, 4);
  }
  [[nodiscard]] std::string end() const { return event(0xFFFF, 0xFFFF, 0, 0, 0); }
};

// Light that one value had, in ticks from the start.
struct Stretch {
  std::uint64_t from, until;
  double light;  // 1: white
};

// Events of one value, and the light that they stand for.
std::vector<Stretch> random_value(Random& random, const File& file, std::uint64_t last,
                                  const std::function<void(unsigned, std::uint64_t)>& write) {
  std::vector<Stretch> light;
  double before = 0;
  for (std::uint64_t now = 0; now < last;) {
    const std::uint64_t length = static_cast<std::uint64_t>(random.whole(1, 9000));
    const auto kind = random.whole(0, 9);
    unsigned d = static_cast<unsigned>(random.whole(0, 8));
    double value =
        std::min(1.0, std::ldexp(1.0, static_cast<int>(d)) / static_cast<double>(length) * file.interval / 255);
    if (kind == 0) {
      d = random.chance(0.5) ? 128 : 254;
      value = 0;
    }
    if (kind == 1) {
      d = 255;
      value = before;
    }
    write(d, file.version >= 2 && file.absolute ? now + length : length);
    std::uint64_t until = now + length;
    if (file.version >= 1 && file.source <= 5 && until % file.interval != 0)
      until += file.interval - until % file.interval;
    light.push_back({now, until, value});
    before = value;
    now = until;
  }
  return light;
}

double light_at(const std::vector<Stretch>& light, std::uint64_t tick) {
  double last = 0;
  for (const Stretch& stretch : light) {
    last = stretch.light;
    if (tick < stretch.until) break;
  }
  return last;
}

TEST(AdderClip, HoldsTheLightThatWasWritten) {
  const Scratch scratch;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    Random random(seed);
    File file;
    file.version = static_cast<unsigned>(random.whole(0, 3));
    file.channels = random.chance(0.4) ? 3 : 1;
    file.source = random.chance(0.5) ? 0 : 6;
    file.absolute = random.chance(0.5);
    file.ticks_a_second = random.pick<unsigned>({120'000, 7'650, 1'000'000});
    // Values one after another: files need not be in the order of times, but for each value.
    std::string content = file.header();
    std::vector<std::vector<Stretch>> values;
    for (unsigned y = 0; y < file.height; ++y) {
      for (unsigned x = 0; x < file.width; ++x) {
        for (unsigned c = 0; c < file.channels; ++c) {
          values.push_back(random_value(random, file, 60'000, [&](unsigned d, std::uint64_t t) {
            content += file.event(x, y, c, d, t);
            if (random.chance(0.1)) content += file.event(x, y, c, 253, t);  // no event
          }));
        }
      }
    }
    const auto clip = open_test_clip(scratch.write("a.adder", content + file.end()));
    const ClipInfo& info = clip->info();
    ASSERT_EQ(info.format.shape, (Shape{file.width, file.height, file.channels}));
    const auto rasters = read_all(*clip);
    ASSERT_EQ(rasters.size(), info.timing.exposures.size());
    std::uint64_t end = 0;
    for (const auto& light : values) end = std::max(end, light.back().until);
    const auto ns = [&](std::uint64_t tick) {
      return std::llround(static_cast<double>(tick) * 1e9 / file.ticks_a_second);
    };
    EXPECT_EQ(info.timing.exposures.back().end_ns, ns(end));
    for (std::size_t k = 0; k < rasters.size(); ++k) {
      const auto tick = static_cast<std::uint64_t>(
          std::llround(static_cast<double>(info.timing.exposures[k].start_ns) * file.ticks_a_second / 1e9));
      ASSERT_EQ(ns(tick), info.timing.exposures[k].start_ns) << "seed " << seed;
      for (std::size_t value = 0; value < values.size(); ++value) {
        std::uint16_t code = 0;
        std::memcpy(&code, rasters[k].data() + 2 * value, 2);
        ASSERT_NEAR(code, light_at(values[value], tick) * 65535, 0.5 + 1e-6)
            << "seed " << seed << ", tick " << tick << ", value " << value;
      }
    }
    // Nothing begins between samples: every stretch's start is one, unless the light is what it was before.
    std::set<std::int64_t> starts;
    for (const Exposure& exposure : info.timing.exposures) starts.insert(exposure.start_ns);
    for (const auto& light : values) {
      for (std::size_t i = 1; i < light.size(); ++i) {
        if (std::abs(light[i].light - light[i - 1].light) > 1.0 / 65535) {
          EXPECT_TRUE(starts.contains(ns(light[i].from))) << "seed " << seed;
        }
      }
    }
  }
}

TEST(AdderClip, TakesWhiteFromItsSourceOrAsItIsStated) {
  const Scratch scratch;
  File file;
  const auto code = [&](std::optional<std::uint32_t> white) {
    // 2^6 units in one reference interval.
    const auto path = scratch.write("a.adder", file.header() + file.event(0, 0, 0, 6, file.interval) + file.end());
    const auto clip = open_test_clip(path, {.white_code = white});
    std::vector<std::byte> raster(clip->info().format.sample_bytes());
    EXPECT_TRUE(clip->read(raster));
    std::uint16_t found = 0;
    std::memcpy(&found, raster.data(), 2);
    return std::pair(static_cast<long>(found), facts_of(*clip).at(Setting::white_code).line());
  };
  using Found = std::pair<long, std::string>;
  const long of_255 = std::lround(64.0 / 255 * 65535);
  EXPECT_EQ(code({}), (Found{of_255, "white 255 units in a reference interval, assumed"}));
  file.source = 0;
  EXPECT_EQ(code({}), (Found{of_255, "white 255 units in a reference interval, from the file's source 0"}));
  EXPECT_EQ(code(100), (Found{std::lround(0.64 * 65535), "white 100 units in a reference interval, as stated"}));
  EXPECT_EQ(code(32), (Found{65535, "white 32 units in a reference interval, as stated"}));
  file.source = 1;
  EXPECT_EQ(code({}), (Found{64, "white 65535 units in a reference interval, from the file's source 1"}));
}

TEST(AdderClip, TellsWhatIsWrongWithAFile) {
  const Scratch scratch;
  const File file;
  const std::string whole = file.header() + file.event(1, 1, 0, 4, 600) + file.event(1, 1, 0, 3, 900);
  EXPECT_EQ(notes_of(*open_test_clip(scratch.write("whole.adder", whole + file.end()))),
            "14 values have no event: they are black\n");
  const auto expect = [&](const std::string& content, const std::string& part) {
    expect_says(notes_of(*open_test_clip(scratch.write("a.adder", content))), part);
  };
  expect(whole, "the file has no end mark");
  expect(whole + "abc", "3 bytes at the end are no whole event: the file was cut off");
  expect(whole + file.event(5, 0, 0, 1, 9) + file.end(), "1 events lie outside the picture");
  expect(whole + file.event(1, 1, 0, 1, 800) + file.end(), "1 events end before the one before them");
  expect(whole + file.event(1, 1, 0, 60, 1800) + file.end(), "1 events are brighter than white");
}

TEST(AdderClip, RefusesTimesThatNobodyFilmed) {
  const Scratch scratch;
  const File file{0, 1, 1, 1, 1};
  std::string content = file.header();
  for (const unsigned d : {20u, 255u, 255u, 200u}) content += file.event(0, 0, 0, d, 0xFFFFFFFF);
  const auto path = scratch.write("long.adder", content);
  expect_error<InputError>([&] { open_test_clip(path); }, {"long.adder: its events last longer than 146 years"});
}

TEST(AdderClip, CountsMemoryBeforeItIsTaken) {
  const Scratch scratch;
  const File file{3, 1, 1};
  std::string content = file.header();
  for (unsigned t = 1; t <= 1000; ++t) content += file.event(0, 0, 0, t % 2 == 0 ? 128 : 0, t);
  const auto path = scratch.write("long.adder", content);
  ClipOptions options;
  const auto open_in = [&](std::uint64_t bytes) {
    options.decoder_bytes = bytes;
    return open_test_clip(path, options);
  };
  // Each event is a moment of its own; one pixel of 21 bytes.
  constexpr std::uint64_t kLeast = 1000 * (16 + 12 + 64) + 21;
  for (const std::uint64_t bytes : {std::uint64_t{1000}, kLeast - 1}) {
    expect_error<MemoryTooLittle>([&] { open_in(bytes); }, {"of memory is too little; at least"});
  }
  EXPECT_LE(open_in(kLeast)->info().decoder_bytes, kLeast);
}

TEST(AdderClip, RefusesWhatItCannotRead) {
  const Scratch scratch;
  const auto expect = [&](const std::string& content, const std::string& part) {
    const auto path = scratch.write("a.adder", content);
    expect_error<InputError>([&] { open_test_clip(path); }, {part});
  };
  File file;
  expect(file.header(), "holds no event");
  expect(file.header().substr(0, 30), "ends within its header");
  expect("adder", "ends within its header");
  file.version = 4;
  expect(file.header() + file.event(0, 0, 0, 1, 1),
         "versions 0 to 3 with 1 channel (9 bytes) or 3 (11 bytes) are read");
  file = {};
  file.channels = 2;
  expect(file.header(), "of 2 channels");
  file = {};
  file.interval = 0;
  expect(file.header(), "neither can be 0");
  const auto path = scratch.write("b.adder", File().header() + File().event(0, 0, 0, 1, 1));
  expect_error<UsageError>(
      [&] {
        open_test_clip(path, {.events = {.contrast = Contrast{0.2, 0.2}}});
      },
      {"tells light itself"});
}

}  // namespace
}  // namespace nutik::test

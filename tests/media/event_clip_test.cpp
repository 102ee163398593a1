// Recordings of event cameras: all formats give the events that were written, as light and as times; what is wrong with
// a file is told, or refused.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "media/events/event_clip.hpp"
#include "media/event_files.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

constexpr unsigned kWidth = 70, kHeight = 9;

// Some alone, some in runs side by side, from `start` on.
Events random_events(std::uint64_t seed, std::uint64_t start_us) {
  Random random(seed);
  Events events;
  std::uint64_t now = start_us;
  while (events.size() < 400) {
    now += static_cast<std::uint64_t>(random.chance(0.1) ? random.whole(0, 30'000) : random.whole(0, 3));
    const auto y = static_cast<unsigned>(random.whole(0, kHeight - 1));
    const bool up = random.chance(0.5);
    auto x = static_cast<unsigned>(random.whole(0, kWidth - 1));
    const std::int64_t run = random.chance(0.3) ? random.whole(2, 40) : 1;
    for (std::int64_t i = 0; i < run && x < kWidth; ++i, x += static_cast<unsigned>(random.whole(1, 3))) {
      events.push_back({now, x, y, up});
    }
  }
  return events;
}

std::uint16_t code_of_pixel(const std::vector<std::byte>& raster, std::size_t pixel) {
  std::uint16_t code = 0;
  std::memcpy(&code, raster.data() + 2 * pixel, sizeof code);
  return code;
}

// The clip holds these events, and nothing else: at each sample, the codes of all pixels, by their own count of steps.
void expect_events(Clip& clip, const Events& events, double up = 0.2, double down = 0.2) {
  const ClipInfo& info = clip.info();
  ASSERT_EQ(info.format.shape, (Shape{kWidth, kHeight, 1}));
  std::map<std::uint64_t, Events> by_time;
  for (const Event& event : events) by_time[event.us].push_back(event);
  ASSERT_EQ(info.sample_count, by_time.size());
  const auto rasters = read_all(clip);
  ASSERT_EQ(rasters.size(), by_time.size());
  std::vector<int> ups(kWidth * kHeight), downs(kWidth * kHeight);
  std::size_t k = 0;
  for (const auto& [us, changes] : by_time) {
    EXPECT_EQ(info.timing.exposures[k].start_ns, static_cast<std::int64_t>(us - events.front().us) * 1000);
    for (const Event& event : changes) ++(event.up ? ups : downs)[event.y * kWidth + event.x];
    for (std::size_t pixel = 0; pixel < ups.size(); ++pixel) {
      const double light = 0.18 * std::exp(up * ups[pixel] - down * downs[pixel]);
      // Half a code, and as much as sums of steps may be rounded differently.
      ASSERT_NEAR(code_of_pixel(rasters[k], pixel), std::min(light, 1.0) * 65535, 0.5 + 1e-6)
          << "sample " << k << ", pixel " << pixel;
    }
    ++k;
  }
  EXPECT_EQ(info.timing.exposures.back().end_ns,
            static_cast<std::int64_t>(events.back().us - events.front().us + 1) * 1000);
}

std::string raw(const std::string& format, const std::string& words) {
  return raw_header(format, kWidth, kHeight) + words;
}

TEST(EventClip, HoldsTheEventsOfEveryFormat) {
  const Scratch scratch;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Events events = random_events(seed, 1000 + 77'000'000 * seed);
    const std::map<std::string, std::string> files{
        {"2.raw", raw("EVT2", evt2_words(events))},
        {"21.raw", raw("EVT21;endianness=little", evt21_words(events, false))},
        {"21l.raw", raw("EVT21;endianness=legacy", evt21_words(events, true))},
        {"21n.raw", raw("EVT21", evt21_words(events, false))},
        {"21ln.raw", raw("EVT21", evt21_words(events, true))},
        {"3.raw", raw("EVT3", evt3_words(events))},
        {"a.dat", dat_file(events, kWidth, kHeight)}};
    for (const auto& [name, content] : files) {
      const auto clip = open_test_clip(scratch.write(name, content));
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      expect_events(*clip, events);
      if (HasFatalFailure()) return;
    }
  }
}

// A sample told by what changes is the sample that is read whole, from wherever a part of the clip begins.
TEST(EventClip, TellsWhatChanges) {
  const Scratch scratch;
  const auto path = scratch.write("a.dat", dat_file(random_events(5, 40), kWidth, kHeight));
  const ClipOptions part{.from = ClipMoment{30, true}, .to = ClipMoment{60, true}, .crop = Rectangle{3, 2, 50, 6}};
  for (const ClipOptions& options : {ClipOptions{}, part}) {
    const auto whole = open_test_clip(path, options), told = open_test_clip(path, options);
    ASSERT_TRUE(told->tells_changes());
    const auto rasters = read_all(*whole);
    std::vector<std::byte> held(told->info().format.sample_bytes());
    ASSERT_TRUE(told->read(held));
    for (std::size_t k = 1; k < rasters.size(); ++k) {
      const auto changes = told->read_changes();
      ASSERT_TRUE(changes.has_value());
      for (const PixelChange& change : *changes) std::memcpy(held.data() + 2 * change.pixel, change.codes.data(), 2);
      ASSERT_EQ(held, rasters[k]) << k;
    }
    EXPECT_FALSE(told->read_changes());
  }
}

TEST(EventClip, GoesOnWhereTheCamerasClockBeginsAgain) {
  const Scratch scratch;
  const auto shifted = [](std::uint64_t period) { return random_events(3, period - 5000); };
  auto clip = open_test_clip(scratch.write("2.raw", raw("EVT2", evt2_words(shifted(1ull << 34)))));
  expect_events(*clip, shifted(1ull << 34));
  clip = open_test_clip(scratch.write("3.raw", raw("EVT3", evt3_words(shifted(1ull << 24)))));
  expect_events(*clip, shifted(1ull << 24));
  clip = open_test_clip(scratch.write("a.dat", dat_file(shifted(1ull << 32), kWidth, kHeight)));
  expect_events(*clip, shifted(1ull << 32));
}

TEST(EventClip, TakesLightAsItIsStated) {
  const Scratch scratch;
  const Events events = random_events(1, 0);
  const auto path = scratch.write("a.dat", dat_file(events, kWidth, kHeight));
  ClipOptions options{.events = {.contrast = parse_contrast("0.31:0.17")}};
  expect_events(*open_test_clip(path, options), events, 0.31, 0.17);
  EXPECT_EQ(facts_of(*open_test_clip(path, options)).at(Setting::contrast).line(),
            "an event is 0.31 of log light up, 0.17 down, as stated");
  EXPECT_EQ(facts_of(*open_test_clip(path)).at(Setting::start_picture).line(), "light 0.18 at the start, assumed");

  options.events.start = parse_start_light("0.5");
  std::vector<std::byte> raster(2 * kWidth * kHeight);
  ASSERT_TRUE(open_test_clip(path, options)->read(raster));
  EXPECT_EQ(code_of_pixel(raster, kWidth * kHeight - 1), 32768);

  // A picture's, which is sRGB of 8 bits: code 188 is light 0.502887.
  std::string picture = "P5 70 9 255\n" + std::string(kWidth * kHeight, '\xbc');
  picture.back() = '\0';
  options.events.start = parse_start_light(scratch.write("start.pgm", picture).string());
  ASSERT_TRUE(open_test_clip(path, options)->read(raster));
  EXPECT_EQ(code_of_pixel(raster, kWidth * 5), 32957);
  // No light is half a code, so that steps lead on from it.
  EXPECT_EQ(code_of_pixel(raster, kWidth * kHeight - 1), 1);

  options.events.start = parse_start_light(scratch.write("small.pgm", "P5 2 1 255\nab").string());
  expect_error<InputError>([&] { open_test_clip(path, options); }, {"has 2 x 1 pixels, and the recording 70 x 9"});
}

TEST(EventClip, CountsChangesAtTheStartOfTheirTick) {
  const Scratch scratch;
  const Events events{{1000, 1, 1, true}, {1099, 2, 1, true}, {1100, 1, 1, true}, {1350, 3, 1, true}};
  const auto clip = open_test_clip(scratch.write("a.dat", dat_file(events, 8, 8)), {.events = {.tick_ns = 100'000}});
  const std::vector<Exposure> expected{{0, 100'000}, {100'000, 300'000}, {300'000, 351'000}};
  EXPECT_EQ(clip->info().timing.exposures, expected);
}

// Light above white is held at white in codes, and comes back as it went.
TEST(EventClip, KeepsLightAboveWhiteForTheWayBack) {
  const Scratch scratch;
  Events events;
  for (std::uint64_t k = 0; k < 30; ++k) events.push_back({k, 4, 4, k < 15});
  const auto clip = open_test_clip(scratch.write("a.dat", dat_file(events, 8, 8)));
  const auto rasters = read_all(*clip);
  EXPECT_EQ(code_of_pixel(rasters[14], 36), 65535);
  EXPECT_EQ(code_of_pixel(rasters[29], 36), std::lround(0.18 * 65535));
  ASSERT_EQ(clip->info().notes.size(), 1u);
  expect_says(clip->info().notes[0].text, "15 events up and 15 down, of 1 pixels, whose light ends at 1 times");
  expect_says(clip->info().notes[0].text, "1 pixels become brighter than white");
}

TEST(EventClip, TellsWhatIsWrongWithAFile) {
  const Scratch scratch;
  const auto expect_noted = [&](const char* name, const std::string& file, const std::string& part) {
    expect_says(notes_of(*open_test_clip(scratch.write(name, file))), part);
  };
  const Events events = random_events(8, 500'000);
  const std::string words = evt2_words(events);
  expect_noted("cut.raw", raw("EVT2", words + "ab"), "its last 2 bytes are left out");
  expect_noted("early.raw", raw("EVT2", little_endian(1 << 28, 4) + words), "1 events come before the first time");
  Events back = events;
  back[200].us -= 30;
  std::ranges::stable_sort(back.begin(), back.begin() + 200, {}, &Event::us);
  expect_noted("back.dat", dat_file(back, kWidth, kHeight), "events come after later ones, by up to");
  Events outside = events;
  outside[7].x = kWidth;
  expect_noted("outside.dat", dat_file(outside, kWidth, kHeight),
               "lie outside the sensor's 70 x 9 pixels (the file), the first at 70,");
  // Without a size in the header: by the sensor, else by the events.
  EXPECT_EQ(open_test_clip(scratch.write("gen.raw", "% plugin_name hal_plugin_gen41_evk3\n% evt 2.0\n" + words))
                ->info()
                .format.shape,
            (Shape{1280, 720, 1}));
  expect_noted("none.raw", "% evt 2.0\n" + words, "does not say how many pixels");
}

// A vector of EVT 3.0 advances the column on and on, also past 16 bits.
TEST(EventClip, LeavesOutVectorsThatRunPastTheSensor) {
  const Scratch scratch;
  const Events events = random_events(1, 0);
  std::string words = evt3_words(events);
  words += little_endian(0x3000, 2);
  for (int i = 0; i < 5462; ++i) words += little_endian(0x4000, 2);
  words += little_endian(0x4001, 2);
  const auto clip = open_test_clip(scratch.write("far.raw", raw("EVT3", words)));
  expect_events(*clip, events);
}

TEST(EventClip, RefusesWhatItCannotRead) {
  const Scratch scratch;
  const std::string words = evt2_words(random_events(2, 0));
  const auto expect = [&](const std::string& name, const std::string& content, const std::string& part) {
    const auto path = scratch.write(name, content);
    EXPECT_TRUE(is_event_recording(path));
    expect_error<InputError>([&] { open_test_clip(path); }, {part});
  };
  expect("narrow.raw", raw_header("EVT2", 8, 8) + words, "correct the size in its header");
  expect("empty.raw", raw_header("EVT3", 8, 8), "holds no event (EVT 3.0, 0 bytes after its header)");
  expect("4.raw", raw_header("EVT4", 8, 8) + words, "is in the format EVT4; EVT 2.0, 2.1 and 3.0 are read");
  std::string turns;  // of the clock, each of three steps
  for (int turn = 0; turn < 270'000; ++turn) {
    for (const std::uint64_t time : {0x0000000u, 0x6000000u, 0xC000000u}) turns += little_endian(8u << 28 | time, 4);
  }
  expect("turns.raw", raw_header("EVT2", 8, 8) + turns, "turns.raw's clock begins again so often that");
  expect("trigger.dat", "% Version 2\n\x0e\x08", "holds events of the type 14, of 8 bytes");
  expect("short.dat", "% Version 2\n\x0c", "ends within its header");
}

// A vector of EVT 3.0 has 12 events in 2 bytes, of which each takes 28 bytes and more.
TEST(EventClip, CountsMemoryBeforeItIsTaken) {
  const Scratch scratch;
  std::string words = little_endian(0x8000, 2);
  for (int i = 0; i < 1000; ++i) words += little_endian(0x3000, 2) + little_endian(0x4FFF, 2);
  const auto path = scratch.write("full.raw", raw_header("EVT3", 12, 1) + words);
  ClipOptions options;
  const auto open_in = [&](std::uint64_t bytes) {
    options.decoder_bytes = bytes;
    return open_test_clip(path, options);
  };
  // One sample of 64 bytes, 12 pixels of 21.
  constexpr std::uint64_t kLeast = 12'000 * (16 + 12) + 64 + 12 * 21;
  const std::string message = message_of<MemoryTooLittle>([&] { open_in(kLeast - 1); });
  expect_says(message,
              "of memory is too little; at least 0.3363 MB is needed: events as they are read "
              "0.192 MB, what changes with each moment 0.144 MB");
  EXPECT_LE(open_in(kLeast)->info().decoder_bytes, kLeast);
}

TEST(EventClip, RefusesWhatIsSaidOfPictures) {
  const Scratch scratch;
  const auto path = scratch.write("a.dat", dat_file(random_events(1, 0), kWidth, kHeight));
  ClipOptions options{.rate = Rational{100, 1}};
  expect_error<UsageError>([&] { open_test_clip(path, options); }, {"times of its own at every pixel"});
  options = {};
  options.white_code = 255;
  expect_error<UsageError>([&] { open_test_clip(path, options); }, {"holds events and no codes"});
  for (const char* text : {"", "0", "-0.2", "0.2:", "0.2:0", "11", "nan", "0.2,0.3"}) {
    EXPECT_THROW(static_cast<void>(parse_contrast(text)), UsageError) << text;
  }
  EXPECT_THROW(static_cast<void>(parse_start_light("0")), UsageError);
  EXPECT_THROW(static_cast<void>(parse_start_light("2")), UsageError);
  options = {};
  options.events.contrast = Contrast{0.2, 0.2};
  const auto picture = scratch.write("a.pgm", "P5 2 1 255\nab");
  expect_error<UsageError>([&] { open_test_clip(picture, options); }, {"holds pictures"});
}

}  // namespace
}  // namespace nutik::test

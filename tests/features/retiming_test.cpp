// A capture that is corrected is, but for what was corrected, the capture it was.
#include "features/captures/retiming.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/evened_times.hpp"
#include "session/clips/source_check.hpp"
#include "session/requests/source_request.hpp"
#include "support/messages.hpp"
#include "support/payloads.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"
#include "tik/reader.hpp"

namespace nutik::test {
namespace {

// Blocks as they lie in both files.
void expect_same_blocks(tik::Reader& before, tik::Reader& after) {
  ASSERT_EQ(before.block_count(), after.block_count());
  for (std::uint64_t block = 0; block < before.block_count(); ++block) {
    const auto a = before.stored(block), b = after.stored(block);
    EXPECT_EQ(a.header.first_sample, b.header.first_sample);
    EXPECT_EQ(a.header.record_count, b.header.record_count);
    EXPECT_TRUE(std::ranges::equal(a.payload, b.payload));
    EXPECT_EQ(payload_of(before, block), payload_of(after, block));
  }
  EXPECT_TRUE(std::ranges::equal(before.first_sample(), after.first_sample()));
}

TEST(Retiming, ChangesWhatWasStatedAndNothingElse) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const RandomCase random(seed);
    const Scratch scratch;
    const auto path = write_tik(random, {seed % 2 == 0 ? tik::CodecId::none : tik::CodecId::zstd, 0}, scratch);
    RetimeRequest request{path,          scratch / "after.tik", {}, {}, Transfer::linear(),
                          Primaries::p3, Rational{4, 3}};
    if (seed % 3 == 0) request.rate = Rational{30'000, 1001};
    const Retimed retimed = retime(request);
    tik::Reader before(path), after(request.output);
    expect_same_blocks(before, after);
    EXPECT_EQ(after.format().transfer, Transfer::linear());
    EXPECT_EQ(after.format().primaries, Primaries::p3);
    EXPECT_EQ(after.format().pixel_aspect, (Rational{4, 3}));
    EXPECT_EQ(after.timeline(), retimed.timeline);
    if (request.rate) {
      EXPECT_EQ(after.timeline().rate(), *request.rate);
      EXPECT_TRUE(after.timeline().is_constant());
    } else {
      EXPECT_EQ(after.timeline(), before.timeline());
    }
    CaptureFormat format = after.format();
    format.transfer = before.format().transfer;
    format.primaries = before.format().primaries;
    format.pixel_aspect = before.format().pixel_aspect;
    EXPECT_EQ(format, before.format());
  }
}

TEST(Retiming, GivesIrregularStartsAnotherAngle) {
  RandomCase random(1);
  for (std::uint64_t seed = 2; random.timeline.is_constant(); ++seed) random = RandomCase(seed);
  const Scratch scratch;
  const auto path = write_tik(random, {tik::CodecId::lz4, 0}, scratch);
  static_cast<void>(retime({path, path, {}, Rational{90, 1}, {}, {}, {}}));  // in place
  const tik::Reader after(path);
  const Timeline& before = random.timeline;
  ASSERT_EQ(after.timeline().sample_count(), before.sample_count());
  for (std::uint64_t k = 0; k + 1 < before.sample_count(); ++k) {
    EXPECT_EQ(after.timeline().start_ns(k), before.start_ns(k));
    const std::int64_t period = before.start_ns(k + 1) - before.start_ns(k);
    EXPECT_NEAR(static_cast<double>(after.timeline().end_ns(k) - before.start_ns(k)),
                static_cast<double>(period) / 4, 1);
  }
  EXPECT_EQ(after.header().facts, std::vector<std::string>{"shutter 90 degrees, as stated"});
}

TEST(Retiming, SaysWhichStepsItMakesEven) {
  RandomCase random(1);
  for (std::uint64_t seed = 2; random.timeline.sample_count() < 5; ++seed) random = RandomCase(seed);
  std::vector<std::int64_t> starts;
  for (std::uint64_t k = 0; k < random.timeline.sample_count(); ++k)
    starts.push_back(static_cast<std::int64_t>(k + (k > 1) + 2 * (k > 3)) * 10'000'000);
  random.timeline = Timeline::irregular(starts, {360, 1});
  const Scratch scratch;
  const auto path = write_tik(random, {tik::CodecId::lz4, 0}, scratch);
  EXPECT_TRUE(retime({path, scratch / "angle.tik", {}, Rational{90, 1}, {}, {}, {}}).notes.empty());
  const Retimed even = retime({path, path, Rational{100, 1}, {}, {}, {}, {}});
  ASSERT_EQ(even.notes.size(), 1u);
  EXPECT_EQ(even.notes[0].text, "2 of the clip's " + std::to_string(starts.size() - 1) +
                                    " steps from one picture to the next last 20 ms to 30 ms, and the others "
                                    "about 10 ms: at the stated "
                                    "rate all last alike");
  EXPECT_EQ(even.notes[0].settings, std::vector{Setting::frame_rate});
  EXPECT_TRUE(retime({path, path, Rational{50, 1}, {}, {}, {}, {}}).notes.empty()) << "it is even already";
}

TEST(GapNote, CountsStepsThatAreLongerByHalf) {
  const auto told = [](std::vector<std::int64_t> starts) {
    return gap_note(Timeline::irregular(std::move(starts), {180, 1}));
  };
  EXPECT_FALSE(told({0, 10'000'000, 24'900'000, 35'000'000, 45'000'000}));
  EXPECT_FALSE(told({0, 10'000'000, 12'000'000, 22'000'000}));
  EXPECT_FALSE(gap_note(Timeline::constant({100, 1}, {180, 1}, 9)));
  const auto one = told({0, 10'000'000, 25'000'000, 35'000'000, 45'000'000});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->text.find(
                "1 of the clip's 4 steps from one picture to the next is longer than the usual 10 ms, up to "
                "15 ms, as where pictures are missing: a picture before such a step counts as exposed for "
                "180 of 360 degrees of all of it;"),
            0U)
      << one->text;
}

TEST(EvenedTimes, CountForWhatClocksDoNotRound) {
  EXPECT_FALSE(evened_note({0, 10}));
  const auto rounded = evened_note({0, 33'000'000, 67'000'000, 100'000'000});
  ASSERT_TRUE(rounded);
  expect_says(rounded->text, "about 33 ms and differ by less than a tenth");
  const auto one = evened_note({0, 33'000'000, 67'000'000, 133'000'000, 167'000'000});
  expect_says(one->text, "1 of the clip's 4 steps from one picture to the next lasts 66 ms, and");
}

// A copy of a capture that tells these facts.
std::filesystem::path telling(const Scratch& scratch, const tik::Reader& plain,
                              std::vector<std::string> facts) {
  return write_saying(plain, scratch / "told.tik", [&](tik::Header& header) { header.facts = std::move(facts); });
}

// In its place; what one fact says beside another stays with it.
TEST(Retiming, ReplacesTheFactThatItCorrects) {
  const RandomCase random(3);
  const Scratch scratch;
  const tik::Reader plain(write_tik(random, {tik::CodecId::lz4, 0}, scratch));
  const auto told =
      telling(scratch, plain,
              {"240 pictures a second, from the file", "shutter 360 degrees, assumed",
               "primaries bt709, from the file; the file names no transfer",
               "transfer srgb, assumed; pictures are often so", "pictures 6 … 14 of 30, as stated",
               "a picture from each field, top field first, as stated", "square pixels, assumed",
               "80 x 45 as means of light, as stated"});
  static_cast<void>(retime({told, told, Rational{960, 1}, {}, Transfer::linear(), {}, Rational{4, 3}}));
  EXPECT_EQ(tik::Reader(told).header().facts,
            (std::vector<std::string>{"960 pictures a second, as stated", "shutter 360 degrees, assumed",
                                      "primaries bt709, from the file; the file names no transfer",
                                      "transfer linear, as stated", "pictures 6 … 14 of 30, as stated",
                                      "a picture from each field, top field first, as stated",
                                      "pixels 4:3, as stated", "80 x 45 as means of light, as stated"}));
}

// As encoding the clip again with that rate would have it.
TEST(Retiming, KeepsTheTimeThatACameraWroteDown) {
  RandomCase random(1);
  for (std::uint64_t seed = 2; !random.timeline.is_constant(); ++seed) random = RandomCase(seed);
  const Scratch scratch;
  const tik::Reader plain(write_tik(random, {tik::CodecId::lz4, 0}, scratch));
  const Timeline& before = plain.timeline();
  const std::int64_t exposed_ns = before.end_ns(0) - before.start_ns(0);
  const std::string from = ", from a.cih: " + std::to_string(exposed_ns) + " ns";
  const Rational half = Rational::of(before.rate().numerator, 2 * before.rate().denominator);
  for (const bool is_timed : {true, false}) {
    const auto told =
        telling(scratch, plain,
                {"shutter " + before.shutter_angle().text() + " degrees" + (is_timed ? from : ", assumed")});
    static_cast<void>(retime({told, told, half, {}, {}, {}, {}}));
    const tik::Reader after(told);
    EXPECT_NEAR(static_cast<double>(after.timeline().end_ns(0)),
                static_cast<double>(is_timed ? exposed_ns : 2 * exposed_ns),
                1.0 + 1e-6 * static_cast<double>(exposed_ns));
    ASSERT_EQ(after.header().facts.size(), 2u);
    EXPECT_EQ(after.header().facts[0], "shutter " + after.timeline().shutter_angle().text() + " degrees" +
                                           (is_timed ? from : ", assumed"));
  }
  const auto told = telling(scratch, plain, {"shutter " + before.shutter_angle().text() + " degrees" + from});
  const Rational fast = Rational::of(1'000'000'000, exposed_ns / 2);
  expect_error<InputError>(
      [&] {
        return retime({told, told, fast, {}, {}, {}, {}});
      },
      {"the shutter is said to have been open for"});
}

TEST(Retiming, RefusesWhatItCannotDo) {
  const RandomCase random(3);
  const Scratch scratch;
  const auto path = write_tik(random, {tik::CodecId::lz4, 0}, scratch);
  const auto message = [&](const RetimeRequest& request) { return message_of<Error>([&] { return retime(request); }); };
  expect_says(message({path, scratch / "a.tik", {}, {}, {}, {}, {}}), "what is to be corrected?");
  EXPECT_FALSE(std::filesystem::exists(scratch / "a.tik"));
  const RandomCase noisy = noisy_case(4);
  const auto held = write_tik(noisy, {tik::CodecId::lz4, 0}, scratch);
  const Transfer other = noisy.capture.transfer == Transfer::linear() ? Transfer::srgb() : Transfer::linear();
  expect_says(message({held, scratch / "a.tik", {}, {}, other, {}, {}}), "encode the clip again");
  EXPECT_EQ(message({held, scratch / "a.tik", Rational{7, 1}, {}, noisy.capture.transfer, {}, {}}), "");
}

// Interpolated light is a mean, too.
TEST(Retiming, KeepsTheTransferOfAlignedPictures) {
  tik::Header header;
  header.capture.transfer = Transfer::linear();
  const auto message = [&](const std::optional<Transfer>& stated) {
    return message_of<Error>([&] { check_stated_transfer(header, "x.tik", stated); });
  };
  EXPECT_EQ(message(Transfer::srgb()), "");
  header.alignment = tik::Alignment{"rigid", 0, false, 3, 0, 0.1};
  expect_says(message(Transfer::srgb()),
              "x.tik holds codes that are means of light by linear: pictures were moved "
              "by fractions of a pixel");
  EXPECT_EQ(message(Transfer::linear()), "");
  EXPECT_EQ(message(std::nullopt), "");
}

}  // namespace
}  // namespace nutik::test

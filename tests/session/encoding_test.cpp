// What is said of a clip whose pictures are not those that it announces.
#include "session/clips/clip_source.hpp"
#include "session/clips/encoding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "capture/error.hpp"
#include "session/clips/evened_times.hpp"
#include "session/made_clip.hpp"
#include "session/output_check.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

std::vector<std::string> warnings_of(std::uint64_t pictures, std::uint64_t announced) {
  const Scratch scratch;
  const EncodedCapture encoded =
      encode({.path = "clip"}, {scratch / "c.tik"}, MemoryBudget::of_machine(), {}, {},
             [&] { return std::make_unique<test::MadeClip>(pictures, announced); });
  EXPECT_EQ(encoded.timeline.sample_count(), pictures);
  return encoded.warnings;
}

// 12 steps of 1/240 s, 24 of 1/30, 12 of 1/240; dropped pictures leave single long steps.
TEST(Encoding, NamesTheRateOfAFilmThatPlaysSlowerInAPart) {
  const auto said = [](const std::vector<std::int64_t>& steps_ns) {
    std::vector<std::int64_t> starts{0};
    for (const std::int64_t step : steps_ns) starts.push_back(starts.back() + step);
    const auto note = gap_note(Timeline::irregular(starts, {360, 1}));
    return note ? note->text : std::string();
  };
  constexpr std::int64_t kShort = 4'166'667, kLong = 33'333'333;
  std::vector<std::int64_t> ramp(48, kShort), dropped(48, kShort);
  std::fill_n(ramp.begin() + 12, 24, kLong);
  for (const std::size_t k : {7u, 19u, 31u}) dropped[k] = 2 * kShort;
  EXPECT_EQ(
      said(ramp).find("24 of the clip's 48 steps from one picture to the next last 4.167 ms and 24 last 33.33 ms, "
                      "8 times as long"),
      0u)
      << said(ramp);
  expect_says(said(ramp), "state the rate, 240");
  expect_says(said(dropped), "longer than the usual");
  EXPECT_EQ(said(dropped).find('='), std::string::npos) << "a client's own names are its own";
}

TEST(Encoding, SaysThatPicturesAreMissing) {
  EXPECT_EQ(warnings_of(7, 10),
            std::vector<std::string>{
                "clip announces 10 pictures and 7 could be decoded: if some within are damaged, "
                "those after them have the times of others"});
}

TEST(Encoding, SaysThatThereAreMorePicturesThanAnnounced) {
  const auto warnings = warnings_of(7, 6);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("clip announces 6 pictures and 7 could be decoded: ")) << warnings[0];
}

TEST(Encoding, SaysNothingOfAClipThatIsWholeOrAnnouncesNothing) {
  EXPECT_EQ(warnings_of(7, 7), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(7, 0), std::vector<std::string>{});
}

// Clips that a program makes may say anything.
TEST(Encoding, RefusesAClipThatNoCaptureHolds) {
  const Scratch scratch;
  struct Odd final : test::MadeClip {
    explicit Odd(const std::function<void(ClipInfo&)>& change) : MadeClip(7, 7) { change(info_); }
  };
  const auto encoded = [&](const SourceRequest& source, const OpenClip& open) {
    return encode(source, {scratch / "c.tik"}, MemoryBudget::of_machine(), {}, {}, open);
  };
  const auto refused = [&](const std::function<void(ClipInfo&)>& change) {
    const auto open = [&] { return std::make_unique<Odd>(change); };
    return message_of<InputError>([&] { return encoded({.path = "x"}, open); });
  };
  EXPECT_EQ(refused([](ClipInfo& info) { info.format.shape.channels = 2; }), "x: a clip has 1 or 3 channels, not 2");
  EXPECT_EQ(refused([](ClipInfo& info) { info.format.shape.width = 0; }), "x: a clip has pixels, not 0 x 8 of them");
  EXPECT_EQ(refused([](ClipInfo& info) { info.format.code_bytes = 3; }),
            "x: a clip has codes of 1 or 2 bytes, not of 3");
  for (const std::uint32_t white : {0u, 256u}) {
    EXPECT_EQ(refused([=](ClipInfo& info) { info.format.white_code = white; }),
              "x: a clip whose codes end at 255 has a white code of 1 … 255, not " + std::to_string(white));
  }
  EXPECT_EQ(refused([](ClipInfo& info) { info.format.pixel_aspect = {1, 0}; }),
            "x: a clip has pixels of some width and height, not 1/0");
  for (const Rational rate : {Rational{0, 0}, Rational{30, 0}}) {
    EXPECT_EQ(refused([=](ClipInfo& info) { info.timing.rate = rate; }),
              "x: the rate in the file cannot be: frame rate " + rate.text() + " is not positive; state another");
  }
  EXPECT_EQ(message_of<UsageError>([&] { return encoded({.path = "x"}, [] { return nullptr; }); }),
            "'x': no clip was opened");
  EXPECT_THROW(static_cast<void>(encode(ClipSource{}, {scratch / "c.tik"}, ClipMemory{})), UsageError);

  const auto open = [] { return std::make_unique<test::MadeClip>(7, 7); };
  EXPECT_EQ(message_of<UsageError>([&] { return encoded({.path = "x", .shutter_angle = Rational{0, 0}}, open); }),
            "shutter angle 0/0 is outside 0 < angle <= 360 degrees");
  SourceRequest part{.path = "x"};
  part.clip.crop = Rectangle{0, 0, 1, 1};
  part.clip.to = ClipMoment{3, true};
  EXPECT_EQ(message_of<UsageError>([&] { return encoded(part, open); }),
            "x: to, crop can be stated of files alone, and its owner makes this clip");
}

// Also where encoding itself checks the name once more, which may replace captures.
TEST(Encoding, ReplacesNothingThatWasPutThereMeanwhile) {
  const Scratch scratch;
  struct Meddling final : test::MadeClip {
    explicit Meddling(const Scratch& scratch) : MadeClip(7, 7), scratch_(scratch) {}
    bool read(std::span<std::byte> raster) override {
      scratch_.write("c.tik", "precious");
      return MadeClip::read(raster);
    }
    const Scratch& scratch_;
  };
  check_output(scratch / "c.tik", OutputKind::tik, {}, Replacing::made_by_recipe);
  const auto open = [&] { return std::make_unique<Meddling>(scratch); };
  EXPECT_THROW(encode({.path = "clip"}, {scratch / "c.tik"}, MemoryBudget::of_machine(), {}, {}, open), OutputError);
  EXPECT_EQ(read_file(scratch / "c.tik"), "precious");
}

}  // namespace
}  // namespace nutik::test

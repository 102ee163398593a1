// What is said of a clip whose pictures are not those that it announces.
#include "session/clips/clip_source.hpp"
#include "session/clips/encoding.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

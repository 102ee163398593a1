// Sheets, their warnings, where videos go, and what changes in a capture: what applications share beside pictures.
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "session/activity.hpp"
#include "session/shared_warnings.hpp"
#include "session/sheet_making.hpp"
#include "session/video_output.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/still_clip.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(SharedWarnings, AreSaidOnceWhoeverAddsThem) {
  SharedWarnings warnings;
  const std::vector<std::string> said{"too dark"};
  warnings.add("first", said);
  constexpr int kEach = 500;
  const auto add_many = [&] {
    for (int k = 0; k < kEach; ++k) warnings.add("later", said);
  };
  { const std::jthread one(add_many), other(add_many); }
  warnings.add("last", std::vector<std::string>{"too bright"});
  EXPECT_EQ(warnings.lines(),
            (std::vector<std::string>{"last: too bright", "first and 1000 more: too dark"}));
}

TEST(VideoOutput, RefusesACodecForStillsAndHoldsTheSetting) {
  EXPECT_EQ(VideoOutput("v-%02d.png", {24, 1}, {}, {}).kind(), "stills");
  try {
    static_cast<void>(VideoOutput("v-%02d.png", {24, 1}, "ffv1", {}));
    FAIL() << "stills have no video codec";
  } catch (const UsageError& error) {
    EXPECT_EQ(error.settings(), std::vector{Setting::video_codec});
  }
}

// 12 stills of 16 x 16 pixels, 100 a second.
class ManyExposures : public ::testing::Test {
 protected:
  static Session session_of(const test::Scratch& scratch) {
    const auto modules = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path();
    setenv("NUTIK_MODULES", modules.c_str(), 0);
    test::write_still_clip(scratch.folder(), 16, 12);
    SourceRequest source;
    source.path = scratch / "frames";
    source.clip.rate = Rational{100, 1};
    ComputingRequest computing;
    computing.renderer = RendererKind::reference;
    return Session(source, computing);
  }

  test::Scratch scratch_;
  Session session_ = session_of(scratch_);
};

TEST_F(ManyExposures, OfASheetAreThoseOfTheSession) {
  SheetRequest request;
  request.heading = "two";
  request.mask = Mask::uniform(16, 16, 0);
  for (const std::int64_t start_ms : {0, 50}) {
    request.exposures.push_back(
        {"", {{0, GainFunction::boxcar(start_ms * kMillisecond, (start_ms + 30) * kMillisecond)}}});
  }
  std::vector<std::size_t> numbers;
  const Sheet sheet = make_sheet(session_, request, {}, [&](std::size_t i, const ExposedPicture& exposed) {
    numbers.push_back(i);
    const ExposedPicture alone =
        session_.render(request.exposures[i].functions, request.mask, request.plan, exposed.output);
    EXPECT_EQ(exposed.picture.bytes, alone.picture.bytes) << i;
    EXPECT_EQ(exposed.output.white_code, session_.format().white_code);
  });
  EXPECT_EQ(numbers, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(sheet.layout.columns * sheet.layout.rows, 2u);
  EXPECT_EQ(sheet.picture.shape.channels, 3u);
}

TEST_F(ManyExposures, ActivityCountsThePixelsOfAMask) {
  const MeasuredActivity all = measure_activity(session_.capture(), {});
  EXPECT_EQ(all.activity.pixel_count(), 256u);
  std::uint64_t changes = 0;
  for (std::uint64_t k = 0; k < 12; ++k) changes += all.activity.changed_pixels()[k];
  EXPECT_EQ(all.changes(), changes);
  EXPECT_GT(changes, 0u);
  EXPECT_DOUBLE_EQ(all.mean_share(), static_cast<double>(changes) / (256.0 * 11.0));

  std::string mask = "P5 16 16 255\n" + std::string(256, '\0');
  mask[mask.size() - 1] = 7;
  write_text(scratch_ / "mask.pgm", mask);
  ActivityRequest request;
  request.mask = (scratch_ / "mask.pgm").string();
  EXPECT_EQ(measure_activity(session_.capture(), request).activity.pixel_count(), 1u);
  request.tag = 8;
  EXPECT_EQ(
      test::message_of<InputError>([&] { static_cast<void>(measure_activity(session_.capture(), request)); }),
      *request.mask + " has no pixel with tag 8");
}

}  // namespace
}  // namespace nutik

// Series, warnings of many pictures, where videos go, and what changes in a capture: what applications share beside
// pictures.
#include <gtest/gtest.h>

#include <thread>

#include "features/activity/activity.hpp"
#include "features/film/film_making.hpp"
#include "features/series/series_making.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/writers/picture_writer.hpp"
#include "media/writers/recipe.hpp"
#include "session/text/shared_warnings.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/still_clip.hpp"
#include "system/output_file.hpp"

namespace nutik::test {
namespace {

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

TEST(SharedWarnings, AreOneWhateverTheirFiguresAre) {
  SharedWarnings warnings;
  for (const char* said : {"M0: still gain -0.5", "M0: still gain -1.25e-05", "M1: still gain -3", "M1: gain 3",
                           "3 of 9 values", "4 of 9 values", "clip_1.tif: odd", "clip_2.tif: odd"})
    warnings.add("a", std::vector<std::string>{said});
  EXPECT_EQ(warnings.lines(), (std::vector<std::string>{
                                  "a and 1 more: 3 of 9 values", "a and 1 more: M0: still gain -0.5", "a: M1: gain 3",
                                  "a: M1: still gain -3", "a: clip_1.tif: odd", "a: clip_2.tif: odd"}));
}

TEST(VideoOutput, RefusesACodecForStillsAndHoldsTheSetting) {
  EXPECT_EQ(VideoOutput("v-%02d.png", {24, 1}, {}, {}).kind(), "stills");
  const auto error = error_of<UsageError>([] { VideoOutput("v-%02d.png", {24, 1}, "ffv1", {}); });
  ASSERT_TRUE(error) << "stills have no video codec";
  EXPECT_EQ(error->settings(), std::vector{Setting::video_codec});
}

// 12 stills of 16 x 16 pixels, 100 a second.
class ManyExposures : public ::testing::Test {
 protected:
  static Session session_of(const Scratch& scratch) {
    use_modules();
    write_still_clip(scratch.folder(), 16, 12);
    ComputingRequest computing;
    computing.renderer = RendererKind::reference;
    return Session({.path = scratch / "frames", .clip = {.rate = Rational{100, 1}}}, computing);
  }

  Scratch scratch_;
  Session session_ = session_of(scratch_);
};

// The file that holds this picture, byte by byte.
std::string file_of(const Scratch& scratch, const Picture& picture) {
  const auto path = scratch / "alone.png";
  write_picture(path, picture);
  return read_file(path);
}

ExposureRequest thirty_milliseconds() {
  ExposureRequest request;
  request.gains = PlainInterval{StatedTime::parse("30ms", "length"), Shutter()};
  return request;
}

TEST_F(ManyExposures, OfASeriesAreThoseOfTheSession) {
  std::vector<SeriesPicture> pictures;
  for (const char* start : {"0ms", "10ms", "60ms"}) {
    pictures.push_back(
        {StatedTime::parse(start, "start"), scratch_ / ("s" + std::to_string(pictures.size()) + ".png")});
  }
  std::vector<Picture> exposed;
  make_series(session_, thirty_milliseconds(), pictures, output_format({}, session_.format()), {}, {},
              [&](std::uint64_t, ExposedPicture& one) {
                exposed.push_back(one.picture);
                return std::string();
              });
  ASSERT_EQ(exposed.size(), pictures.size());
  for (std::size_t k = 0; k < exposed.size(); ++k) {
    ExposureRequest request = thirty_milliseconds();
    request.start = pictures[k].start;
    const Picture alone = session_.render(request, output_format({}, session_.format())).picture;
    EXPECT_EQ(exposed[k].bytes, alone.bytes) << k;
    EXPECT_EQ(read_file(pictures[k].path), file_of(scratch_, alone)) << k;
  }
}

TEST_F(ManyExposures, OfASeriesEndAtAPictureThatCannotBeWritten) {
  const std::vector<SeriesPicture> pictures(
      1000, {StatedTime::parse("0ms", "start"), scratch_ / "no/such/folder/s.png"});
  std::uint64_t exposed = 0;
  EXPECT_THROW(
      make_series(session_, thirty_milliseconds(), pictures, output_format({}, session_.format()), {}, {},
                  [&](std::uint64_t, ExposedPicture&) {
                    ++exposed;
                    return std::string();
                  }),
      OutputError);
  EXPECT_LT(exposed, pictures.size());
}

TEST_F(ManyExposures, OfAVideoAreThoseOfTheSession) {
  FramesRequest request;
  request.exposure.gains = PlainInterval();
  request.rate = {25, 1};
  const VideoOutput output(scratch_ / "v-%02d.png", request.rate, {}, {});
  const Frames frames = frames_of(request, session_.timeline());
  ASSERT_EQ(frames.count, 3u);  // of 120 ms
  std::vector<Exposure> times;
  const MadeVideo made = make_video(session_, request, frames, output, {},
                                    [&](std::uint64_t, const Exposure& exposure, const ExposedPicture&) {
                                      times.push_back(exposure);
                                      return std::string();
                                    });
  EXPECT_EQ(made.frames, frames.count);
  EXPECT_FALSE(made.interruption);
  ASSERT_EQ(times.size(), frames.count);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const ExposedPicture alone =
        session_.render(functions_of(request.exposure, times[k], session_.timeline()),
                        Mask::uniform(16, 16, 0), {}, output.frame_format(session_.format()));
    EXPECT_EQ(read_file(scratch_ / ("v-0" + std::to_string(k) + ".png")), file_of(scratch_, alone.picture)) << k;
  }
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
  EXPECT_EQ(message_of<InputError>([&] { return measure_activity(session_.capture(), request); }),
            std::get<std::string>(request.mask) + " has no pixel with tag 8");
}

}  // namespace
}  // namespace nutik::test

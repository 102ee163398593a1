// Interlaced video: refused with the way out, or deinterlaced as FFmpeg's own command does it.
#include <gtest/gtest.h>

#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kFrameShape{64, 48, 1};
constexpr int kFrames = 8;

// Each frame has the odd lines of one of 50 pictures a second, and the even lines of the next. `first` is t or b.
void make_interlaced(const Scratch& scratch, char first, const std::string& codec, const std::string& name) {
  const std::string mode = first == 't' ? "interleave_top" : "interleave_bottom";
  const std::string words = "-f lavfi -i testsrc2=size=64x48:rate=50 -frames:v " + std::to_string(kFrames) +
                            " -vf format=gray,tinterlace=" + mode + ",setfield=" + first +
                            "ff,format=gray,fps=25 " + codec + " " + name;
  test::make(scratch, words);
}

class InterlacedVideo : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::vector<std::byte>> read(const std::string& name, Interlaced wish) const {
    return read_all(*open_test_clip(scratch_ / name, {.interlaced = wish}));
  }
  // What ffmpeg's command makes of it.
  [[nodiscard]] std::string by_ffmpeg(const std::string& name, const std::string& filter) const {
    test::make(scratch_, "-i " + name + " " + filter + " -f rawvideo -pix_fmt gray out.raw");
    return read_file(scratch_ / "out.raw");
  }
  Scratch scratch_;
};

std::string joined(const std::vector<std::vector<std::byte>>& rasters) {
  std::string bytes;
  for (const auto& raster : rasters)
    bytes.append(reinterpret_cast<const char*>(raster.data()), raster.size());
  return bytes;
}

TEST_F(InterlacedVideo, IsRefusedWithTheWayOut) {
  NEEDS_FFMPEG();
  const std::vector<std::tuple<char, std::string, std::string, std::string>> clips{
      {'t', "-c:v ffv1", "t.mkv", "t.mkv is interlaced, top field first"},
      {'b', "-c:v ffv1", "b.mkv", "b.mkv is interlaced, bottom field first"},
      {'t', "-f yuv4mpegpipe -pix_fmt gray", "t.y4m", "t.y4m is interlaced, top field first"},
      {'t', "-c:v mpeg2video -flags +ilme+ildct -pix_fmt yuv420p -q:v 2", "t.mpg",
       "is interlaced, top field first"},
      {'b', "-c:v libx264 -flags +ilme+ildct -x264opts bff=1 -pix_fmt yuv420p", "b.mp4",
       "is interlaced, bottom field first"}};
  for (const auto& [first, codec, name, part] : clips) {
    SCOPED_TRACE(name);
    make_interlaced(scratch_, first, codec, name);
    const auto error = error_of<InputError>([&] { read_all(*open_test_clip(scratch_ / name)); });
    ASSERT_TRUE(error) << "it was read";
    // Each way out in the word that states it.
    for (const std::string& word : std::vector<std::string>{part, "'frames'", "'fields'", "'no'"})
      EXPECT_NE(std::string(error->what()).find(word), std::string::npos) << error->what();
    EXPECT_EQ(error->settings(), std::vector{Setting::deinterlace});
  }
}

TEST_F(InterlacedVideo, IsTakenAsItIsWhereThatIsAsked) {
  NEEDS_FFMPEG();
  make_interlaced(scratch_, 't', "-c:v ffv1", "t.mkv");
  EXPECT_EQ(joined(read("t.mkv", Interlaced::ignored)), by_ffmpeg("t.mkv", ""));
  const auto clip = open_test_clip(scratch_ / "t.mkv", {.interlaced = Interlaced::ignored});
  EXPECT_EQ(facts_of(*clip).at(Setting::deinterlace).line(), "interlaced frames as they are, as stated");
}

TEST_F(InterlacedVideo, BecomesWhatFfmpegMakesOfIt) {
  NEEDS_FFMPEG();
  for (const char first : {'t', 'b'}) {
    SCOPED_TRACE(first);
    make_interlaced(scratch_, first, "-c:v ffv1", "a.mkv");
    const std::string frames = joined(read("a.mkv", Interlaced::frames)),
                      fields = joined(read("a.mkv", Interlaced::fields));
    EXPECT_EQ(frames.size(), kFrameShape.pixel_count() * kFrames);
    EXPECT_EQ(fields.size(), kFrameShape.pixel_count() * kFrames * 2);
    EXPECT_TRUE(frames == by_ffmpeg("a.mkv", "-vf bwdif=mode=send_frame"));
    EXPECT_TRUE(fields == by_ffmpeg("a.mkv", "-vf bwdif=mode=send_field"));
    // Frames as they are combs.
    EXPECT_FALSE(frames == joined(read("a.mkv", Interlaced::ignored)));
  }
}

// What is asked for may not be what the clip says of itself, in its container or picture by picture.
TEST_F(InterlacedVideo, IsSaidWhereWhatIsAskedDoesNotFit) {
  NEEDS_FFMPEG();
  make_interlaced(scratch_, 't', "-c:v ffv1", "told.mkv");
  make_interlaced(scratch_, 't', "-c:v mpeg4 -flags +ilme+ildct -pix_fmt yuv420p", "by-picture.avi");
  test::make(scratch_, "-i by-picture.avi -c copy -field_order progressive else-told.mkv");
  const std::string still = "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 4 ";
  test::make(scratch_, still + "-vf setfield=prog -c:v ffv1 whole-told.mkv");
  test::make(scratch_, still + "-c:v mjpeg -pix_fmt yuvj420p whole.avi");
  const auto said = [&](const std::string& name, Interlaced wish) {
    const auto clip = open_test_clip(scratch_ / name, {.interlaced = wish});
    read_all(*clip);
    std::string all;
    for (const Note& note : clip->info().notes) all += note.text + "\n";
    for (const Note& remark : clip->remarks()) all += remark.text + "\n";
    return all;
  };
  for (const char* name : {"told.mkv", "by-picture.avi", "else-told.mkv"}) {
    EXPECT_NE(said(name, Interlaced::ignored)
                  .find("says that it is interlaced, and its frames are taken as they are"),
              std::string::npos)
        << name;
    EXPECT_EQ(said(name, Interlaced::fields), "") << name;
    EXPECT_EQ(said(name, Interlaced::frames), "") << name;
  }
  for (const char* name : {"whole-told.mkv", "whole.avi"}) {
    EXPECT_NE(said(name, Interlaced::fields)
                  .find("nothing in the clip says that it is interlaced, and two pictures are made of each "
                        "all the same"),
              std::string::npos)
        << name << said(name, Interlaced::fields);
    EXPECT_NE(
        said(name, Interlaced::frames)
            .find("nothing in the clip says that it is interlaced, and each picture is made of one field"),
        std::string::npos)
        << name;
    EXPECT_EQ(said(name, Interlaced::ignored), "") << name;
    EXPECT_EQ(said(name, Interlaced::refused), "") << name;
  }
}

// Pictures without a header tell nothing, and the clip that has their camera's header beside it says so, too.
TEST_F(InterlacedVideo, IsSaidOfPicturesWithoutAHeader) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 2 -pix_fmt gray -f rawvideo whole.bytes");
  const auto clip =
      open_test_clip(scratch_ / "whole.bytes", {.raw = RawVideo{64, 48, "gray"}, .interlaced = Interlaced::frames});
  read_all(*clip);
  ASSERT_EQ(clip->remarks().size(), 1u);
  EXPECT_TRUE(clip->remarks()[0].text.starts_with("nothing in the clip says that it is interlaced"));
}

TEST_F(InterlacedVideo, OfFieldsRunsTwiceAsFast) {
  NEEDS_FFMPEG();
  make_interlaced(scratch_, 't', "-c:v ffv1", "t.mkv");
  for (const auto& [wish, rate, count] :
       {std::tuple(Interlaced::frames, 25, kFrames), std::tuple(Interlaced::fields, 50, 2 * kFrames)}) {
    const ClipOptions options{.interlaced = wish};
    const auto clip = open_test_clip(scratch_ / "t.mkv", options);
    EXPECT_EQ(clip->info().sample_count, static_cast<std::uint64_t>(count));
    EXPECT_EQ(timeline_of("", clip->info(), options, clip->info().sample_count).rate(), (Rational{rate, 1}));
    expect_says(clip->info().facts.back().text, "top field first");
  }
  test::make(scratch_, "-f lavfi -i testsrc2=s=64x48:r=50:d=0.4 -vf interlace=scan=bff:lowpass=off -c:v libx264 "
                       "-flags +ilme+ildct other.mp4");
  const auto other = open_test_clip(scratch_ / "other.mp4", {.interlaced = Interlaced::fields});
  read_all(*other);
  EXPECT_EQ(other->remarks().at(0).text.find("the container says top field first, and 10 frames say the other"), 0u);
  // Where a file only says so, nothing is lost: nothing moves, and every picture is every other.
  test::make(scratch_,
             "-f lavfi -i color=c=0x808080:size=64x48:rate=25 -frames:v 3 -vf format=gray,setfield=tff "
             "-c:v ffv1 still.mkv");
  const auto still = read("still.mkv", Interlaced::fields);
  ASSERT_EQ(still.size(), 6u);
  for (const auto& raster : still) EXPECT_TRUE(raster == read("still.mkv", Interlaced::ignored)[0]);
}

TEST_F(InterlacedVideo, OfSixteenBitsAndColourIsDeinterlaced) {
  NEEDS_FFMPEG();
  for (const auto& [pixels, bytes] :
       {std::pair("gray16le", 2u), std::pair("yuv422p10le", 6u), std::pair("gbrp", 3u)}) {
    SCOPED_TRACE(pixels);
    test::make(scratch_, std::string("-f lavfi -i testsrc2=size=64x48:rate=25 -frames:v 3 -vf format=") +
                             pixels + ",setfield=tff -c:v ffv1 -level 3 a.mkv");
    const auto rasters = read("a.mkv", Interlaced::frames);
    ASSERT_EQ(rasters.size(), 3u);
    EXPECT_EQ(rasters[0].size(), kFrameShape.pixel_count() * bytes);
  }
}

}  // namespace
}  // namespace nutik::test

// What the program says of a clip's times: one thing, and whatever becomes of them.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"

namespace nutik::test {
namespace {

class Times : public AppTest {
 protected:
  // Two seconds at 30 pictures a second without those of these numbers.
  void make_uneven(const std::string& left_out, const std::string& words) const {
    test::make(scratch_, "-f lavfi -i testsrc2=s=32x32:d=2:r=30 -vf \"select='not(" + left_out +
                             ")'\" -fps_mode vfr -c:v mpeg4 -movflags use_metadata_tags " + words + " clip.mp4");
  }

  // What is said on standard error of a clip that is encoded.
  [[nodiscard]] std::string said(const Words& words) const {
    return make("encode --overwrite" + words + "-o clip.tik").err;
  }
};

TEST_F(Times, ThatAStatedRateMakesEvenAreSaid) {
  NEEDS_FFMPEG();
  make_uneven("eq(n,5)+eq(n,12)+eq(n,13)", "-metadata com.android.capture.fps=240");
  const std::string evened = "steps from one picture to the next last";
  EXPECT_EQ(said("-f 240 clip.mp4"),
            "note: 2 of the clip's 56 steps from one picture to the next last 8.333 ms to 12.5 ms, and the "
            "others about "
            "4.167 ms: at the stated rate all last alike (--fps)\n")
      << "what the file says of its rate is settled";
  EXPECT_EQ(said("clip.mp4").find(evened), std::string::npos);
  expect_says(run("retime --in-place clip.tik -f 240").err, "note: 2 of the clip's 56 steps");
  EXPECT_EQ(run("retime --in-place clip.tik -f 120").err, "") << "they are even now";
}

// A file that says how fast it was filmed, rightly or not, is not told to be one that does not.
TEST_F(Times, HaveOneNoteOnTheirRate) {
  NEEDS_FFMPEG();
  const auto said_of = [&](const std::string& stated) {
    test::make(scratch_, "-f lavfi -i testsrc2=s=32x32:d=1:r=15 -c:v mpeg4 -movflags use_metadata_tags " +
                             stated + " clip.mp4");
    return said("clip.mp4");
  };
  const std::string usual = "slow-motion files state their playback rate";
  expect_says(said_of(""), usual);
  EXPECT_EQ(said_of("-metadata com.android.capture.fps=15"), "");
  for (const char* rate : {"60", "37", "fast"}) {
    const std::string notes = said_of("-metadata com.android.capture.fps=" + std::string(rate));
    EXPECT_EQ(notes.find(usual), std::string::npos) << notes;
    EXPECT_EQ(notes.find("--fps"), notes.rfind("--fps")) << notes;
    expect_says(notes, "--fps");
  }
}

// What is exposed before a gap is not known from times alone, and what is taken is said.
TEST_F(Times, WithGapsAreSaid) {
  NEEDS_FFMPEG();
  make_uneven("eq(n,5)+eq(n,12)+eq(n,13)", "");
  const std::string note =
      "steps from one picture to the next are longer than the usual 33.33 ms, up to 100 ms, as where "
      "pictures are missing: a picture before such a step counts as exposed for ";
  expect_says(said("clip.mp4"), "2 of the clip's 56 " + note + "360 of 360 degrees");
  expect_says(said("-a 90 clip.mp4"), note + "90 of 360 degrees");
  EXPECT_EQ(said("-f 30 clip.mp4").find(note), std::string::npos);
  for (const char* name : {"a.pgm", "b.pgm", "c.pgm", "d.pgm"})
    scratch_.write(name, "P5\n2 2\n255\n" + std::string(4, name[0]));
  scratch_.write("listed.csv", "a.pgm,0,1000\nb.pgm,2000,1000\nc.pgm,9000,1000\nd.pgm,11000,1000\n");
  EXPECT_EQ(said("listed.csv").find("longer than the usual"), std::string::npos);
}

TEST_F(Times, OfATableThatAStatedRateMakesEvenAreSaid) {
  for (const char* name : {"a.pgm", "b.pgm", "c.pgm", "d.pgm"})
    scratch_.write(name, "P5\n2 2\n255\n" + std::string(4, name[0]));
  scratch_.write("stills.csv", "a.pgm,0,1000\nb.pgm,2000,1000\nc.pgm,9000,1000\nd.pgm,11000,1000\n");
  EXPECT_EQ(said("-f 100 stills.csv"),
            "note: 1 of the clip's 3 steps from one picture to the next lasts 7 us, and the others about 2 "
            "us: at the "
            "stated rate all last alike (--fps)\n");
}

}  // namespace
}  // namespace nutik::test

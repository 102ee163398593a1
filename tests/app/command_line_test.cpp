// The command line as a user meets it: exit status, message, what is left behind.
#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>

#include "support/program_test.hpp"

namespace nutik {
namespace {

using test::ProgramResult;
using test::Scratch;

// A clip of 6 pictures of 16 × 16 pixels, and its capture, in each test's folder.
class CommandLine : public test::ProgramTest {
 protected:
  void SetUp() override {
    cv::VideoWriter writer((scratch_ / "clip.avi").string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25,
                           {16, 16});
    ASSERT_TRUE(writer.isOpened());
    for (int k = 0; k < 6; ++k) writer.write(cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(40 * k)));
    writer.release();
    ASSERT_EQ(run({"clip.avi", "clip.tik"}).status, 0);
    scratch_.write("one.fn", "M0 [0:1], [40000000:1], [40000001:0]\n");
    scratch_.write("two.fn", "M0 [0:1], [1:0]\nM9 [0:1], [1:0]\n");
    std::string mask = "P2 16 16 255\n";
    for (int i = 0; i < 256; ++i) mask += i < 100 ? "9 " : "0 ";
    scratch_.write("mask.pgm", mask);
  }

  [[nodiscard]] bool exists(std::string_view name) const { return std::filesystem::exists(scratch_ / name); }
};

TEST_F(CommandLine, TakesThePapersForms) {
  EXPECT_EQ(run({"-f120", "-a180", "clip.avi", "a.tik"}).status, 0);
  EXPECT_EQ(run({"-f960", "-a200", "-ob.tik", "clip.avi"}).status, 0);
  EXPECT_EQ(run({"-mmask.pgm", "-ktwo.fn", "a.tik"}).status, 0);
  EXPECT_TRUE(exists("a-two.png"));
  EXPECT_EQ(run({"-m./mask.pgm", "-k./two.fn", "b.tik"}).status, 0);
  EXPECT_TRUE(exists("b-two.png"));
}

TEST_F(CommandLine, NamesWhatWasMeant) {
  expect_refused({"encod", "clip.avi", "x.tik"}, 2,
                 "there is no file and no command 'encod'; did you mean encode?");
  expect_refused({"frobnicate"}, 2, "there is no file and no command 'frobnicate'");
  expect_refused({"-f", "25", "--fps", "30", "clip.avi", "x.tik"}, 2, "-f is given twice");
  expect_refused({"mask", "--base", "mask.pgm", "--base", "mask.pgm", "clip.tik"}, 2,
                 "--base is given twice");
  expect_refused({"mask", "clip.tik", "--changed-between", "0.1s"}, 2,
                 "--changed-between needs more words: --changed-between TIME TIME");
  expect_refused({"--start", "0s", "--exposure", "1f", "-o", "", "clip.tik"}, 2,
                 "the output's name is empty");
  ASSERT_EQ(test::run_shell("mkfifo pipe", scratch_.folder()).status, 0);
  expect_refused({"pipe", "x.tik"}, 3, "pipe is no regular file");
}

TEST_F(CommandLine, SaysTheNameThatNobodyGave) {
  EXPECT_EQ(run({"-q", "-k", "one.fn", "clip.tik"}).out, "clip-one.png\n");
  EXPECT_EQ(run({"-q", "-k", "one.fn", "clip.tik", "named.png"}).out, "");
  EXPECT_EQ(run({"encode", "-q", "--overwrite", "clip.avi"}).out, "clip.tik\n");
}

TEST_F(CommandLine, ReportsHowAnExposureWasComputed) {
  const ProgramResult result = run({"-v", "--start", "0s", "--exposure", "3f", "clip.tik", "out.png"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find(", still gain 1,"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("1 block of "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" MB on the device"), std::string::npos) << result.out;
}

TEST_F(CommandLine, SaysWhatACaptureHolds) {
  const ProgramResult info = run({"info", "clip.tik", "--activity", "map.png"});
  EXPECT_EQ(info.status, 0) << info.err;
  for (const char* part : {"16 x 16 colour, 8 bits, white code 255, transfer srgb", "6 in 1 block",
                           "25 samples a second, shutter 360 degrees", "5.00 records a pixel",
                           "100.0 % dense", "map.png: black never changes, white 5 times",
                           "try: nutik-cl --start 3f --exposure 1f clip.tik picture.png"}) {
    EXPECT_NE(info.out.find(part), std::string::npos) << part << " is not in\n" << info.out;
  }
  EXPECT_TRUE(exists("map.png"));
  EXPECT_EQ(run({"clip.tik"}).out, run({"info", "clip.tik"}).out);
  expect_refused({"info", "clip.tik", "--activity", "clip.tik"}, 2, "is also an input");
  expect_refused({"info", "clip.tik", "--activity", "map.txt"}, 2, ".png");
  expect_refused({"info", "clip.tik", "--activity", "map.pfm"}, 2, "map.pfm holds floating point only");
}

TEST_F(CommandLine, TakesOptionsAndOperandsInAnyOrder) {
  EXPECT_EQ(run({"clip.tik", "-k", "one.fn", "first.png"}).status, 0);
  EXPECT_EQ(run({"-k", "one.fn", "clip.tik", "second.png"}).status, 0);
  EXPECT_EQ(run({"-o", "third.png", "clip.tik", "--functions=one.fn"}).status, 0);
  EXPECT_EQ(run({"expose", "clip.tik", "-qo", "fourth.png", "-kone.fn"}).status, 0);
  EXPECT_EQ(run({"clip.tik", "fifth.png", "expose", "-k", "one.fn"}).status, 2);  // no command any more
  const std::string first = test::read_file(scratch_ / "first.png");
  for (const char* other : {"second.png", "third.png", "fourth.png"}) {
    EXPECT_EQ(test::read_file(scratch_ / other), first) << other;
  }
}

TEST_F(CommandLine, OnlyTheFirstWordCanBeACommand) {
  std::filesystem::copy_file(scratch_ / "clip.avi", scratch_ / "encode");
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "info");
  EXPECT_EQ(run({"./encode", "x.tik"}).status, 0);
  EXPECT_EQ(run({"--", "encode", "y.tik"}).status, 0);
  EXPECT_EQ(run({"encode", "encode", "z.tik"}).status, 0);
  EXPECT_EQ(run({"-k", "one.fn", "./info", "out.png"}).status, 0);
  EXPECT_EQ(run({"info", "info"}).status, 0);
  EXPECT_TRUE(exists("x.tik") && exists("y.tik") && exists("z.tik"));
}

TEST_F(CommandLine, TellsValuesFromOptionsAndOperands) {
  EXPECT_EQ(run({"--ev", "-1", "-qk", "one.fn", "clip.tik", "a.png"}).status, 0);
  EXPECT_EQ(run({"-vqkone.fn", "--ev=-1", "clip.tik", "b.png"}).status, 0);
  EXPECT_EQ(run({"-q", "-q", "--ev", "-1", "-k", "one.fn", "--", "clip.tik", "-c.png"}).status, 0);
  EXPECT_EQ(test::read_file(scratch_ / "a.png"), test::read_file(scratch_ / "b.png"));
  EXPECT_TRUE(exists("-c.png"));
  EXPECT_EQ(run({"mask", "--threshold=0f", "40..90", "clip.tik", "m.pgm"}).status, 0);
  expect_refused({"--gain=", "-k", "one.fn", "clip.tik"}, 2, "--gain  is no number");
  expect_refused({"--quiet=yes", "-k", "one.fn", "clip.tik"}, 2, "-q takes no value");
  expect_refused({"-qx", "clip.tik"}, 2, "there is no option -x");
  expect_refused({"study", "--bogus", "clip.tik"}, 2, "there is no option --bogus; see nutik-cl study --help");
  expect_refused({"mask", "--threshold=0f"}, 2,
                 "--threshold needs more words: --threshold PICTURE LOW..HIGH");
  expect_refused({"-ko", "clip.tik"}, 3, "o cannot be read");
  // What only an exposure takes means one; what others take too does not.
  expect_refused({"--gain", "2", "clip.tik", "d.png"}, 2, "an exposure needs a plain interval");
  expect_refused({"--renderer", "opencl", "clip.avi", "d.tik"}, 2, "--renderer does not go with encode");
  EXPECT_EQ(run({"--transfer", "linear", "clip.avi", "d.tik"}).status, 0);
}

TEST_F(CommandLine, NamesTheOutputWhereNoneIsGiven) {
  const ProgramResult result = run({"-k", "one.fn", "clip.tik"});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("clip-one.png:"), std::string::npos) << result.out;
  EXPECT_EQ(run({"--start", "1/100s", "--exposure", "10ms", "clip.tik"}).status, 0);
  EXPECT_TRUE(exists("clip-1_100s-10ms.png"));
}

TEST_F(CommandLine, ShowsInfoForACaptureAlone) {
  EXPECT_EQ(run({"--json", "clip.tik"}).out, run({"info", "--json", "clip.tik"}).out);
  EXPECT_EQ(run({"--activity", "map.png", "clip.tik"}).status, 0);
  EXPECT_TRUE(exists("map.png"));
  const ProgramResult result = run({"clip.tik"});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("16 x 16 colour, 8 bits, white code 255, transfer srgb"), std::string::npos);
  EXPECT_NE(result.out.find("6 in 1 block"), std::string::npos) << result.out;
  const auto suggestion = result.out.find("try: nutik-cl ");
  ASSERT_NE(suggestion, std::string::npos);
  EXPECT_NE(result.out.find("--start 3f --exposure 1f clip.tik picture.png", suggestion), std::string::npos);
  EXPECT_EQ(run({"--start", "3f", "--exposure", "1f", "clip.tik", "picture.png"}).status, 0);
}

TEST_F(CommandLine, RefusesWhatMakesNoSense) {
  expect_refused({}, 2, "say what to do: nutik-cl clip.mp4 clip.tik");
  expect_refused({"clip.avi"}, 2, "the output is missing: nutik-cl clip.avi clip.tik");
  expect_refused({"-m", "mask.pgm", "clip.tik"}, 2, "nutik-cl -m mask.pgm -k functions.fn clip.tik");
  expect_refused({"-k", "two.fn", "clip.tik"}, 2, "two.fn holds 2 functions; a mask says where each applies");
  expect_refused({"-k", "one.fn", "clip.tik", "a.png", "-o", "b.png"}, 2, "two outputs: -o b.png and a.png");
  expect_refused({"-k", "one.fn", "clip.tik", "a.png", "b.png"}, 2, "'b.png' is one file too many");
  expect_refused({"-k", "one.fn", "--start", "0s", "--exposure", "1ms", "clip.tik"}, 2, "use one");
  expect_refused({"--start", "0s", "clip.tik"}, 2, "Add --exposure 10ms");
  expect_refused({"--exposure", "10", "clip.tik"}, 2, "--exposure '10' is no time; write a number and a unit");
  expect_refused({"--exposure", "1f", "--start", "9f", "clip.tik"}, 2,
                 "picture 9 is outside the capture, which has 6");
  expect_refused({"--exposure", "1ms", "--start", "9s", "clip.tik"}, 2,
                 "lies outside the capture, which lasts 240 ms");
  expect_refused({"--fsp", "3", "clip.avi", "x.tik"}, 2, "there is no option --fsp; did you mean --fps?");
  expect_refused({"--tolerance", "1", "-k", "one.fn", "clip.tik"}, 2, "--tolerance describes a clip");
  expect_refused({"devices", "-m", "mask.pgm"}, 2, "-m does not go with devices; it is an option of: expose");
  expect_refused({"-f", "fast", "clip.avi", "x.tik"}, 2, "--fps 'fast' is not a number");
  expect_refused({"-a", "400", "clip.avi", "x.tik"}, 2, "shutter angle 400 is outside 0 < angle <= 360");
  expect_refused({"--depth", "12", "-k", "one.fn", "clip.tik"}, 2,
                 "depth '12' is not known; choose 8, 16, half or float");
  expect_refused({"--renderer", "cuda", "-k", "one.fn", "clip.tik"}, 2, "choose opencl or reference");
  expect_refused({"--unmapped", "black", "-k", "one.fn", "clip.tik"}, 2,
                 "the only choice is --unmapped zero");
  expect_refused({"-k"}, 2, "-k needs a value: -k FILE.fn");
}

TEST_F(CommandLine, SaysWhatIsWrongWithInput) {
  expect_refused({"absent.mp4", "x.tik"}, 3, "absent.mp4 cannot be read: no such file");
  expect_refused({"one.fn", "x.tik"}, 3, "one.fn is a text, and no clip");
  expect_refused({"-k", "absent.fn", "clip.tik"}, 3, "absent.fn cannot be read: No such file");
  expect_refused({"-k", "one.fn", "-m", "mask.pgm", "clip.tik"}, 3,
                 "mask values without a function: 9 (100 pixels)");
  EXPECT_EQ(run({"-k", "one.fn", "-m", "mask.pgm", "--unmapped", "zero", "clip.tik"}).status, 0);
  scratch_.write("bad.fn", "M0 [0:1], [5:1], [5:0]\n");
  expect_refused({"-k", "bad.fn", "clip.tik"}, 3, "bad.fn:1:19: time 5 stands twice");
  expect_refused({"--device", "no such", "-k", "one.fn", "clip.tik"}, 4, "these were found:\n  0  ");
  EXPECT_FALSE(exists("x.tik"));
}

TEST_F(CommandLine, ReplacesOnlyItsOwnKind) {
  expect_refused({"clip.tik", "clip.avi"}, 2, "clip.tik is a capture already");
  expect_refused({"x.tik", "clip.avi"}, 2, "clip.avi is no name for a capture");
  expect_refused({"-k", "one.fn", "clip.tik", "-o", "clip.tik"}, 2, "is also an input");
  expect_refused({"-k", "one.fn", "clip.tik", "-o", "./one.fn"}, 2, "is also an input");
  scratch_.write("notes.png", "my notes");
  expect_refused({"-k", "one.fn", "clip.tik", "-o", "notes.png"}, 2, "notes.png exists and is no picture");
  EXPECT_EQ(test::read_file(scratch_ / "notes.png"), "my notes");
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "capture.ppm");
  expect_refused({"-k", "one.fn", "clip.tik", "-o", "capture.ppm"}, 2, "exists and is no picture");
  std::filesystem::create_directory(scratch_ / "folder.tik");
  expect_refused({"clip.avi", "folder.tik"}, 2, "is a folder");
  expect_refused({"-k", "one.fn", "clip.tik", "-o", "absent/x.png"}, 5, "cannot be created: No such file");
  // Of its own kind what carries a recipe is replaced, the rest only if asked.
  EXPECT_EQ(run({"-k", "one.fn", "clip.tik", "a.png"}).status, 0);
  EXPECT_EQ(run({"-k", "one.fn", "clip.tik", "a.png"}).status, 0);
  expect_refused({"clip.avi", "clip.tik"}, 2,
                 "clip.tik is there already and is not replaced; choose another name, or replace it with --overwrite");
  EXPECT_EQ(run({"--overwrite", "clip.avi", "clip.tik"}).status, 0);
}

TEST_F(CommandLine, IsQuietWhereAsked) {
  const ProgramResult result = run({"-q", "-k", "one.fn", "clip.tik", "a.png"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(CommandLine, SaysWhereRateAndAngleComeFrom) {
  const ProgramResult from_file = run({"clip.avi", "a.tik"});
  EXPECT_NE(from_file.out.find("25 pictures a second (from the file), shutter 360 degrees (assumed)"),
            std::string::npos)
      << from_file.out;
  EXPECT_NE(from_file.err.find("if it was filmed faster, say so (--fps)"), std::string::npos);
  const ProgramResult stated = run({"-f", "30000/1001", "-a", "172.8", "--overwrite", "clip.avi", "a.tik"});
  EXPECT_NE(stated.out.find("30000/1001 pictures a second (--fps), shutter 172.8 degrees (--shutter-angle)"),
            std::string::npos)
      << stated.out;
  EXPECT_EQ(stated.err, "");
}

TEST_F(CommandLine, HasHelpForEverything) {
  EXPECT_NE(run({"--help"}).out.find("nutik-cl clip.mp4 clip.tik"), std::string::npos);
  EXPECT_EQ(run({"--version"}).out.rfind("nutik-cl ", 0), 0u);
  for (const char* command :
       {"encode", "expose", "info", "devices", "recover", "mask", "contact", "activity", "sweep"}) {
    const ProgramResult result = run({command, "--help"});
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos) << command;
    std::size_t start = 0;
    while (start < result.out.size()) {
      const auto end = result.out.find('\n', start);
      EXPECT_LE(end - start, 104u) << result.out.substr(start, end - start);  // 100 columns and some UTF-8
      start = end + 1;
    }
  }
}

TEST_F(CommandLine, RecoversACutOffCapture) {
  const std::string bytes = test::read_file(scratch_ / "clip.tik");
  scratch_.write("cut.tik", std::string_view(bytes).substr(0, bytes.size() - 10));
  expect_refused({"cut.tik"}, 3, "nutik-cl recover cut.tik -o recovered.tik");
  const ProgramResult result = run({"recover", "cut.tik", "-o", "whole.tik"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("6 samples in 1 block were saved"), std::string::npos) << result.out;
  EXPECT_EQ(run({"-k", "one.fn", "whole.tik", "a.png", "--no-recipe"}).status, 0);
  EXPECT_EQ(run({"-k", "one.fn", "clip.tik", "b.png", "--no-recipe"}).status, 0);
  EXPECT_EQ(test::read_file(scratch_ / "a.png"), test::read_file(scratch_ / "b.png"));
}

}  // namespace
}  // namespace nutik

// Nothing that a command reads is replaced by what it writes, and nobody else's file either.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "capture/text.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/app_test.hpp"

namespace nutik::test {
namespace {

class Outputs : public AppTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < 4; ++k) {
      const cv::Mat picture(120, 160, CV_8UC1, cv::Scalar::all(40 * k));
      cv::imwrite((scratch_ / ("frames/" + std::to_string(k) + ".png")).string(), picture);
    }
  }
};

TEST_F(Outputs, ReplaceNoStillOfTheClip) {
  const std::string still = read_file(scratch_ / "frames/1.png");
  for (const std::string words :
       {"expose --exposure 1f -o frames/1.png", "contact -o frames/1.png", "mask --moving -o frames/1.png",
        "sweep --start 0s --exposure 1f --shift 0f..2f/1f -o frames/1.png",
        "trace --pixel 1,1 --start 0s --exposure 1f -o frames/1.png", "activity -o frames/1.png",
        "activity --map frames/1.png -o chart.png"}) {
    expect_refused(words + " -f 100 frames", 2, "the output frames/1.png is also an input");
    EXPECT_TRUE(read_file(scratch_ / "frames/1.png") == still) << words;
  }
}

TEST_F(Outputs, ReplaceWhateverTheyWriteIfAsked) {
  std::string extensions = picture_extensions();
  extensions.replace(extensions.find(" or "), 4, ", ");
  for (const std::string& part : parts_of(extensions, ' ')) {
    const std::string extension = part.substr(0, part.find(','));
    if (extension == ".ppm") continue;  // of colour
    for (int i = 0; i < 2; ++i)
      make("expose --start 0s --exposure 1f --no-recipe --overwrite -f 100 frames picture" + extension);
  }
}

// A command replaces nothing that was there before but a picture with a recipe, unless it is asked to.
TEST_F(Outputs, ReplaceWhatIsThereOnlyIfAsked) {
  make("-f 100 --block-samples 2 frames clip.tik");
  const std::string capture = read_file(scratch_ / "clip.tik");
  scratch_.write("cut.tik", capture.substr(0, capture.size() - 10));
  for (const std::string part : {"0", "2"}) {
    const std::string end = part == "0" ? "2f" : "4f";
    make({"encode", "-f", "100", "--block-samples", "2", "--from", part + "f", "--to", end, "frames",
          part + ".tik"});
  }
  scratch_.write("named.fn", "M0 [0:a], [20000000:a], [20000001:0]");
  struct Case {
    std::vector<std::string> words;
    std::string file;  // that it writes, of its own kind
    bool has_recipe = false;
  };
  const std::vector<Case> cases{
      {{"encode", "-f", "100", "frames", "o.tik"}, "o.tik"},
      {{"recover", "cut.tik", "o.tik"}, "o.tik"},
      {{"join", "0.tik", "2.tik", "-o", "o.tik"}, "o.tik"},
      {{"retime", "-f", "50", "clip.tik", "o.tik"}, "o.tik"},
      {{"expose", "--exposure", "1f", "clip.tik", "a.png"}, "a.png", true},
      {{"expose", "--exposure", "1f", "--no-recipe", "clip.tik", "b.png"}, "b.png"},
      {{"expose", "--exposure", "1f", "--every", "2f", "--no-recipe", "clip.tik", "s-%d.pfm"}, "s-0.pfm"},
      {{"contact", "clip.tik", "c.png"}, "c.png", true},
      {{"sweep", "--start", "0s", "--exposure", "1f", "--shift", "0f..2f/1f", "clip.tik", "w.png"}, "w.png", true},
      {{"video", "--out-fps", "50", "clip.tik", "v.mkv"}, "v.mkv"},
      {{"video", "--out-fps", "50", "--no-recipe", "clip.tik", "v-%d.png"}, "v-0.png"},
      {{"mask", "--fill", "clip.tik", "m.pgm"}, "m.pgm"},
      {{"background", "clip.tik", "p.png"}, "p.png"},
      {{"activity", "--csv", "t.csv", "clip.tik"}, "t.csv"},
      {{"activity", "clip.tik", "g.png"}, "g.png"},
      {{"info", "--activity", "i.png", "clip.tik"}, "i.png"},
      {{"thumbnail", "clip.tik", "n.png"}, "n.png"},
      {{"trace", "--pixel", "1,1", "--exposure", "2f", "clip.tik", "x.png"}, "x.png"},
      {{"solve", "-k", "named.fn", "--wish", "all = 0.1", "clip.tik", "o.fn"}, "o.fn"}};
  for (const auto& [words, file, has_recipe] : cases) {
    SCOPED_TRACE(words.front() + " " + file);
    const auto first = make(over(words));
    const std::string made = read_file(scratch_ / file);
    std::filesystem::last_write_time(scratch_ / file, std::filesystem::file_time_type());
    const auto time = [&] { return std::filesystem::last_write_time(scratch_ / file); };
    const auto second = make(words, has_recipe ? 0 : 2);
    EXPECT_EQ(time() == std::filesystem::file_time_type(), !has_recipe);
    if (!has_recipe) {
      EXPECT_EQ(second.err, "nutik-cl: " + file + " is there already and is not replaced; choose another name, or "
                                                  "replace it with --overwrite\n");
    }
    make(over(words));
    EXPECT_NE(time(), std::filesystem::file_time_type());
    EXPECT_EQ(read_file(scratch_ / file).size(), made.size());
    // An empty file, as mktemp makes, holds nothing.
    scratch_.write(file, "");
    make(words, std::string("s-0.pfm v-0.png").find(file) == std::string::npos ? 0 : 2);
  }
}

// What a second program gets through a pipe is the file, byte for byte, and nothing else.
TEST_F(Outputs, GoToStandardOutput) {
  const std::string program = NUTIK_TEST_PROGRAM;
  const std::string expose =
      " expose --overwrite -f 100 --start 1f --exposure 2f frames --no-recipe --renderer reference";
  const std::vector<std::pair<std::string, std::string>> kinds{{"-", "a.png"},     {"png:-", "a.png"},
                                                               {"TIF:-", "a.tif"}, {"jpg:-", "a.jpg"},
                                                               {"exr:-", "a.exr"}, {"pfm:-", "a.pfm"}};
  for (const auto& [name, file] : kinds) {
    SCOPED_TRACE(name);
    expect_says(shell(program + expose + " -o " + name + " | cat > piped").err,
                name + ": 160 x 120 grey, 2 of 4 samples");
    expect_says(shell(program + expose + " -o " + file).out, file + ": 160 x 120 grey, 2 of 4 samples");
    const std::string wanted = read_file(scratch_ / file);
    EXPECT_GT(wanted.size(), 100u);
    EXPECT_TRUE(read_file(scratch_ / "piped") == wanted);
  }
  // The mask of a pipe, and the sheet.
  const auto mask = shell(program + " mask -f 100 frames --fill -o pgm:- | head -c 2");
  EXPECT_EQ(mask.out, "P5") << mask.err;
  const auto sheet = shell(program + " contact -f 100 frames -o jpg:- | head -c 3");
  EXPECT_EQ(sheet.out, "\xFF\xD8\xFF") << sheet.err;
}

TEST_F(Outputs, ATerminalTakesNoPicture) {
  if (!has_pseudo_terminals()) GTEST_SKIP() << "there is no pseudo terminal here, or no `script`";
  const std::string expose = NUTIK_TEST_PROGRAM " expose -f 100 --exposure 1f frames -o -";
  expect_says(shell("script -qec '" + expose + "' /dev/null", 2).out, "which is a terminal");
}

TEST_F(Outputs, ThatStandardOutputCannotTakeAreRefused) {
  const auto refused = [&](const Words& words, const std::string& part) {
    expect_refused(words + "-f 100 frames", 2, part);
  };
  refused({"expose", "--exposure", "1f", "--json", "-o", "-"}, "--json answers on standard output");
  refused({"expose", "--exposure", "1f", "-o", "gif:-"}, "gif:-: pictures are written as .png, .tif, .jpg");
  refused({"encode", "-o", "-"}, "- is no name for a capture");
  refused({"video", "-o", "-"}, "a video is written to a file");
  scratch_.write("list.txt", "--exposure 1f -o -\n");
  expect_says(run("batch -f 100 list.txt frames").err, "standard output takes one picture");
  // Nothing stays in the temporary folder.
  std::filesystem::create_directory(scratch_ / "tmp");
  const std::string expose = NUTIK_TEST_PROGRAM " expose -f 100 --exposure 1f frames -o -";
  shell("TMPDIR=tmp " + expose);
  EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "tmp"));
  expect_says(shell("TMPDIR=absent " + expose, 5).err, "there is no folder absent for temporary files");
}

// The temporary capture's name cannot be foreseen, and what somebody put in its place is not written to.
TEST_F(Outputs, AreNotLedAstrayInATemporaryFolder) {
  std::filesystem::create_directory(scratch_ / "tmp");
  scratch_.write("victim", "precious");
  const auto result = run_shell("ln -s ../victim tmp/nutik-$$.tik; TMPDIR=tmp exec " NUTIK_TEST_PROGRAM
                                " contact --renderer reference -f 100 frames sheet.png",
                                scratch_.folder());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(read_file(scratch_ / "victim"), "precious");
  const std::filesystem::directory_iterator files(scratch_ / "tmp");
  EXPECT_EQ(std::distance(files, std::filesystem::directory_iterator()), 1);  // the link
}

}  // namespace
}  // namespace nutik::test

// Nothing that a command reads is replaced by what it writes, and nobody else's file either.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/app_test.hpp"

namespace nutik {
namespace {

class Outputs : public test::AppTest {
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
  const std::string still = test::read_file(scratch_ / "frames/1.png");
  const std::vector<std::vector<std::string>> commands{
      {"expose", "--exposure", "1f"},
      {"contact"},
      {"mask", "--moving"},
      {"sweep", "--start", "0s", "--exposure", "1f", "--shift", "0f..2f/1f"},
      {"trace", "--pixel", "1,1", "--start", "0s", "--exposure", "1f"},
      {"activity"},
      {"activity", "--map", "frames/1.png"}};
  for (test::Words words : commands) {
    words.insert(words.end(), {"-f", "100", "frames", "-o"});
    words.emplace_back(words[1] == "--map" ? "chart.png" : "frames/1.png");
    const auto result = test::run_here(words, scratch_.folder());
    EXPECT_EQ(result.status, 2) << words.front();
    expect_says(result.err, "the output frames/1.png is also an input");
    EXPECT_TRUE(test::read_file(scratch_ / "frames/1.png") == still) << words.front();
  }
}

// A command replaces nothing that was there before but a picture with a recipe, unless it is asked to.
TEST_F(Outputs, ReplaceWhatIsThereOnlyIfAsked) {
  const auto run = [&](const test::Words& words) { return test::run_here(words, scratch_.folder()); };
  make("-f 100 --block-samples 2 frames clip.tik");
  const std::string capture = test::read_file(scratch_ / "clip.tik");
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
    const auto first = make(test::over(words));
    const std::string made = test::read_file(scratch_ / file);
    std::filesystem::last_write_time(scratch_ / file, std::filesystem::file_time_type());
    const auto time = [&] { return std::filesystem::last_write_time(scratch_ / file); };
    const auto second = run(words);
    EXPECT_EQ(second.status, has_recipe ? 0 : 2) << second.err;
    EXPECT_EQ(time() == std::filesystem::file_time_type(), !has_recipe);
    if (!has_recipe) {
      EXPECT_EQ(second.err, "nutik-cl: " + file + " is there already and is not replaced; choose another name, or "
                                                  "replace it with --overwrite\n");
    }
    make(test::over(words));
    EXPECT_NE(time(), std::filesystem::file_time_type());
    EXPECT_EQ(test::read_file(scratch_ / file).size(), made.size());
    // An empty file, as mktemp makes, holds nothing.
    scratch_.write(file, "");
    EXPECT_EQ(run(words).status, std::string("s-0.pfm v-0.png").find(file) == std::string::npos ? 0 : 2);
  }
}

// What a second program gets through a pipe is the file, byte for byte, and nothing else.
TEST_F(Outputs, GoToStandardOutput) {
  const std::string program = NUTIK_TEST_PROGRAM;
  // In a group, whose last command has no other input than the pipe's.
  const auto shell = [&](const std::string& command) {
    return test::run_shell("( " + command + " )", scratch_.folder());
  };
  const std::string expose =
      " expose --overwrite -f 100 --start 1f --exposure 2f frames --no-recipe --renderer reference";
  const std::vector<std::pair<std::string, std::string>> kinds{{"-", "a.png"},     {"png:-", "a.png"},
                                                               {"TIF:-", "a.tif"}, {"jpg:-", "a.jpg"},
                                                               {"exr:-", "a.exr"}, {"pfm:-", "a.pfm"}};
  for (const auto& [name, file] : kinds) {
    SCOPED_TRACE(name);
    const auto piped = shell(program + expose + " -o " + name + " | cat > piped");
    EXPECT_EQ(piped.status, 0);
    EXPECT_NE(piped.err.find(name + ": 160 x 120 grey, 2 of 4 samples"), std::string::npos) << piped.err;
    const auto named = shell(program + expose + " -o " + file);
    EXPECT_EQ(named.status, 0) << named.err;
    EXPECT_NE(named.out.find(file + ": 160 x 120 grey, 2 of 4 samples"), std::string::npos) << named.out;
    const std::string wanted = test::read_file(scratch_ / file);
    EXPECT_GT(wanted.size(), 100u);
    EXPECT_TRUE(test::read_file(scratch_ / "piped") == wanted);
  }
  // The mask of a pipe, and the sheet.
  const auto mask = shell(program + " mask -f 100 frames --fill -o pgm:- | head -c 2");
  EXPECT_EQ(mask.out, "P5") << mask.err;
  const auto sheet = shell(program + " contact -f 100 frames -o jpg:- | head -c 3");
  EXPECT_EQ(sheet.out, "\xFF\xD8\xFF") << sheet.err;
}

TEST_F(Outputs, ATerminalTakesNoPicture) {
  if (!test::has_pseudo_terminals()) GTEST_SKIP() << "there is no pseudo terminal here, or no `script`";
  const auto terminal = test::run_shell("script -qec '" NUTIK_TEST_PROGRAM
                                        " expose -f 100 --exposure 1f frames -o -' /dev/null",
                                        scratch_.folder());
  EXPECT_EQ(terminal.status, 2);
  expect_says(terminal.out, "which is a terminal");
}

TEST_F(Outputs, ThatStandardOutputCannotTakeAreRefused) {
  const auto refused = [&](const test::Words& words, const std::string& part) {
    std::vector<std::string> all{words};
    all.insert(all.end(), {"-f", "100", "frames"});
    const auto result = test::run_here(all, scratch_.folder());
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  };
  refused({"expose", "--exposure", "1f", "--json", "-o", "-"}, "--json answers on standard output");
  refused({"expose", "--exposure", "1f", "-o", "gif:-"}, "gif:-: pictures are written as .png, .tif, .jpg");
  refused({"encode", "-o", "-"}, "- is no name for a capture");
  refused({"video", "-o", "-"}, "a video is written to a file");
  scratch_.write("list.txt", "--exposure 1f -o -\n");
  const auto batch = test::run_here({"batch", "-f", "100", "list.txt", "frames"}, scratch_.folder());
  expect_says(batch.err, "standard output takes one picture");
  // Nothing stays in the temporary folder.
  std::filesystem::create_directory(scratch_ / "tmp");
  const auto full = test::run_program({"expose", "-f", "100", "--exposure", "1f", "frames", "-o", "-"},
                                      scratch_.folder(), {"TMPDIR=tmp"});
  EXPECT_EQ(full.status, 0) << full.err;
  EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "tmp"));
  const auto nowhere = test::run_program({"expose", "-f", "100", "--exposure", "1f", "frames", "-o", "-"},
                                         scratch_.folder(), {"TMPDIR=absent"});
  EXPECT_EQ(nowhere.status, 5);
  expect_says(nowhere.err, "there is no folder absent for temporary files");
}

// The temporary capture's name cannot be foreseen, and what somebody put in its place is not written to.
TEST_F(Outputs, AreNotLedAstrayInATemporaryFolder) {
  std::filesystem::create_directory(scratch_ / "tmp");
  scratch_.write("victim", "precious");
  const auto result =
      test::run_shell(std::string("ln -s ../victim tmp/nutik-$$.tik; TMPDIR=tmp exec ") + NUTIK_TEST_PROGRAM +
                          " contact --renderer reference -f 100 frames sheet.png",
                      scratch_.folder());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(test::read_file(scratch_ / "victim"), "precious");
  const std::filesystem::directory_iterator files(scratch_ / "tmp");
  EXPECT_EQ(std::distance(files, std::filesystem::directory_iterator()), 1);  // the link
}

}  // namespace
}  // namespace nutik

// What people do without thinking: pipes, mistyped words, scripts that read what the program says.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::ProgramResult;

class Habits : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < 3; ++k) {
      scratch_.write("frames/" + std::to_string(k) + ".pgm",
                     "P2 2 1 255\n" + std::to_string(40 * k) + " 200\n");
    }
    scratch_.write("one.fn", "M0 [0:1], [40000000:1], [40000001:0]\n");
    scratch_.write("two.fn", "M0 [0:1], [40000000:1], [40000001:0]\nM9 [0:2], [40000000:2], [40000001:0]\n");
    scratch_.write("mask.pgm", "P2 2 1 255\n0 9\n");
    ASSERT_EQ(run({"-f", "25", "frames", "clip.tik"}).status, 0);
  }

  ProgramResult run(const std::vector<std::string>& words,
                    const std::vector<std::string>& environment = {}) const {
    return test::run_program(words, scratch_.folder(), environment);
  }
  ProgramResult piped(const std::string& file, const std::string& words) const {
    return test::run_shell("(cat " + file + " | '" NUTIK_TEST_PROGRAM "' " + words + ")", scratch_.folder());
  }
  void expect_refused(const std::vector<std::string>& words, int status, std::string_view part) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << "no '" << part << "' in: " << result.err;
  }
  [[nodiscard]] std::string file(const char* name) const { return test::read_file(scratch_ / name); }
  nlohmann::json json(std::vector<std::string> words, int status = 0) const {
    words.emplace_back("--json");
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, status) << result.err;
    return nlohmann::json::parse(result.out);
  }

  test::Scratch scratch_;
};

TEST_F(Habits, SaysThatStandardOutputIsFull) {
  for (const char* words : {"--help", "clip.tik", "clip.tik --json",
                            "trace --start 0s --exposure 1f --pixel 0,0 clip.tik", "completion bash"}) {
    const ProgramResult result = test::run_shell(
        std::string("('" NUTIK_TEST_PROGRAM "' ") + words + " > /dev/full)", scratch_.folder());
    EXPECT_EQ(result.status, 5) << words;
    EXPECT_EQ(result.err, "nutik-cl: standard output cannot be written\n") << words;
  }
}

TEST_F(Habits, ReadsFunctionsAndMasksFromStandardInput) {
  const std::vector<std::string> plain{"--no-recipe", "-m", "mask.pgm", "-k", "two.fn", "clip.tik", "a.png"};
  ASSERT_EQ(run(plain).status, 0);
  ProgramResult result = piped("two.fn", "--no-recipe -m mask.pgm -k - clip.tik b.png");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(file("a.png"), file("b.png"));
  result = piped("mask.pgm", "--no-recipe -m - -k two.fn clip.tik c.png");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(file("a.png"), file("c.png"));
  EXPECT_EQ(piped("one.fn", "-q -k - clip.tik").out, "clip-standard-input.png\n");
  EXPECT_EQ(piped("two.fn", "check -k - -m mask.pgm clip.tik").status, 0);
  EXPECT_EQ(piped("mask.pgm", "activity -m - clip.tik").status, 0);
  EXPECT_EQ(piped("mask.pgm", "mask --base - --invert -o d.pgm").status, 2);  // nothing to invert
  // The recipe has the functions' text.
  ASSERT_EQ(piped("one.fn", "-k - clip.tik e.png").status, 0);
  EXPECT_NE(run({"again", "e.png"}).out.find("-k e-again/standard-input.fn"), std::string::npos);
}

TEST_F(Habits, NamesStandardInput) {
  expect_refused({"-k", "-", "-m", "-", "clip.tik"}, 2, "-k - and -m - would both read standard input");
  expect_refused({"-k", "-", "clip.tik"}, 3, "standard input is empty");
  scratch_.write("bad.fn", "M0 [0:1], [5:1], [5:0]\n");
  EXPECT_NE(piped("bad.fn", "-k - clip.tik").err.find("standard input:1:19: time 5 stands twice"),
            std::string::npos);
  EXPECT_NE(piped("bad.fn", "check -k -").out.find("standard input:1:19"), std::string::npos);
  EXPECT_NE(piped("one.fn", "-m - -k two.fn clip.tik").err.find("standard input is neither a PGM nor a PNG"),
            std::string::npos);
  scratch_.write("list.txt", "-k - a.png\n");
  EXPECT_NE(piped("list.txt", "batch - clip.tik").err.find("standard input holds the list already"),
            std::string::npos);
}

TEST_F(Habits, SuggestsWhatWasMeant) {
  expect_refused({"--expo", "10ms", "clip.tik"}, 2, "there is no option --expo; did you mean --exposure?");
  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"encode", "--exposur", "1s", "c.mp4"}, "there is no option --exposur; see nutik-cl encode --help"},
           {{"-ss", "1", "clip.tik", "a.png"}, "there is no option -ss; see nutik-cl --help"},
           {{"-vX", "clip.tik", "a.png"}, "there is no option -X; see nutik-cl --help"},
           {{"video", "--quality", "50", "clip.tik", "a.mkv"},
            "a quality is one of .jpg pictures, and a.mkv is none; leave it out (--quality)"}}) {
    expect_refused(words, 2, said);
  }
  expect_refused({"shutter", "hann", "--expo", "10ms"}, 2,
                 "did you mean --exposure?; see nutik-cl shutter --help");
  expect_refused({"expose", "--shut", "hann"}, 2,
                 "did you mean --shutter-angle, --shutter or --shutter-error?");
  expect_refused({"enc", "clip.tik"}, 2, "did you mean encode?");
  const auto expect_choice = [&](const char* option, const char* value, const char* meant) {
    expect_refused({"expose", option, value, "-k", "one.fn", "clip.tik"}, 2,
                   std::string(option) + " " + value + " is not known; did you mean " + meant + "?");
  };
  expect_choice("--renderer", "refernce", "reference");
  expect_choice("--precision", "doubel", "double");
  expect_choice("--normalize", "integal", "integral");
  expect_choice("--shutter", "triangel", "triangle");
  expect_choice("--transfer", "sRGB", "srgb");
  expect_choice("--negative", "ofset", "offset");
  expect_refused({"encode", "--codec", "zst", "frames", "x.tik"}, 2, "did you mean zstd");
  expect_refused({"video", "--video-codec=prorez", "clip.tik"}, 2, "did you mean prores?");
  expect_refused({"shutter", "gausian", "--exposure", "1s"}, 2, "did you mean gaussian?");
  expect_refused({"completion", "csh"}, 2, "choose bash, zsh or fish");
}

TEST_F(Habits, NoticesSwallowedWords) {
  expect_refused({"--start", "clip.tik", "a.png"}, 2,
                 "--start needs a value, --start TIME, and clip.tik behind it is a file");
  expect_refused({"-k", "clip.tik", "a.png"}, 2,
                 "-k needs a file of another kind, -k FILE.fn, and clip.tik is a capture");
  expect_refused({"--start", "--exposure", "10ms", "clip.tik"}, 2, "--exposure behind it is an option");
  // A file that is named like a number is none of that.
  scratch_.write("1.5", "");
  EXPECT_EQ(run({"--gain", "1.5", "-k", "one.fn", "clip.tik", "a.png"}).status, 0);
}

TEST_F(Habits, AnswersInJson) {
  EXPECT_EQ(json({"info", "clip.tik"})["samples"], 3);
  EXPECT_EQ(json({"info", "clip.tik"})["duration_ns"], 120'000'000);
  EXPECT_EQ(json({"clip.tik"})["samples"], 3) << "the short form of info";
  EXPECT_FALSE(json({"devices"})["devices"].empty());
  EXPECT_EQ(json({"encode", "-f", "25", "frames", "b.tik"})["capture"], "b.tik");
  const nlohmann::json exposed = json({"-k", "one.fn", "clip.tik", "a.png"});
  EXPECT_EQ(exposed["picture"], "a.png");
  EXPECT_NEAR(exposed["functions"][0]["still_gain"].get<double>(), 1.0, 1e-7);  // less half a step of 1 ns
  EXPECT_EQ(exposed["saturated_above_pixels"], 0);
  const nlohmann::json series =
      json({"--start", "0s", "--exposure", "1f", "--every", "1f", "clip.tik", "s-%d.png"});
  EXPECT_EQ(series["pictures"].size(), 3u);
  EXPECT_EQ(json({"video", "--out-fps", "25", "--out-angle", "360", "clip.tik", "v-%d.png"})["frames"], 3);
  scratch_.write("list.txt", "-k one.fn x.png\n-k absent.fn y.png\n");
  EXPECT_EQ(json({"batch", "list.txt", "clip.tik"}, 1)["failed_lines"], nlohmann::json::array({2}));
  const std::string bytes = file("clip.tik");
  scratch_.write("cut.tik", std::string_view(bytes).substr(0, bytes.size() - 10));
  EXPECT_EQ(json({"recover", "cut.tik", "whole.tik"})["samples"], 3);
}

TEST_F(Habits, ExplainsThePlan) {
  const ProgramResult result = run({"-v", "-k", "one.fn", "clip.tik", "a.png"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("plan: exposes 1 of 3 samples; read: 1 block (samples 0 … 2), "
                            "skipped: 0 blocks\n  M0: 2 pixels, live 0 s … 40"),
            std::string::npos)
      << result.out;
}

TEST_F(Habits, ColoursOnlyTerminals) {
  EXPECT_EQ(run({"frobnicate"}, {"TERM=xterm"}).err.find('\x1b'), std::string::npos);
  if (!test::has_pseudo_terminals()) GTEST_SKIP() << "there is no pseudo terminal here, or no `script`";
  const auto on_terminal = [&](const std::string& setting) {
    return test::run_shell(
        "env TERM=xterm " + setting + " script -qec '" NUTIK_TEST_PROGRAM " frobnicate' /dev/null",
        scratch_.folder());
  };
  EXPECT_NE(on_terminal("").out.find("\x1b[1;31mnutik-cl:\x1b[0m"), std::string::npos);
  EXPECT_EQ(on_terminal("NO_COLOR=1").out.find('\x1b'), std::string::npos);
}

TEST_F(Habits, QuotesNamesInCommandsToTry) {
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "my clip.tik");
  EXPECT_NE(run({"my clip.tik"}).out.find("--exposure 1f 'my clip.tik' picture.png"), std::string::npos);
  EXPECT_NE(run({"-m", "mask.pgm", "my clip.tik"}).err.find("functions.fn 'my clip.tik'"), std::string::npos);
}

TEST_F(Habits, FitsHelpIntoTheTerminal) {
  for (const std::size_t width : {80u, 100u}) {
    for (const char* command :
         {"--help", "encode", "expose", "mask", "video", "sweep", "completion", "man"}) {
      std::vector<std::string> words{command};
      if (words.front() != "--help") words.emplace_back("--help");
      const std::string page = run(words, {"COLUMNS=" + std::to_string(width)}).out;
      for (std::size_t start = 0; start < page.size();) {
        const auto end = page.find('\n', start);
        const std::string line = page.substr(start, end - start);
        const auto characters =
            std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
        EXPECT_LE(static_cast<std::size_t>(characters), width) << line;
        start = end + 1;
      }
    }
  }
}

}  // namespace
}  // namespace nutik

// What people do without thinking: pipes, mistyped words, scripts that read what the program says.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

class Habits : public AppTest {
 protected:
  void SetUp() override {
    write_frames(3, [](int k) { return cv::Mat_<std::uint8_t>({1, 2}, {static_cast<std::uint8_t>(40 * k), 200}); });
    scratch_.write("one.fn", "M0 [0:1], [40000000:1], [40000001:0]\n");
    scratch_.write("two.fn", "M0 [0:1], [40000000:1], [40000001:0]\nM9 [0:2], [40000000:2], [40000001:0]\n");
    scratch_.write("mask.pgm", "P2 2 1 255\n0 9\n");
    make("-f 25 frames clip.tik");
  }

  ProgramResult run(const Words& words, const std::vector<std::string>& environment = {}) const {
    return run_program(words, scratch_.folder(), environment);
  }
  ProgramResult piped(const std::string& file, const std::string& words, int status = 0) const {
    return shell("cat " + file + " | '" NUTIK_TEST_PROGRAM "' " + words, status);
  }
};

TEST_F(Habits, SaysThatStandardOutputIsFull) {
  for (const char* words : {"--help", "clip.tik", "clip.tik --json",
                            "trace --start 0s --exposure 1f --pixel 0,0 clip.tik", "completion bash"}) {
    const ProgramResult result = shell(std::string("'" NUTIK_TEST_PROGRAM "' ") + words + " > /dev/full", 5);
    EXPECT_EQ(result.err, "nutik-cl: standard output cannot be written\n") << words;
  }
}

TEST_F(Habits, ReadsFunctionsAndMasksFromStandardInput) {
  const Words plain("--no-recipe -m mask.pgm -k two.fn clip.tik a.png");
  make(plain);
  piped("two.fn", "--no-recipe -m mask.pgm -k - clip.tik b.png");
  EXPECT_EQ(file("a.png"), file("b.png"));
  piped("mask.pgm", "--no-recipe -m - -k two.fn clip.tik c.png");
  EXPECT_EQ(file("a.png"), file("c.png"));
  EXPECT_EQ(piped("one.fn", "-q -k - clip.tik").out, "clip-standard-input.png\n");
  piped("two.fn", "check -k - -m mask.pgm clip.tik");
  piped("mask.pgm", "activity -m - clip.tik");
  piped("mask.pgm", "mask --base - --invert -o d.pgm", 2);  // nothing to invert
  // The recipe has the functions' text.
  piped("one.fn", "-k - clip.tik e.png");
  expect_says(run("reproduce e.png").out, "-k e-again/standard-input.fn");
}

// A picture beside the stills that it was made of is none of them; one that would be is not made there.
TEST_F(Habits, WritesBesideStillsWhatIsNoneOfThem) {
  const std::string refusal = " would lie among the stills of frames, and be taken for one or keep them from being";
  expect_refused("-f 25 --start 0f --exposure 1f frames frames/103.pgm", 2, "frames/103.pgm" + refusal);
  expect_refused("-f 25 --start 0f --exposure 1f frames frames/out.png", 2, "frames/out.png" + refusal);
  expect_refused("video -f 25 frames frames/2%02d.pgm", 2, "frames/200.pgm" + refusal);
  make("-f 25 --start 0f --exposure 1f frames frames/out.pgm");
  EXPECT_EQ(answer("encode -f 25 frames again.tik")["samples"], 3);
}

// Commands' names in earlier versions are names of files first.
TEST_F(Habits, TakesAnOldNameForAFileThatHasIt) {
  make("plate clip.tik");
  std::filesystem::rename(scratch_ / "frames", scratch_ / "plate");
  EXPECT_EQ(answer("-f 25 plate plate.tik")["samples"], 3);
}

TEST_F(Habits, NamesStandardInput) {
  expect_refused("-k - -m - clip.tik", 2, "-k - and -m - would both read standard input");
  expect_refused("-k - clip.tik", 3, "standard input is empty");
  scratch_.write("bad.fn", "M0 [0:1], [5:1], [5:0]\n");
  expect_says(piped("bad.fn", "-k - clip.tik", 3).err, "standard input:1:19: time 5 stands twice");
  expect_says(piped("bad.fn", "check -k -", 3).out, "standard input:1:19");
  expect_says(piped("one.fn", "-m - -k two.fn clip.tik", 3).err, "standard input is neither a PGM nor a PNG");
  scratch_.write("list.txt", "-k - a.png\n");
  expect_says(piped("list.txt", "batch - clip.tik", 1).err, "standard input holds the list already");
}

TEST_F(Habits, NoticesThatMaskAndFunctionsWereSwapped) {
  expect_refused("-m two.fn -k mask.pgm clip.tik", 3, "were mask and functions swapped?");
  expect_refused("-m two.fn -k two.fn clip.tik", 3, "It looks like gain functions; were mask and functions swapped?");
}

TEST_F(Habits, RefusesHelpOnWhatIsNoCommand) {
  expect_refused(2, {{"--help=source", "is help on a command: nutik-cl COMMAND --help=source"},
                     {"help ./clip.tik", "there is no command ./clip.tik"}});
  EXPECT_EQ(make("help expose source").out, make("expose --help=source").out);
}

TEST_F(Habits, NoticesAMissingUnitAndACommaForAPoint) {
  scratch_.write("ns.fn", "M0 [39:0], [40:1], [80:1], [81:0]\n");
  expect_says(run("check -k ns.fn clip.tik").out, "if its times were meant in milliseconds, write 81ms");
  expect_refused(2, {{"--start 0,1s --exposure 1f clip.tik a.png", "the decimal mark is a point"},
                     {"--start 0s --exposure 1f --ev 1,5 clip.tik a.png",
                      "--ev 1,5 is no number; the decimal mark is a point"},
                     {"-f 29,97 clip.tik a.tik", "; the decimal mark is a point"}});
  expect_refused(3, {{"batch clip.tik", "batch takes the list first, then the clip or capture"}});
  make("--start 0s --exposure 1f --ev 1/2 --no-recipe clip.tik fraction.pfm");
  make("--start 0s --exposure 1f --ev 0.5 --no-recipe clip.tik half.pfm");
  EXPECT_EQ(read_file(scratch_ / "fraction.pfm"), read_file(scratch_ / "half.pfm"));
}

TEST_F(Habits, TakesTimesWithUnitsInFunctionFiles) {
  scratch_.write("units.fn", "M0 [0s:1], [40ms:1], [40000001:0]\n");
  make("-k units.fn --no-recipe clip.tik units.pfm");
  make("-k one.fn --no-recipe clip.tik one.pfm");
  EXPECT_EQ(read_file(scratch_ / "units.pfm"), read_file(scratch_ / "one.pfm"));
}

TEST_F(Habits, SuggestsWhatWasMeant) {
  expect_refused("--expo 10ms clip.tik", 2, "there is no option --expo; did you mean --exposure?");
  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"encode", "--exposur", "1s", "c.mp4"}, "there is no option --exposur; see nutik-cl encode --help"},
           {{"-ss", "1", "clip.tik", "a.png"}, "there is no option -ss; that is --start, of a video --from"},
           {{"clip.tik", "study"}, "the command comes first: nutik-cl study clip.tik"},
           {{"--style", "strobe", "clip.tik", "a.png"}, "--style is an option of study: nutik-cl study --style …"},
           {{"study", "--moments", "abc", "clip.tik"}, "'abc' is neither a number of moments, 7, nor their times"},
           {{"-vX", "clip.tik", "a.png"}, "there is no option -X; see nutik-cl --help"},
           {{"video", "--quality", "50", "clip.tik", "a.mkv"},
            "ffv1 has no scale of quality: it loses nothing (--quality)"}}) {
    expect_refused(words, 2, said);
  }
  expect_refused(2, {{"shutter hann --expo 10ms", "did you mean --exposure?; see nutik-cl shutter --help"},
                     {"expose --shut hann", "did you mean --shutter-angle, --shutter or --shutter-error?"},
                     {"video --fps-out 24 clip.tik", "did you mean --out-fps?"},
                     {"study --moment 0s clip.tik",
                      "does not go with study; did you mean --moments? --moment is an option of: activity"},
                     {"enc clip.tik", "did you mean encode?"}});
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
  expect_refused(2, {{"encode --codec zst frames x.tik", "did you mean zstd"},
                     {"video --video-codec=prorez clip.tik", "did you mean prores?"},
                     {"video --video-codec prores-hq clip.tik x.mov", "did you mean prores?"},
                     {"shutter gausian --exposure 1s", "did you mean gaussian?"},
                     {"completion csh", "choose bash, zsh or fish"}});
}

TEST_F(Habits, NoticesSwallowedWords) {
  expect_refused(
      2, {{"--start clip.tik a.png", "--start needs a value, --start TIME, and clip.tik behind it is a file"},
          {"-k clip.tik a.png", "-k needs a file of another kind, -k FILE.fn, and clip.tik is a capture"},
          {"--start --exposure 10ms clip.tik", "--start TIME, and --exposure behind it is an option"},
          {"encode --align --start 0s clip.tik",
           "a value, translation, rigid, homography or auto, and --start behind it is"},
          {"expose x.png frames", "there is no file x.png, and frames is one; the input comes first: nutik-cl expose "
                                  "frames x.png"}});
  // Patterns name no file.
  for (int time = 0; time < 2; ++time) make("expose -f 25 --start 0s --exposure 40ms frames/*.pgm again.png");
  // A file that is named like a number is none of that.
  scratch_.write("1.5", "");
  make("--gain 1.5 -k one.fn clip.tik a.png");
}

TEST_F(Habits, AnswersInJson) {
  EXPECT_EQ(answer("info clip.tik")["samples"], 3);
  EXPECT_EQ(answer("info clip.tik")["duration_ns"], 120'000'000);
  EXPECT_EQ(answer("clip.tik")["samples"], 3) << "the short form of info";
  EXPECT_FALSE(answer("devices")["devices"].empty());
  EXPECT_EQ(answer("encode -f 25 frames b.tik")["capture"], "b.tik");
  const nlohmann::json exposed = answer("-k one.fn clip.tik a.png");
  EXPECT_EQ(exposed["picture"], "a.png");
  EXPECT_NEAR(exposed["functions"][0]["still_gain"].get<double>(), 1.0, 1e-7);  // less half a step of 1 ns
  EXPECT_EQ(exposed["saturated_above_pixels"], 0);
  const nlohmann::json series = answer("--start 0s --exposure 1f --every 1f clip.tik s-%d.png");
  EXPECT_EQ(series["pictures"].size(), 3u);
  EXPECT_EQ(answer("video --out-fps 25 --out-angle 360 clip.tik v-%d.png")["frames"], 3);
  scratch_.write("list.txt", "-k one.fn x.png\n-k absent.fn y.png\n");
  EXPECT_EQ(answer("batch list.txt clip.tik", 1)["failed_lines"], nlohmann::json::array({2}));
  const std::string bytes = file("clip.tik");
  scratch_.write("cut.tik", std::string_view(bytes).substr(0, bytes.size() - 10));
  EXPECT_EQ(answer("recover cut.tik whole.tik")["samples"], 3);
}

TEST_F(Habits, ExplainsThePlan) {
  expect_says(make("-v -k one.fn clip.tik a.png").out,
              "plan: exposes 1 of 3 samples; read: 1 block (samples 0 … 2), "
              "skipped: 0 blocks\n  M0: 2 pixels, live 0 s … 40");
}

TEST_F(Habits, ColoursOnlyTerminals) {
  EXPECT_EQ(run("frobnicate", {"TERM=xterm"}).err.find('\x1b'), std::string::npos);
  if (!has_pseudo_terminals()) GTEST_SKIP() << "there is no pseudo terminal here, or no `script`";
  const auto on_terminal = [&](const std::string& setting) {
    return shell("env TERM=xterm " + setting + " script -qec '" NUTIK_TEST_PROGRAM " frobnicate' /dev/null", 2);
  };
  expect_says(on_terminal("").out, "\x1b[1;31mnutik-cl:\x1b[0m");
  EXPECT_EQ(on_terminal("NO_COLOR=1").out.find('\x1b'), std::string::npos);
}

TEST_F(Habits, QuotesNamesInCommandsToTry) {
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "my clip.tik");
  expect_says(run({"my clip.tik"}).out, "--exposure 1f 'my clip.tik' picture.png");
  expect_says(run({"-m", "mask.pgm", "my clip.tik"}).err, "functions.fn 'my clip.tik'");
}

TEST_F(Habits, FitsHelpIntoTheTerminal) {
  // CommandLine.HasHelpForEverything counts 80 columns.
  for (const char* words : {"--help", "encode --help", "expose --help", "mask --help", "video --help", "sweep --help",
                            "completion --help", "man --help"}) {
    std::istringstream page(run(words, {"COLUMNS=100"}).out);
    for (std::string line; std::getline(page, line);) {
      EXPECT_LE(std::ranges::count_if(line, [](char c) { return (c & 0xc0) != 0x80; }), 100) << line;
    }
  }
}

}  // namespace
}  // namespace nutik::test

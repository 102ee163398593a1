// The command line as a user meets it: exit status, message, what is left behind.
#include <gtest/gtest.h>

#include <set>
#include <opencv2/videoio.hpp>

#include "app/words/stated_requests.hpp"
#include "support/app_test.hpp"

namespace nutik::test {
namespace {

// A clip of 6 pictures of 16 × 16 pixels, and its capture, in each test's folder.
class CommandLine : public AppTest {
 protected:
  void SetUp() override {
    cv::VideoWriter writer((scratch_ / "clip.avi").string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25,
                           {16, 16});
    ASSERT_TRUE(writer.isOpened());
    for (int k = 0; k < 6; ++k) writer.write(cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(40 * k)));
    writer.release();
    make("clip.avi clip.tik");
    scratch_.write("one.fn", "M0 [0:1], [40000000:1], [40000001:0]\n");
    scratch_.write("two.fn", "M0 [0:1], [1:0]\nM9 [0:1], [1:0]\n");
    std::string mask = "P2 16 16 255\n";
    for (int i = 0; i < 256; ++i) mask += i < 100 ? "9 " : "0 ";
    scratch_.write("mask.pgm", mask);
  }
};

TEST_F(CommandLine, TakesThePapersForms) {
  make("-f120 -a180 clip.avi a.tik");
  expect_says(run("info a.tik").out, "120 samples a second, shutter 180 degrees");
  make("-f960 -a200 -ob.tik clip.avi");
  expect_says(run("info b.tik").out, "960 samples a second, shutter 200 degrees");
  make("-mmask.pgm -ktwo.fn a.tik");
  EXPECT_TRUE(exists("a-two.png"));
  make("-m./mask.pgm -k./two.fn b.tik");
  EXPECT_TRUE(exists("b-two.png"));
}

TEST_F(CommandLine, NamesWhatWasMeant) {
  expect_refused(
      2, {{"encod clip.avi x.tik", "there is no file and no command 'encod'; did you mean encode?"},
          {"frobnicate", "there is no file and no command 'frobnicate'"},
          {"-f 25 --fps 30 clip.avi x.tik", "-f is given twice"},
          {"mask --base mask.pgm --base mask.pgm clip.tik", "--base is given twice"},
          {"mask clip.tik --changed-between 0.1s",
           "--changed-between needs more words: --changed-between TIME TIME"},
          {{"--start", "0s", "--exposure", "1f", "-o", "", "clip.tik"}, "the output's name is empty"}});
  shell("mkfifo pipe");
  expect_refused("pipe x.tik", 3, "pipe is no regular file");
}

TEST_F(CommandLine, SaysTheNameThatNobodyGave) {
  EXPECT_EQ(run("-q -k one.fn clip.tik").out, "clip-one.png\n");
  EXPECT_EQ(run("-q -k one.fn clip.tik named.png").out, "");
  EXPECT_EQ(run("encode -q --overwrite clip.avi").out, "clip.tik\n");
}

TEST_F(CommandLine, ReportsHowAnExposureWasComputed) {
  expect_says(make("-v --start 0s --exposure 3f clip.tik out.png").out,
              {", still gain 1,", "1 block of ", " MB on the device"});
}

TEST_F(CommandLine, KnowsProjectsOfTheStudio) {
  scratch_.write("work.nutik", "{\"nutik-studio\": 1}\n");
  for (const char* words : {"work.nutik", "--start 0s --exposure 1f work.nutik out.png"})
    expect_refused(words, 3, "work.nutik is a project of nutik-studio, which opens it, and no clip");
}

TEST_F(CommandLine, SaysWhatACaptureHolds) {
  const ProgramResult info = make("info clip.tik --activity map.png");
  expect_says(info.out, {"16 x 16 colour, 8 bits, white code 255, transfer srgb", "6 in 1 block",
                         "25 samples a second, shutter 360 degrees", "5.00 records a pixel", "100.0 % dense",
                         "map.png: black never changes, white 5 times",
                         "try: nutik-cl --start 3f --exposure 1f clip.tik picture.png"});
  EXPECT_TRUE(exists("map.png"));
  make("--start 3f --exposure 1f clip.tik picture.png");
  expect_refused(2, {{"info clip.tik --activity clip.tik", "is also an input"},
                     {"info clip.tik --activity map.txt", ".png"},
                     {"info clip.tik --activity map.pfm", "map.pfm holds floating point only"}});
}

TEST_F(CommandLine, TakesOptionsAndOperandsInAnyOrder) {
  make("clip.tik -k one.fn first.png");
  make("-k one.fn clip.tik second.png");
  make("-o third.png clip.tik --functions=one.fn");
  make("expose clip.tik -qo fourth.png -kone.fn");
  make("clip.tik fifth.png expose -k one.fn", 2);  // no command any more
  for (const char* other : {"second.png", "third.png", "fourth.png"}) {
    EXPECT_EQ(file(other), file("first.png")) << other;
  }
}

TEST_F(CommandLine, OnlyTheFirstWordCanBeACommand) {
  std::filesystem::copy_file(scratch_ / "clip.avi", scratch_ / "encode");
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "info");
  make("./encode x.tik");
  make("-- encode y.tik");
  make("encode encode z.tik");
  make("-k one.fn ./info out.png");
  make("info info");
  EXPECT_TRUE(exists("x.tik") && exists("y.tik") && exists("z.tik"));
}

TEST_F(CommandLine, TellsValuesFromOptionsAndOperands) {
  make("--ev -1 -qk one.fn clip.tik a.png");
  make("-vqkone.fn --ev=-1 clip.tik b.png");
  make("-q -q --ev -1 -k one.fn -- clip.tik -c.png");
  EXPECT_EQ(file("a.png"), file("b.png"));
  EXPECT_TRUE(exists("-c.png"));
  make("mask --threshold=0f 40..90 clip.tik m.pgm");
  expect_refused(2, {{"--gain= -k one.fn clip.tik", "--gain  is no number"},
                     {"--quiet=yes -k one.fn clip.tik", "-q takes no value"},
                     {"-qx clip.tik", "there is no option -x"},
                     {"study --bogus clip.tik", "there is no option --bogus; see nutik-cl study --help"},
                     {"mask --threshold=0f", "--threshold needs more words: --threshold PICTURE LOW..HIGH"}});
  expect_refused("-ko clip.tik", 3, "o cannot be read");
  // What only an exposure takes means one; what others take too does not.
  expect_refused(2, {{"--gain 2 clip.tik d.png", "an exposure needs a plain interval"},
                     {"--renderer opencl clip.avi d.tik", "--renderer does not go with encode"}});
  make("--transfer linear clip.avi d.tik");
}

TEST_F(CommandLine, NamesTheOutputWhereNoneIsGiven) {
  expect_says(make("-k one.fn clip.tik").out, "clip-one.png:");
  make("--start 1/100s --exposure 10ms clip.tik");
  EXPECT_TRUE(exists("clip-1_100s-10ms.png"));
}

TEST_F(CommandLine, ShowsInfoForACaptureAlone) {
  EXPECT_EQ(run("clip.tik").out, run("info clip.tik").out);
  EXPECT_EQ(run("--json clip.tik").out, run("info --json clip.tik").out);
  make("--activity map.png clip.tik");
  EXPECT_TRUE(exists("map.png"));
}

TEST_F(CommandLine, RefusesWhatMakesNoSense) {
  expect_refused(2,
                 {{{}, "say what to do: nutik-cl clip.mp4 clip.tik"},
                  {"clip.avi", "the output is missing: nutik-cl clip.avi clip.tik"},
                  {"-m mask.pgm clip.tik", "nutik-cl -m mask.pgm -k functions.fn clip.tik"},
                  {"-k two.fn clip.tik", "two.fn holds 2 functions; a mask says where each applies"},
                  {"-k one.fn clip.tik a.png -o b.png", "two outputs: -o b.png and a.png"},
                  {"-k one.fn clip.tik a.png b.png", "'b.png' is one file too many"},
                  {"-k one.fn --start 0s --exposure 1ms clip.tik", "use one"},
                  {"--combine lighten --normalize integral --start 0s --exposure 1ms clip.tik", "leave one out"},
                  {"--start 0s clip.tik", "Add --exposure 10ms"},
                  {"--exposure 10 clip.tik", "--exposure '10' is no time; write a number and a unit"},
                  {"--exposure 1f --start 9f clip.tik", "picture 9 is outside the capture, which has 6"},
                  {"--exposure 1ms --start 9s clip.tik", "lies outside the capture, which lasts 240 ms"},
                  {"--fsp 3 clip.avi x.tik", "there is no option --fsp; did you mean --fps?"},
                  {"--tolerance 1 -k one.fn clip.tik", "--tolerance describes a clip"},
                  {"devices -m mask.pgm", "-m does not go with devices; it is an option of: expose"},
                  {"-f fast clip.avi x.tik", "--fps 'fast' is not a number"},
                  {"-a 400 clip.avi x.tik", "shutter angle 400 is outside 0 < angle <= 360"},
                  {"--depth 12 -k one.fn clip.tik", "--depth '12' is not known; choose 8, 16, half, float or double"},
                  {"--renderer cuda -k one.fn clip.tik", "choose opencl or reference"},
                  {"--unmapped black -k one.fn clip.tik", "the only choice is --unmapped zero"},
                  {"-k", "-k needs a value: -k FILE.fn"}});
}

TEST_F(CommandLine, SaysWhatIsWrongWithInput) {
  expect_refused(3, {{"absent.mp4 x.tik", "absent.mp4 cannot be read: no such file"},
                     {"one.fn x.tik", "one.fn is a function file, and no clip"},
                     {"-k absent.fn clip.tik", "absent.fn cannot be read: No such file"},
                     {"-k one.fn -m mask.pgm clip.tik", "mask values without a function: 9 (100 pixels)"}});
  make("-k one.fn -m mask.pgm --unmapped zero clip.tik");
  scratch_.write("bad.fn", "M0 [0:1], [5:1], [5:0]\n");
  expect_refused("-k bad.fn clip.tik", 3, "bad.fn:1:19: time 5 stands twice");
  expect_refused({"--device", "no such", "-k", "one.fn", "clip.tik"}, 4, "these were found:\n  0  ");
  EXPECT_FALSE(exists("x.tik"));
}

TEST_F(CommandLine, ReplacesOnlyItsOwnKind) {
  expect_refused(
      2, {{"clip.tik clip.avi", "clip.tik is a capture already"},
          {"x.tik clip.avi",
           "there is no file x.tik, and clip.avi is one; the input comes first: nutik-cl encode clip.avi x.tik"},
          {"clip.avi x.mp4", "x.mp4 is no name for a capture, which ends in .tik; nutik-cl video makes films"},
          {"clip.avi x.png", "which ends in .tik; for a picture say of when: nutik-cl expose --start 0.4s"},
          {"-k one.fn clip.tik -o clip.tik", "is also an input"},
          {"-k one.fn clip.tik -o ./one.fn", "is also an input"}});
  scratch_.write("notes.png", "my notes");
  expect_refused("-k one.fn clip.tik -o notes.png", 2, "notes.png exists and is no picture");
  EXPECT_EQ(file("notes.png"), "my notes");
  std::filesystem::copy_file(scratch_ / "clip.tik", scratch_ / "capture.ppm");
  expect_refused("-k one.fn clip.tik -o capture.ppm", 2, "exists and is no picture");
  std::filesystem::create_directory(scratch_ / "folder.tik");
  expect_refused("clip.avi folder.tik", 2, "is a folder");
  expect_refused("-k one.fn clip.tik -o absent/x.png", 5, "cannot be created: there is no folder absent");
  // Before a clip is read, which would fail here.
  scratch_.write("notes.mp4", "no film");
  for (const std::string words : {"video --out-fps 5 notes.mp4 absent/x.mp4", "study notes.mp4 absent/x.png",
                                  "background notes.mp4 absent/x.png", "notes.mp4 absent/x.tik"})
    expect_refused(words, 5, "cannot be created: there is no folder absent");
  // What carries a recipe of the same kind is replaced, the rest only if asked.
  make("-k one.fn clip.tik a.png");
  make("-k one.fn clip.tik a.png");
  expect_refused(
      "clip.avi clip.tik", 2,
      "clip.tik is there already and is not replaced; choose another name, or replace it with --overwrite");
  make("--overwrite clip.avi clip.tik");
}

TEST_F(CommandLine, IsQuietWhereAsked) {
  const ProgramResult result = make("-q -k one.fn clip.tik a.png");
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(CommandLine, SaysWhereRateAndAngleComeFrom) {
  const ProgramResult from_file = run("clip.avi a.tik");
  expect_says(from_file.out, "25 pictures a second (from the file), shutter 360 degrees (assumed)");
  expect_says(from_file.err, "if it was filmed faster, say so (--fps)");
  const ProgramResult stated = run("-f 30000/1001 -a 172.8 --overwrite clip.avi a.tik");
  expect_says(stated.out, "30000/1001 pictures a second (--fps), shutter 172.8 degrees (--shutter-angle)");
  EXPECT_EQ(stated.err, "");
}

TEST_F(CommandLine, HasHelpForEverything) {
  const std::string overview = run("--help").out;
  expect_says(overview, "nutik-cl clip.mp4 clip.tik");
  EXPECT_EQ(run("help").out, overview);
  for (const char* words : {"--version", "-V", "version"}) EXPECT_EQ(run(words).out.rfind("nutik-cl ", 0), 0u);
  std::vector<std::string> commands{"devices", "completion", "man"};
  std::istringstream lines(overview);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ") && !line.starts_with("  nutik-cl"))
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  EXPECT_EQ(commands.size(), 25u) << overview;
  const auto expect_fits = [](const std::string& page) {
    EXPECT_LE(std::ranges::count(page, '\n'), 40) << page;
    std::istringstream read(page);
    for (std::string line; std::getline(read, line);) {
      EXPECT_LE(std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }), 80) << line;
    }
  };
  expect_fits(overview);
  std::set<std::string> shown;  // option names, in any command's short help
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    const std::string page = make({command, "--help"}).out;
    expect_fits(page);
    EXPECT_EQ(make({"help", command}).out, page);
    EXPECT_EQ(page.find("Seldom needed"), page.npos);
    expect_says(make({command, "--help=all"}).out, "\nExamples:\n  ");
    std::istringstream options(page);
    for (std::string line; std::getline(options, line);) {
      const std::size_t name = line.starts_with("  -") || line.starts_with("      --") ? line.find("--") : line.npos;
      if (name != line.npos) shown.insert(line.substr(name, line.find(' ', name) - name));
    }
  }
  EXPECT_LE(shown.size(), 95u);
  expect_says(run("expose --help=all").out, {"--tiles KIND", "--matrix NAME", "--memory SIZE"});
  EXPECT_EQ(run("expose --help").out.find("--matrix"), std::string::npos);
  expect_says(run("expose --help=source").out, "--matrix NAME");
  EXPECT_EQ(run("expose --help=source").out.find("--memory"), std::string::npos);
  expect_refused(2, {{"expose --help=sauce", "there is no help on 'sauce'; choose all, source, computing or output"},
                     {"help exposse", "no command 'exposse'; did you mean expose?"}});
}

TEST_F(CommandLine, TakesNamesOfEarlierVersions) {
  make("plate clip.tik old.ppm");
  make("background clip.tik new.ppm");
  EXPECT_EQ(file("old.ppm"), file("new.ppm"));
  make("--as-far-as-it-goes --start 0f --exposure 1f clip.avi p.png");
  const std::string command = make("reproduce p.png").out;
  expect_says(command, " --ignore-errors ");
  EXPECT_EQ(make("again p.png").out, command);
  EXPECT_TRUE(app::is_recipe_option("as-far-as-it-goes", "", RecipeOf::expose));
  for (const char* page : {"--help", "encode --help=all", "man", "completion bash", "completion fish"}) {
    const std::string text = make(page).out;
    for (const char* old : {"nutik-cl plate", "nutik-cl again", "as-far-as-it-goes"})
      EXPECT_EQ(text.find(old), std::string::npos) << page << ": " << old;
  }
}

TEST_F(CommandLine, RecoversACutOffCapture) {
  const std::string bytes = file("clip.tik");
  scratch_.write("cut.tik", std::string_view(bytes).substr(0, bytes.size() - 10));
  expect_refused("cut.tik", 3, "nutik-cl recover cut.tik -o recovered.tik");
  expect_says(make("recover cut.tik -o whole.tik").out, "6 samples in 1 block were saved");
  shell(NUTIK_TEST_PROGRAM " recover - -o piped.tik < cut.tik");
  EXPECT_TRUE(file("piped.tik") == file("whole.tik"));
  make("-k one.fn whole.tik a.png --no-recipe");
  make("-k one.fn clip.tik b.png --no-recipe");
  EXPECT_EQ(file("a.png"), file("b.png"));
}

}  // namespace
}  // namespace nutik::test

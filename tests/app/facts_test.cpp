// Nothing is assumed in silence: of every recorded clip the program says what it read, what it took, and with which
// option another can be stated.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Facts : public AppTest {
 protected:
  // The first pictures of a clip: what the summary says, then what the capture keeps of it.
  struct Told {
    std::string summary;
    std::map<std::string, std::string> facts;  // by what they are of, each with who said it
  };

  Told told(const fs::path& clip, const Words& options) const {
    const auto encoded = make(Words{"encode", "--overwrite", "--to", "3f", clip.string(), "part.tik"} + options);
    const auto info = make("info part.tik");
    Told result{encoded.out + encoded.err, {}};
    std::istringstream lines(info.out);
    constexpr std::string_view kStart = "  taken for   ";
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with(kStart)) {
        const std::string fact = line.substr(kStart.size());
        result.facts[subject_of(fact)] = fact;
      }
    }
    return result;
  }

  // `rate`, `pixel aspect`, …, as the options call it.
  static std::string subject_of(const std::string& fact) {
    const std::vector<std::pair<std::string, std::string>> kWords{{"pictures a second", "fps"},
                                                                  {"shutter ", "shutter-angle"},
                                                                  {"transfer ", "transfer"},
                                                                  {"matrix ", "matrix"},
                                                                  {" range", "range"},
                                                                  {"chroma at ", "chroma-at"},
                                                                  {"primaries ", "primaries"},
                                                                  {"pixels", "pixel-aspect"},
                                                                  {"progressive ", "deinterlace"},
                                                                  {"pictures 0", "to"},
                                                                  {"white ", "white"},
                                                                  {"EVT ", "sensor"},
                                                                  {"camera's clock", "clock"},
                                                                  {"log light", "contrast"},
                                                                  {"at the start", "start-picture"}};
    for (const auto& [word, subject] : kWords) {
      if (fact.find(word) != std::string::npos) return subject;
    }
    return fact;
  }

  // Each fact says where it comes from, and the summary names the options of those that were assumed, and of no others.
  static void expect_origins(const Told& told, const fs::path& clip) {
    std::set<std::string> assumed, named;
    for (const auto& [subject, fact] : told.facts) {
      // A fact may have commas of its own before that.
      const std::size_t origin = std::min({fact.find(", from "), fact.find(", as stated"), fact.find(", assumed")});
      const std::string said = fact.substr(std::min(origin, fact.size()));
      EXPECT_TRUE(said.starts_with(", from ") || said == ", as stated" || said.starts_with(", assumed"))
          << clip << ": " << fact;
      if (said.starts_with(", assumed")) assumed.insert(subject);
    }
    const std::string start = "what is assumed can be stated (";
    const auto at = told.summary.find(start);
    if (at != std::string::npos) {
      std::istringstream list(
          told.summary.substr(at + start.size(), told.summary.find(')', at) - at - start.size()));
      for (std::string option; list >> option;) {
        if (option.back() == ',') option.pop_back();
        named.insert(option.substr(2));
      }
    }
    EXPECT_EQ(named, assumed) << clip << "\n" << told.summary;
  }
};

const fs::path kMedia = NUTIK_TEST_MEDIA;

struct Recording {
  std::string name;
  std::vector<std::string> options;
  std::set<std::string>
      facts;         // beside rate, shutter, transfer function, shape of pixels, and the part that is taken
  std::string said;  // what else the summary must name
};

// Every file of the folder: a new one is to be added here.
const std::vector<Recording>& recordings() {
  static const std::set<std::string> kVideo{"matrix", "range", "primaries"};
  static const std::vector<Recording> kAll{
      {"BallTossOut.mp4", {}, kVideo, "slow-motion files state their playback rate"},
      {"bicycle-wheel.mp4", {}, kVideo, "transfer srgb (assumed: the file names bt709)"},
      {"bikes.mp4", {}, kVideo, "25 pictures a second (from the file)"},
      {"bottle-detection.mp4", {}, kVideo, "square pixels (from the file)"},
      {"bulk-water.mov", {}, kVideo, "full range (from the file)"},
      {"diabolo-cm-trajectory.mp4", {}, kVideo, "matrix bt709 (assumed)"},
      {"one-by-one-person-detection.mp4", {}, kVideo, "transfer srgb (assumed: the file names smpte170m)"},
      {"one-by-one-person-detection.mp4", {}, kVideo, "primaries bt709 (from the file: it names smpte170m)"},
      {"realshort.mp4", {}, kVideo, "matrix bt601 (assumed)"},
      {"ball_12bit.mraw", {}, {"white"}, "shutter 216 degrees (from ball_12bit.cihx: 20000 ns)"},
      {"ball_12bit.cihx", {}, {"white"}, "white 4095 (from ball_12bit.cihx), transfer linear (assumed)"},
      {"ball_12bit.cihx", {}, {"white"}, "30000 pictures a second (from ball_12bit.cihx)"},
      {"ball_12bit_png",
       {"-f", "30000"},
       {"white"},
       "white is taken to be 65535; state another, 4095 for 12 bits (--white)"},
      {"cine_781.cine",
       {},
       {"white", "deinterlace"},
       "white 4095 (from the file), transfer linear (assumed)"},
      {"data_small_cine.cine", {}, {"white", "deinterlace"}, "transfer linear (from the file)"},
      {"evt2.raw",
       {},
       {"sensor", "clock", "contrast", "start-picture"},
       "EVT 2.0, 640 x 480 (from plugin_name hal_plugin_gen3_fx3)"},
      {"stuck.tif", {"-f", "20"}, {"white"}, "white is taken to be 65535"},
      {"sparks_ref_480x270.yuv42010le.yuv",
       {"-f", "24", "--raw", "480x270:yuv420p10le"},
       {"matrix", "range", "chroma-at", "primaries", "deinterlace"},
       "24 pictures a second (--fps)"}};
  return kAll;
}

TEST_F(Facts, OfEveryRecordingHaveTheirOrigin) {
  if (!fs::exists(kMedia / "README.md")) GTEST_SKIP() << "no clips in " << kMedia;
  std::set<std::string> files{"README.md"};
  for (const auto& [name, options, more, said] : recordings()) {
    files.insert(name);
    const Told told = this->told(kMedia / name, options);
    expect_origins(told, name);
    std::set<std::string> subjects, expected{"fps", "shutter-angle", "transfer", "pixel-aspect", "to"};
    for (const auto& [subject, fact] : told.facts) subjects.insert(subject);
    expected.insert(more.begin(), more.end());
    EXPECT_EQ(subjects, expected) << name;
    expect_says(told.summary, said);
  }
  for (const auto& entry : fs::directory_iterator(kMedia)) {
    EXPECT_TRUE(files.contains(entry.path().filename().string())) << entry.path() << " is not tried here";
  }
}

// What the containers name is read, and what they do not is said to be assumed.
TEST_F(Facts, OfVideosAreWhatFfprobeFinds) {
  if (!fs::exists(kMedia / "README.md")) GTEST_SKIP() << "no clips in " << kMedia;
  if (run_shell("ffprobe -version", scratch_.folder()).status != 0) GTEST_SKIP() << "ffprobe is missing";
  const std::map<std::string, std::string> fields{{"matrix", "color_space"},
                                                  {"range", "color_range"},
                                                  {"primaries", "color_primaries"},
                                                  {"pixel-aspect", "sample_aspect_ratio"}};
  for (const Recording& recording : recordings()) {
    if (!recording.name.ends_with(".mp4") && !recording.name.ends_with(".mov")) continue;
    const Told told = this->told(kMedia / recording.name, {});
    const auto probed = run_shell(
        "ffprobe -v error -select_streams v:0 -show_streams " + (kMedia / recording.name).string(), scratch_.folder());
    for (const auto& [subject, field] : fields) {
      const auto at = probed.out.find("\n" + field + "=");
      ASSERT_NE(at, std::string::npos) << field;
      const auto begin = at + field.size() + 2;
      const std::string value = probed.out.substr(begin, probed.out.find('\n', begin) - begin);
      const bool is_named = value != "unknown" && value != "N/A";
      const std::string& fact = told.facts.at(subject);
      EXPECT_EQ(fact.find(", from the file") != std::string::npos, is_named)
          << recording.name << ": " << fact << ", and ffprobe has " << field << "=" << value;
    }
  }
}

// Scripts are told what people are: every command that reads a clip names what was assumed of it.
TEST_F(Facts, OfAClipAreToldToScriptsByEveryCommandThatReadsIt) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i testsrc=s=64x48:r=30:d=0.5 -pix_fmt yuv420p -c:v ffv1 clip.mkv");
  scratch_.write("list", "--start 0s --exposure 3f clip.mkv listed.png\n");
  scratch_.write("one.fn", "M0{[0:1], [100000000:1]}\n");
  scratch_.write("named.fn", "M0{[0:gain], [100000000:gain]}\n");
  const std::vector<std::vector<std::string>> commands{
      {"encode", "clip.mkv", "a.tik"},
      {"expose", "--start", "0s", "--exposure", "3f", "clip.mkv", "a.png"},
      {"expose", "--start", "0s", "--exposure", "1f", "--every", "3f", "clip.mkv", "series%d.png"},
      {"check", "clip.mkv"},
      {"check", "-k", "one.fn", "clip.mkv"},
      {"noise", "clip.mkv", "-o", "a.noise"},
      {"activity", "clip.mkv"},
      {"trace", "--pixel", "3,4", "--start", "0s", "--exposure", "3f", "clip.mkv"},
      {"validate", "--runs", "1", "--start", "0s", "--exposure", "3f", "clip.mkv"},
      {"batch", "list"},
      {"contact", "clip.mkv", "sheet.png"},
      {"sweep", "--start", "0s", "--exposure", "3f", "--shift", "0f..2f/1f", "clip.mkv", "sweep.png"},
      {"video", "--out-fps", "10", "clip.mkv", "film.mkv"},
      {"background", "clip.mkv", "plate.png"},
      {"mask", "--moving", "clip.mkv", "-o", "mask.pgm"},
      {"study", "clip.mkv", "-o", "study.png"},
      {"solve", "-k", "named.fn", "--wish", "all = 0.5s", "clip.mkv", "-o", "solved.fn"}};
  for (const auto& command : commands) {
    SCOPED_TRACE(testing::PrintToString(command));
    const auto told = make(Words(command) + "--json");
    const Json json = Json::parse(told.out);
    const Json& source = command.front() == "batch" ? json["clips"][0] : json;
    std::map<std::string, std::string> options;
    for (const Json& fact : source["facts"]) options[fact["fact"]] = fact["option"];
    EXPECT_EQ(options["transfer srgb, assumed"], "--transfer");
    EXPECT_EQ(options["matrix bt601, assumed"], "--matrix");
    expect_says(told.out, "\"notes\": [");
    if (command.front() == "noise") continue;  // which needs no times
    EXPECT_EQ(options["shutter 360 degrees, assumed"], "--shutter-angle");
    EXPECT_EQ(options["30 pictures a second, from the file"], "--fps");
    expect_says(told.out, "slow-motion files state their playback rate");
    EXPECT_EQ(told.err.find("note:"), std::string::npos) << "told twice";
  }
}

// A capture's option is that of retime; what was decided while its clip was decoded has none.
TEST_F(Facts, OfACaptureAreToldToScriptsWithWhatCorrectsThem) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i testsrc=s=64x48:r=30:d=0.5 -vf \"select='not(eq(n,5))'\" -fps_mode vfr "
             "-pix_fmt yuv420p -c:v ffv1 clip.mkv");
  make("encode clip.mkv clip.tik");
  const auto options_of = [&](const Words& words) {
    std::map<std::string, std::string> options;
    const Json json = answer(words);
    for (const Json& fact : json["facts"]) options[fact["fact"]] = fact.value("option", "none");
    return options;
  };
  auto info = options_of("info clip.tik");
  const std::string rate = "irregular times, 27.84 pictures a second on average, from the file";
  EXPECT_EQ(info.size(), 7u);
  EXPECT_EQ(info[rate], "--fps");
  EXPECT_EQ(info["transfer srgb, assumed"], "--transfer");
  EXPECT_EQ(info["matrix bt601, assumed"], "none");
  auto retimed = options_of("retime --in-place -a 180 clip.tik");
  EXPECT_EQ(retimed.size(), 7u);
  EXPECT_EQ(retimed[rate], "--fps");
  EXPECT_EQ(retimed["shutter 180 degrees, as stated"], "--shutter-angle");
  expect_says(run("retime --in-place -a 90 clip.tik").out,
              "samples, irregular times, 27.84 pictures a second on average, shutter 90 degrees");
}

// A check of a clip lists them, too.
TEST_F(Facts, OfAClipAreToldByACheck) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i testsrc=s=64x48:r=30:d=0.5 -pix_fmt yuv420p -c:v ffv1 clip.mkv");
  expect_says(make("check clip.mkv").err,
              {"transfer srgb (assumed)", "what is assumed can be stated (--shutter-angle, --transfer",
               "note: the rate of 30 a second comes from the file"});
}

}  // namespace
}  // namespace nutik::test

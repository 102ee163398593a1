// Captures of hours, months and years: every command takes them, and says their times as a person would.
#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "support/program_test.hpp"

namespace nutik::test {
namespace {

constexpr std::int64_t kHourNs = 3'600'000'000'000;
constexpr int kPictures = 12;

struct Lapse {
  const char* name;
  std::int64_t period_ns;
  const char* rate;
  const char* said;      // of the rate
  const char* duration;  // of all pictures
};

class TimeLapses : public ProgramTest, public testing::WithParamInterface<Lapse> {
 protected:
  // Stills, and a table of them in which each is exposed for a third of the time, at irregular times.
  void SetUp() override {
    std::string table = "file,start_ns,exposure_ns\n";
    const std::int64_t period_ns = GetParam().period_ns;
    for (int k = 0; k < kPictures; ++k) {
      const std::string name = format("f{:02}.pgm", k);
      std::string still = "P5\n16 16\n255\n";
      for (int i = 0; i < 256; ++i) still += static_cast<char>(i < 128 ? 30 : 10 + 20 * k);
      scratch_.write(name, still);
      table += format("{},{},{}\n", name, k * period_ns + k % 3, period_ns / 3);
    }
    scratch_.write("lapse.csv", table);
    scratch_.write("lapse.fn", format("M0 {{ [0:1], [{}:0.5] }}\n", 5 * period_ns));
    scratch_.write("named.fn", format("M0 {{ [0:a], [{}:a] }}\n", 5 * period_ns));
    scratch_.write("list.txt", "--start 0f --exposure 2f b1.png\n--start 2f --exposure 2f b2.png\n");
  }

  // Exposures whose times are whole nanoseconds alone, too: the command that `again` prints makes the same picture.
  void expect_again() const {
    ASSERT_EQ(run({"sweep", "--renderer", "reference", "--start", "0f", "--exposure", "1f", "--shift", "0f..11f/11f",
                   "--each", "each-%d.png", "--overwrite", "c.tik", "sweep.png"})
                  .status,
              0);
    const std::string before = read_file(scratch_ / "each-1.png");
    const ProgramResult again = run({"reproduce", "each-1.png"});
    ASSERT_EQ(again.status, 0) << again.err;
    scratch_.write("again.sh", again.out);
    std::filesystem::remove(scratch_ / "each-1.png");
    const ProgramResult made = run_shell("sh again.sh", scratch_.folder());
    EXPECT_EQ(made.status, 0) << again.out << made.err;
    EXPECT_TRUE(read_file(scratch_ / "each-1.png") == before) << again.out;
  }

  void expect_said_plainly(const std::vector<std::string>& words) const {
    const bool writes = words.front() != "check" && words.front() != "reproduce";
    const ProgramResult result = run(writes ? over(words) : words);
    EXPECT_EQ(result.status, 0) << words.front() << ": " << result.err;
    for (const char* odd : {"e+", " 0 samples", " 0 pictures", "every 0", "nan", "inf"}) {
      EXPECT_EQ((result.out + result.err).find(odd), std::string::npos)
          << words.front() << " says '" << odd << "': " << result.out << result.err;
    }
  }
};

TEST_P(TimeLapses, GoThroughEveryCommand) {
  const Lapse& lapse = GetParam();
  const std::string two = format("{}s", 2 * lapse.period_ns / 1'000'000'000);
  const std::string shifts = format("0s..{0}/{0}", two);
  const std::string speed = std::to_string(lapse.period_ns / 1'000'000'000);
  for (const std::vector<std::string>& encode :
       {std::vector<std::string>{"encode", "-f", lapse.rate, "f*.pgm", "c.tik"},
        {"encode", "lapse.csv", "c.tik"}}) {
    SCOPED_TRACE(encode[1]);
    expect_said_plainly(encode);
    const std::vector<std::vector<std::string>> commands{
        {"info", "c.tik"},
        {"info", "--json", "c.tik"},
        {"expose", "--start", "1f", "--exposure", "3f", "c.tik", "e.png"},
        {"expose", "--start", two, "--exposure", two, "c.tik", "e.png"},
        {"expose", "--functions", "lapse.fn", "c.tik", "g.png"},
        {"expose", "--start", "0f", "--exposure", "1f", "--every", "2f", "c.tik", "s-%02d.png"},
        {"reproduce", "e.png"},
        {"batch", "list.txt", "c.tik"},
        {"check", "--functions", "lapse.fn", "c.tik"},
        {"contact", "c.tik", "sheet.png"},
        {"contact", "--every", two, "c.tik", "sheet.png"},
        {"activity", "c.tik", "activity.png"},
        {"sweep", "--start", "0f", "--exposure", "1f", "--shift", "0f..4f/2f", "c.tik", "sweep.png"},
        {"sweep", "--start", "0f", "--exposure", "1f", "--shift", shifts, "c.tik", "sweep.png"},
        {"trace", "--pixel", "3,12", "--start", "0f", "--exposure", "4f", "c.tik"},
        {"trace", "--pixel", "3,12", "--start", "0f", "--exposure", "4f", "c.tik", "trace.png"},
        {"mask", "--moving", "c.tik", "mask.pgm"},
        {"background", "c.tik", "plate.png"},
        {"solve", "--functions", "named.fn", "--wish", "all = 0.1", "c.tik", "solved.fn"},
        {"thumbnail", "c.tik", "thumbnail.png"},
        {"retime", "--transfer", "linear", "c.tik", "linear.tik"},
        {"video", "--speed", speed, "--out-fps", "2", "c.tik", "video.mkv"},
        {"validate", "--start", "0f", "--exposure", "4f", "--json", "c.tik"},
    };
    for (std::vector<std::string> words : commands) {
      const bool renders = words.front() != "info" && words.front() != "mask" &&
                           words.front() != "activity" && words.front() != "check" &&
                           words.front() != "validate" && words.front() != "trace" &&
                           words.front() != "reproduce" && words.front() != "background" &&
                           words.front() != "thumbnail" && words.front() != "retime";
      if (renders) words.insert(words.begin() + 1, {"--renderer", "reference"});
      if (words.front() == "validate") {
        EXPECT_EQ(run(words).status, 0);  // errors are numbers with exponents
      } else {
        expect_said_plainly(words);
      }
    }
    expect_again();
    const std::string file = read_file(scratch_ / "c.tik");
    scratch_.write("cut.tik", std::string_view(file).substr(0, file.size() - 50));
    std::filesystem::remove(scratch_ / "mended.tik");
    expect_said_plainly({"recover", "cut.tik", "-o", "mended.tik"});
    const std::string info = run({"info", "c.tik"}).out;
    if (encode[1] != "-f") continue;  // a table ends with its last exposure
    expect_says(info, lapse.said);
    expect_says(info, lapse.duration);
  }
}

// What the program advises is what it takes.
TEST_P(TimeLapses, AreToldAnIntervalThatFitsASheet) {
  const Lapse& lapse = GetParam();
  ASSERT_EQ(run({"encode", "-f", lapse.rate, "f*.pgm", "c.tik"}).status, 0);
  const ProgramResult refused = run({"contact", "--renderer", "reference", "--every",
                                     format("{}ns", lapse.period_ns / 1000), "c.tik", "s.png"});
  EXPECT_EQ(refused.status, 2);
  const std::string before = "take --every ";
  const auto at = refused.err.find(before);
  ASSERT_NE(at, std::string::npos) << refused.err;
  const std::string every =
      refused.err.substr(at + before.size(), refused.err.find(' ', at + before.size()) - at - before.size());
  const ProgramResult taken = run({"contact", "--renderer", "reference", "--every", every, "c.tik", "s.png"});
  EXPECT_EQ(taken.status, 0) << every << ": " << taken.err;
}

INSTANTIATE_TEST_SUITE_P(
    , TimeLapses,
    testing::Values(Lapse{"Hourly", kHourNs, "1/3600", "a sample every 3600 s", "12 h"},
                    Lapse{"Daily", 24 * kHourNs, "1/86400", "a sample every 24 h", "288 h"},
                    Lapse{"Yearly", 365 * 24 * kHourNs, "1/31536000", "a sample every 8760 h", "4380 days"}),
    [](const auto& lapse) { return std::string(lapse.param.name); });

using Times = ProgramTest;

TEST_F(Times, BelowANanosecondAreRefused) {
  scratch_.write("f0.pgm", "P5\n1 1\n255\nA");
  scratch_.write("f1.pgm", "P5\n1 1\n255\nB");
  expect_refused({"encode", "-f", "1000000000000", "f*.pgm", "c.tik"}, 2, "more than nine digits");
  expect_refused({"encode", "-f", "1000000000", "--shutter-angle", "90", "f*.pgm", "c.tik"}, 2,
                 "exposes for less than 1 ns, the shortest time a capture knows");
  ASSERT_EQ(run({"encode", "-f", "1000000000", "f*.pgm", "c.tik"}).status, 0);
  expect_refused({"expose", "--start", "0s", "--exposure", "1ps", "c.tik", "p.png"}, 2, "'1ps' is no time");
  expect_refused({"expose", "--start", "0s", "--exposure", "1/10000000000s", "c.tik", "p.png"}, 2,
                 "shorter than a nanosecond");
}

TEST_F(Times, LongerThanACaptureLastsAreRefused) {
  scratch_.write("f0.pgm", "P5\n1 1\n255\nA");
  scratch_.write("f1.pgm", "P5\n1 1\n255\nB");
  for (const char* name : {"f2.pgm", "f3.pgm", "f4.pgm"}) scratch_.write(name, "P5\n1 1\n255\nC");
  expect_refused({"encode", "-f", "1/999999999", "f*.pgm", "c.tik"}, 2, "longer than 146 years");
  scratch_.write(
      "t.csv", "file,start_ns,exposure_ns\nf0.pgm,-4000000000000000000,10\nf1.pgm,4000000000000000000,10\n");
  expect_refused({"encode", "t.csv", "c.tik"}, 3, "a clip lasts 4611686018427387904 ns (146 years) at most");
}

}  // namespace
}  // namespace nutik::test

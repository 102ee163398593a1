// Captures of parts of a clip, joined on the command line.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/app_test.hpp"
#include "support/still_clip.hpp"

namespace nutik::test {
namespace {

class Join : public AppTest {
 protected:
  static constexpr int kStills = 101;

  void SetUp() override { write_still_clip(scratch_.folder(), 12, kStills); }

  void done(const Words& words) const { make(over(words)); }
  void encode(const std::string& from, const std::string& to, const std::string& output, const Words& more = {}) const {
    done(Words{"encode", "-q", "-f", "100", "--from", from, "--to", to, "frames", "-o", output} + more);
  }
  [[nodiscard]] std::string exposed(const std::string& capture, const Words& words) const {
    done("expose --no-recipe -q -o p.pfm " + capture + words);
    return file("p.pfm");
  }
};

TEST_F(Join, ExposesWhatTheCaptureInOneGoDoes) {
  done("encode -q -f 100 -a 180 frames whole.tik");
  // Half a second and so on: neither whole blocks nor parts of one length.
  encode("0s", "0.64s", "a.tik", {"-a", "180"});
  encode("0.64s", "0.65s", "b.tik", {"-a", "180"});
  encode("0.65s", "9s", "c.tik", {"-a", "180"});
  const auto joined = make("join b.tik c.tik a.tik -o joined.tik");
  EXPECT_TRUE(joined.out.starts_with("joined.tik: 12 x 12 grey, 101 samples of 3 captures, 1.01 s, "))
      << joined.out;
  EXPECT_EQ(joined.err, "");
  for (const Words words : {"--start 0s --exposure 1s", "--start 0.62s --exposure 50ms", "--start 642ms --exposure 3ms",
                            "--start 0.3s --exposure 0.6s --shutter hann"}) {
    const Words fixed = words + "--precision fixed";
    EXPECT_TRUE(exposed("joined.tik", fixed) == exposed("whole.tik", fixed)) << words[1];
  }
  // Seams between blocks leave the same blocks, and so the same bytes in any arithmetic.
  encode("64f", "101f", "bc.tik", {"-a", "180"});
  done("join -q a.tik bc.tik -o blocks.tik");
  const Words all("--start 0s --exposure 1s");
  EXPECT_TRUE(exposed("blocks.tik", all) == exposed("whole.tik", all));
}

TEST_F(Join, TellsWhatWasJoined) {
  encode("0f", "64f", "a.tik");
  encode("64f", "101f", "b.tik");
  const auto json = answer("join a.tik b.tik -o w.tik");
  EXPECT_EQ(json["samples"], 101);
  EXPECT_EQ(json["parts"][1]["capture"], "b.tik");
  EXPECT_EQ(json["parts"][1]["first_sample"], 64);
  EXPECT_EQ(json["duration_ns"], 1'010'000'000);
  expect_says(run("info w.tik").out, "joined of 2 captures, a.tik … b.tik");
  const auto part = answer("info b.tik")["part"];
  EXPECT_EQ(part["clip"], "frames");
  EXPECT_EQ(part["first_picture"], 64);
  EXPECT_EQ(part["start_ns"], 640'000'000);
  EXPECT_EQ(part["pictures"], 101);
  EXPECT_EQ(run("join -q --overwrite a.tik b.tik -o w.tik").out, "");
  const auto lines = run("join --progress --overwrite a.tik b.tik -o w.tik");
  EXPECT_TRUE(lines.err.starts_with("Progress: ")) << lines.err;
}

// Every sample is checked against the clip, within what is no change.
TEST_F(Join, IsWithinWhatIsNoChange) {
  done("noise -q --crop 12x3+0+9 frames -o camera.noise");
  for (const std::vector<std::string>& change :
       {std::vector<std::string>{"--tolerance", "7"}, {"--noise", "camera.noise"}}) {
    encode("0f", "37f", "a.tik", change);
    encode("37f", "38f", "b.tik", change);
    encode("38f", "101f", "c.tik", change);
    done("join -q a.tik b.tik c.tik -o w.tik");
    make("validate -q --source frames --start 0s --exposure 10ms --runs 1 w.tik");
  }
}

TEST_F(Join, IsRefused) {
  encode("0f", "64f", "a.tik");
  encode("65f", "101f", "b.tik");
  encode("64f", "101f", "c.tik", {"--tolerance", "2"});
  const std::string way = "nutik-cl join a.tik b.tik -o whole.tik";
  expect_refused("join", 2, way);
  expect_refused("join a.tik -o w.tik", 2, way);
  expect_refused("join a.tik b.tik", 2, way);
  expect_refused(2, {{"join a.tik b.tik -o b.tik", "b.tik"}, {"join a.tik b.tik -o w.png", ".tik"}});
  expect_refused(3, {{"join a.tik b.tik -o w.tik", "encode them, and join all parts (--from, --to)"},
                     {"join a.tik c.tik -o w.tik", "a tolerance of 0 codes, and c.tik has"},
                     {"join a.tik frames/000.pgm -o w.tik", "frames/000.pgm"},
                     {"join a.tik absent.tik -o w.tik", "absent.tik"}});
  EXPECT_FALSE(exists("w.tik"));
}

}  // namespace
}  // namespace nutik::test

// Shutter shapes through the program: as text, and as exposures.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/clips.hpp"
#include "support/still_clip.hpp"

namespace nutik::test {
namespace {

class ShutterCommand : public AppTest {
 protected:
  std::string out(const Words& words) const {
    const bool writes = words.front() != "shutter";
    return make(writes ? Words(over(words)) : words).out;
  }
};

TEST_F(ShutterCommand, WritesALineForAFunctionFile) {
  EXPECT_EQ(out("shutter box --start 0.4s --exposure 10ms --tag 128"),
            "# box from 400ms for 10ms\nM128 [399999999:0], [400000000:1], [410000000:1], [410000001:0]\n");
  EXPECT_EQ(out("shutter triangle --exposure 1/3s --ev -1"),
            "# triangle from 0s for 1000000000/3ns\nM0 [0:0], [166666667:0.5], [333333333:0]\n");
  // Pictures of a clip with a half open shutter: from the start of one to the end of another.
  EXPECT_EQ(out("shutter box --start 2f --exposure 3f -f 1000 -a 180 --gain 3"),
            "# box from 2f for 3f\nM0 [1999999:0], [2000000:3], [4500000:3], [4500001:0]\n");
}

// Pictures of a capture are counted on its own times, which need not be regular.
TEST_F(ShutterCommand, CountsThePicturesOfACapture) {
  std::string table = "file,start_ns,exposure_ns\n";
  const std::int64_t starts_ms[] = {0, 40, 50, 290, 300};
  for (int k = 0; k < 5; ++k) {
    const std::string name = std::to_string(k) + ".pgm";
    scratch_.write(name, "P2 2 1 255\n" + std::to_string(50 * k) + " " + std::to_string(10 + 50 * k) + "\n");
    table += name + "," + std::to_string(starts_ms[k] * 1'000'000) + ",10000000\n";
  }
  scratch_.write("stills.csv", table);
  out("stills.csv clip.tik");
  const Words box("shutter box --start 3f --exposure 1f");
  const std::string want =
      "# box from 3f for 1f\nM0 [289999999:0], [290000000:1], [300000000:1], [300000001:0]\n";
  EXPECT_EQ(out(box + "clip.tik"), want);
  EXPECT_EQ(out(box + "stills.csv"), want) << "a clip that was not encoded";
  EXPECT_EQ(out(box + "-f 50 stills.csv"),
            "# box from 3f for 1f\nM0 [59999999:0], [60000000:1], [80000000:1], [80000001:0]\n");
  // It exposes just that picture, with what a search for a moment prints.
  scratch_.write("f.fn", want);
  out("-k f.fn clip.tik a.pgm");
  out("--start 3f --exposure 1f clip.tik b.pgm");
  EXPECT_EQ(read_all(*open_test_clip(scratch_ / "a.pgm")), read_all(*open_test_clip(scratch_ / "b.pgm")));
  const Words counted = "shutter box clip.tik" + Words(out("activity --moment quietest clip.tik"));
  EXPECT_EQ(out(counted).substr(0, 11), "# box from ");
  expect_refused(
      2,
      {{"shutter box -f 50 --start 3f --exposure 1f clip.tik", "--fps describes a clip that is encoded"},
       {"shutter box --start 5f --exposure 1f clip.tik", "picture 5 is outside the capture, which has 5"}});
}

TEST_F(ShutterCommand, SaysWhatIsWrong) {
  expect_refused(
      2, {{"shutter", "shutter takes one shape"},
          {"shutter hann", "how long is the exposure? Add --exposure 10ms"},
          {"shutter hat --exposure 1s", "shutter 'hat' is not known; choose box"},
          {"shutter hann --exposure 3f",
           "name the capture behind the shape, add --fps where its rate is constant, or write times"},
          {"shutter hann --exposure 3s --tag 256", "tag '256' is no whole number of 0 … 255"},
          {"shutter hann --exposure 3s --shutter-error 0", "--shutter-error 0 is no share from 1e-06 to 1"},
          {"shutter box --start 3999999999s --exposure 1s", "the gain jumps at a last possible time"},
          {"shutter hann --exposure 50ns", "too short for the shutter hann"}});
}

// The shape as an option, and its text as a function file: the same light but for the steps of 1 ns.
TEST_F(ShutterCommand, GivesTheExposureThatTheOptionGives) {
  write_still_clip(scratch_.folder(), 24, 40);
  out("-f 40 frames clip.tik");
  for (const std::string shape : {"box", "hann", "gaussian", "strobe:3", "spline:0=0,0.2=1,1=-0.5"}) {
    scratch_.write("f.fn", out({"shutter", shape, "--start", "0.1s", "--exposure", "0.4s"}));
    for (const std::string by : {"support", "integral", "absolute", "seconds:0.3"}) {
      out({"--start", "0.1s", "--exposure", "0.4s", "--shutter", shape, "--normalize", by, "clip.tik",
           "a.pfm"});
      out({"-k", "f.fn", "--normalize", by, "clip.tik", "b.pfm"});
      const std::vector<float> a = read_pfm(scratch_ / "a.pfm"), b = read_pfm(scratch_ / "b.pfm");
      ASSERT_EQ(a.size(), b.size());
      // Each jump adds or takes half a nanosecond of 0.4 s.
      for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-6) << shape << ", " << by;
    }
  }
}

// By hand: a still scene of one code under functions whose integrals are plain.
TEST_F(ShutterCommand, NormalizesAsItSays) {
  write_frames(10, [](int) { return cv::Mat_<std::uint8_t>({1, 2}, {51, 102}); });
  out("-f 10 --transfer linear frames clip.tik");
  struct Case {
    Words words;
    float light;  // of code 51, 0.2 in light
  };
  const Words triangle("--start 0.2s --exposure 0.4s --shutter triangle");
  for (const Case& wanted :
       {Case{{}, 0.1f}, Case{{"--normalize", "support"}, 0.1f}, Case{{"--normalize", "integral"}, 0.2f},
        Case{{"--normalize", "absolute"}, 0.2f}, Case{{"--normalize", "seconds:1"}, 0.04f},
        Case{{"--gain", "3"}, 0.3f}, Case{{"--ev", "2"}, 0.4f},
        Case{{"--normalize", "integral", "--ev", "-1", "--gain", "-3"}, -0.3f}}) {
    for (const std::string renderer : {"opencl", "reference"}) {
      out(triangle + wanted.words + "clip.tik a.pfm --renderer" + renderer);
      const std::vector<float> light = read_pfm(scratch_ / "a.pfm");
      ASSERT_EQ(light.size(), 2u);
      EXPECT_FLOAT_EQ(light[0], wanted.light) << renderer;
      EXPECT_FLOAT_EQ(light[1], 2 * wanted.light);
    }
  }
  // Negative parts, two functions, one of which cancels: only an error where the mask uses it.
  scratch_.write("f.fn",
                 "M0 [0:1], [100000000:1], [100000001:-1], [200000000:-1], [200000001:0]\n"
                 "M1 [0:-3], [100000000:-3], [100000001:0]\n");
  scratch_.write("mask.pgm", "P2 2 1 255\n1 1\n");
  out("-k f.fn -m mask.pgm --normalize integral clip.tik a.pfm");
  EXPECT_FLOAT_EQ(read_pfm(scratch_ / "a.pfm")[0], 0.2f);
  out("-k f.fn -m mask.pgm --normalize absolute clip.tik a.pfm");
  EXPECT_FLOAT_EQ(read_pfm(scratch_ / "a.pfm")[0], -0.2f);
  scratch_.write("mask.pgm", "P2 2 1 255\n0 1\n");
  expect_refused({"-k", "f.fn", "-m", "mask.pgm", "--normalize", "integral", "clip.tik", "b.pfm"}, 3,
                 "M0: the positive and negative parts of its gains cancel");
}

}  // namespace
}  // namespace nutik::test

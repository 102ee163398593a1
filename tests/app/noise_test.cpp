// A camera's noise through the program: measuring it, encoding with it, exposing with it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "capture/noise_file.hpp"
#include "support/app_test.hpp"
#include "support/noisy_scene.hpp"
#include "support/stills.hpp"
#include "tik/reader.hpp"

namespace nutik::test {
namespace {

class Noise : public AppTest {
 protected:
  // Writes stills of a wedge, brighter or darker, into a folder.
  void film(const std::string& folder, double brightest, std::uint64_t seed, std::uint64_t count = 40,
            std::uint32_t white = 255, const Light& light = {}) {
    const NoisyCamera camera = camera_of({120, 64, 3}, white, Transfer::srgb());
    const Rasters rasters = test::film(camera, count, seed, light ? light : still_wedge(camera, 0.02, brightest));
    std::filesystem::create_directory(scratch_ / folder);
    for (std::size_t k = 0; k < rasters.size(); ++k) {
      Picture still(camera.format.shape, white > 255 ? ValueType::code16 : ValueType::code8, white);
      still.bytes = rasters[k];
      scratch_.write(folder + "/" + std::to_string(1000 + k) + ".ppm", netpbm_file(still, false));
    }
  }

  ProgramResult run(const Words& words) const {
    const bool writes = words.front() != "info";
    return make(writes ? Words(over(words)) : words);
  }

  [[nodiscard]] CameraNoise noise_in(const std::string& name) const {
    return parse_noise(read_file(scratch_ / name), name);
  }
};

TEST_F(Noise, IsMeasuredOnSeveralExposures) {
  film("dark", 0.2, 1);
  film("bright", 0.8, 2);
  expect_says(run("noise dark bright -o camera.noise").out, "camera.noise: measured on 80 samples");
  const CameraNoise noise = noise_in("camera.noise");
  const NoisyCamera camera;
  for (const ChannelNoise& channel : noise.channels) {
    EXPECT_NEAR(channel.read, camera.read, 0.06 * camera.read);
    EXPECT_NEAR(channel.shot, camera.shot, 0.06 * camera.shot);
  }
  expect_says(read_file(scratch_ / "camera.noise"), "# measured on bright\n");
}

TEST_F(Noise, GivesTheSamePictureFromAClipAndFromItsCapture) {
  film("clip", 0.8, 3);
  run("noise clip -o camera.noise");
  for (const char* noise : {"camera.noise", "auto"}) {
    const Words source = "-f 100 --sigmas 2.5 --block-samples 16 --noise" + Words(noise);
    run("encode clip -o clip.tik" + source);
    // Within a block, across two, and of the last one, which is not full.
    for (const char* start : {"3f", "14f", "38f"}) {
      const Words exposure{"--exposure", "2f", "--start", start};
      run(exposure + "clip.tik -o a.pfm");
      run(exposure + "clip -o b.pfm" + source);
      EXPECT_EQ(file("a.pfm"), file("b.pfm")) << noise << start;
      run(exposure + "clip.tik --renderer reference --no-recipe -o c.png");
      run(exposure + "clip --renderer reference --no-recipe -o d.png" + source);
      EXPECT_EQ(file("c.png"), file("d.png")) << noise << start;
    }
  }
  const tik::Reader reader(scratch_ / "clip.tik");
  EXPECT_EQ(reader.format().noise.camera, noise_in("camera.noise"));  // auto measures the same
  EXPECT_EQ(reader.format().noise.sigmas, 2.5);
  const auto info = answer("info clip.tik");
  EXPECT_EQ(info["noise"]["sigmas"], 2.5);
  EXPECT_EQ(info["noise"]["codes_times"], 257);
  EXPECT_EQ(info["noise"]["at_nine_tenths"][0], reader.format().noise.camera->sd(0, 0.9 * 255));
  EXPECT_TRUE(info["is_damaged"].is_null()) << "no sample is looked at";
}

TEST_F(Noise, InfoTellsWhatIsHeld) {
  film("clip", 0.8, 4);
  run("encode -f 100 --noise auto clip -o clip.tik");
  const std::string info = run("info clip.tik").out;
  expect_says(info, {"16 bits, white code 65535", "means of the source's, whose white code is 255, times 257",
                     "beyond 3 sigmas of the noise", "codes of the source at a tenth of white", "% of 922 kB raw"});
  const auto at = info.find(" % of samples");
  const double share = std::stod(info.substr(info.rfind(' ', at - 1)));
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 2.0);
}

TEST_F(Noise, SaysThatItsTransferIsAnother) {
  film("clip", 0.8, 6);
  run("noise -q clip -o camera.noise");
  const auto said = [&](const std::string& file, const std::string& transfer) {
    return run({"encode", "-f", "100", "clip", "-o", "clip.tik", "--noise", file, "--transfer", transfer})
        .err;
  };
  EXPECT_EQ(said("camera.noise", "srgb"), "");
  expect_says(said("camera.noise", "linear"),
              "note: camera.noise says transfer srgb and the clip's is linear: "
              "read and shot noise are in light, and come to other codes");
  std::string edited = read_file(scratch_ / "camera.noise");
  edited.replace(edited.find("transfer srgb"), 13, "transfer bt709");
  scratch_.write("edited.noise", edited);
  expect_says(said("edited.noise", "srgb"), "edited.noise says transfer bt709 and the clip's is srgb");
  // Points are in codes already.
  scratch_.write("points.noise",
                 "nutik noise 0\nwhite 255\ntransfer linear\nchannel red\ncurve points\npoint 9 2 1\n"
                 "channel green\ncurve points\npoint 9 2 1\nchannel blue\ncurve points\npoint 9 2 1\n");
  EXPECT_EQ(said("points.noise", "srgb"), "");
}

// A wave passes through the whole picture: every pixel strays alike, and no pixel for itself.
TEST_F(Noise, IsNotMeasuredOnWhatMoves) {
  film("pour", 0, 7, 20, 255, [](std::uint64_t value, std::uint64_t sample) {
    const auto x = static_cast<double>(value / 3 % 120), y = static_cast<double>(value / 360);
    return 0.4 + 0.1 * std::sin(0.2 * x + 0.1 * y + 2.1 * static_cast<double>(sample));
  });
  expect_refused("encode -f 100 --noise auto pour a.tik", 3,
                 "pour: no noise can be measured on it: pixels 4 apart vary together");
  EXPECT_FALSE(exists("a.tik"));
  expect_says(run("noise pour -o pour.noise").err, "note: pixels 4 apart vary together");
}

// Waves that stand still, or whose light does not: by less than noise, so that no pixel is seen to change.
TEST_F(Noise, IsNotMeasuredOnWhatMovesWithinIt) {
  const auto waves = [this](const std::string& folder, double pixels, double brighter, double of_eighth) {
    film(folder, 0, 7, 64, 255, [=](std::uint64_t value, std::uint64_t sample) {
      const auto x = static_cast<double>(value / 3 % 120), y = static_cast<double>(value / 360);
      const auto k = static_cast<double>(sample);
      const double still = 0.3 + 0.1 * std::sin(0.3 * (x + pixels * k)) * std::sin(0.2 * y);
      const double poured = x >= 60 && x < 75 ? of_eighth * std::sin(0.3 * x + 0.25 * y + 2.1 * k) : 0;
      return still * (1 + brighter * std::sin(0.9 * k)) + poured;
    });
  };
  const auto refused = [this](const std::string& folder, const std::string& said) {
    expect_refused({"encode", "-f", "100", "--noise", "auto", folder, "a.tik"}, 3, said);
    EXPECT_FALSE(exists("a.tik"));
  };
  waves("panned", 0.1, 0, 0);
  refused(
      "panned",
      "panned: no noise can be measured on it: where pixels seem to stand still their light strays from what would be "
      "held for it by 0.");
  refused("panned",
          "in pictures 0 … 63): the camera or the scene moves, or a codec holds what it thinks is still. "
          "Take the "
          "noise of a still scene, filmed with the same settings and not compressed, or a tolerance; or an "
          "aligned "
          "camera (--align rigid), a part that stands still (--crop, --from, --to)");
  waves("flickers", 0, 0.03, 0);
  refused("flickers", "the brightness of the whole picture drifts or flickers. Take");
  refused("flickers",
          "; or evened brightness (--deflicker), a part that stands still (--crop, --from, --to)");
  run("encode -q -f 100 --noise auto --deflicker flickers -o evened.tik");
  waves("poured", 0, 0, 0.03);
  refused("poured", "standard deviations of the noise, and the limit is 0.2");
  run("encode -q -f 100 --noise auto --crop 56x64+0+0 poured -o left.tik");
  // So little of it that the rest is worth it.
  waves("dripped", 0, 0, 0.012);
  expect_says(run("encode -f 100 --noise auto dripped -o dripped.tik").err,
              "% of the picture light changes by less than its noise: what is held there is off by up to 0.");
  waves("still", 0, 0, 0);
  EXPECT_EQ(run("encode -f 100 --noise auto still -o still.tik").err, "");
}

// A camera that is held by hand, two drops that merge; a beam whose lamps flicker; particles that stand still.
TEST_F(Noise, IsMeasuredOnRecordingsThatStandStillAlone) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "README.md")) GTEST_SKIP() << "no clips in " << media;
  for (const char* name : {"realshort.mp4", "cine_781.cine"}) {
    expect_refused({"encode", "-f", "100", "--noise", "auto", (media / name).string(), "a.tik"}, 3,
                   "% of the codes some pixels vary more than others, as noise of a sensor does not");
  }
  expect_refused({"encode", "--noise", "auto", (media / "data_small_cine.cine").string(), "a.tik"}, 3,
                 "the brightness of the whole picture drifts or flickers");
  run({"encode", "-f", "100", "--noise", "auto", (media / "stuck.tif").string(), "a.tik"});
}

TEST_F(Noise, SaysWhatCannotBe) {
  film("clip", 0.8, 5, 4);
  film("short", 0.8, 5, 2);
  film("deep", 0.8, 5, 4, 4095);
  run("noise -q clip -o camera.noise");
  run("encode -q -f 100 clip -o clip.tik");
  expect_refused(
      2, {{"noise", "a clip of a still scene is missing"}, {"noise clip.tik", "clip.tik is a capture"}});
  expect_refused(
      3, {{"noise absent.mp4", "absent.mp4"},
          {"noise short -o a.noise", "2 pictures of a still scene"},
          {"noise clip deep -o a.noise",
           "deep is of another kind than clip: 120 x 64 pixels, 3 channels, 16 bits, white code 4095"}});
  expect_refused("noise clip -o clip.tik", 2, "clip.tik is no name for a text");
  const Words encode("encode -f 100 clip -o b.tik");
  expect_refused(2, {{encode + "--noise camera.noise --tolerance 2", "leave one out"},
                     {encode + "--sigmas 2", "--sigmas counts standard deviations of a camera's noise"},
                     {encode + "--noise auto --sigmas 0", "--sigmas '0' is no number of 0.1 … 100"}});
  expect_refused(encode + "--noise absent.noise", 3, "absent.noise");
  scratch_.write("wrong.noise", "nutik noise 0\nwhite 255\ntransfer srbg\n");
  expect_refused(encode + "--noise wrong.noise", 3, "wrong.noise:3:10: transfer 'srbg' is not known");
  expect_refused(2, {{"encode -f 100 deep -o b.tik --noise camera.noise",
                      "the noise was measured with white code 255 and the clip's is 4095"},
                     {"--start 0f --exposure 1f --noise auto clip.tik", "--noise describes a clip"}});
  for (const char* name : {"a.noise", "b.tik"}) EXPECT_FALSE(exists(name)) << name;
}

}  // namespace
}  // namespace nutik::test

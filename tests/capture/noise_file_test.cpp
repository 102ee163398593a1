#include "capture/noise_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/error.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

constexpr const char* kGrey =
    "nutik noise 0\n"
    "white 255\n"
    "transfer srgb\n"
    "channel grey\n"
    "read 0.002\n"
    "shot 0.0001\n"
    "curve sensor\n"
    "point 10 1.5 100\n"
    "point 20.5 2 50\n";

std::string mistakes_in(std::string_view text) {
  return message_of<InputError>([&] { return parse_noise(text, "camera.noise"); });
}

// kGrey with `line` in place of its line `number`, from 1.
std::string with_line(int number, std::string_view line) {
  std::string text;
  std::string_view rest = kGrey;
  for (int i = 1; !rest.empty(); ++i) {
    const auto end = rest.find('\n');
    text.append(i == number ? line : rest.substr(0, end)).append("\n");
    rest.remove_prefix(end + 1);
  }
  return text;
}

TEST(NoiseFile, GivesBackWhatWasWritten) {
  CameraNoise noise{4095, Transfer::gamma(2.2), {}};
  for (int channel = 0; channel < 3; ++channel) {
    ChannelNoise each{channel == 1 ? NoiseCurve::points : NoiseCurve::sensor, 0.1 / 3, 1e-7 / 3, {}};
    for (int point = 0; point <= channel; ++point) {
      each.points.push_back({point + 1.0 / 3, 2.0 / 3, static_cast<std::uint64_t>(1) << (20 * point)});
    }
    noise.channels.push_back(each);
  }
  const std::vector<std::string> comments{"from a clip"};
  EXPECT_EQ(parse_noise(noise_text(noise, comments), "a.noise"), noise);
  noise.channels.resize(1);
  EXPECT_EQ(parse_noise(noise_text(noise, {}), "a.noise"), noise);
  std::string lines;
  for (const std::string& line : noise_lines(noise)) lines += line + "\n";
  EXPECT_EQ(parse_noise(lines, "a.noise"), noise);
}

TEST(NoiseFile, SaysWhereAMistakeIs) {
  EXPECT_EQ(mistakes_in(kGrey), "");
  EXPECT_EQ(mistakes_in(""),
            "camera.noise:1:1: an empty noise file; it starts with the line 'nutik noise 0'");
  EXPECT_EQ(
      mistakes_in(with_line(1, "nutik noise 1")),
      "camera.noise:1:1: a noise file starts with the line 'nutik noise 0'; this one with 'nutik noise 1'");
  EXPECT_EQ(mistakes_in(with_line(2, "white 2.5")), "camera.noise:2:7: the white code is a whole number");
  EXPECT_EQ(mistakes_in(with_line(2, "white 70000")),
            "camera.noise:2:7: white code '70000' is no number of 1 … 65535");
  EXPECT_EQ(mistakes_in(with_line(3, "transfer sRGB")),
            "camera.noise:3:10: transfer 'sRGB' is not known; choose srgb, bt709, linear or gamma:G");
  EXPECT_EQ(mistakes_in(with_line(3, "")),
            "camera.noise:4:1: white and transfer must be stated before the first channel");
  EXPECT_EQ(mistakes_in(with_line(4, "channel green")),
            "camera.noise:4:9: channel 'green' where grey or red was expected; a file has grey alone, or "
            "red, green "
            "and blue in this order");
  EXPECT_EQ(mistakes_in(with_line(4, "channel red")),
            "camera.noise:9:16: 1 of 3 channels; red, green and blue are needed");
  EXPECT_EQ(mistakes_in(with_line(4, "")),
            "camera.noise:5:1: 'read' stands before the first channel\n"
            "camera.noise:6:1: 'shot' stands before the first channel\n"
            "camera.noise:7:1: 'curve' stands before the first channel\n"
            "camera.noise:8:1: 'point' stands before the first channel\n"
            "camera.noise:9:1: 'point' stands before the first channel");
  EXPECT_EQ(mistakes_in(with_line(5, "read -0.1")), "camera.noise:5:6: read '-0.1' is no number of 0 … 1");
  EXPECT_EQ(mistakes_in(with_line(5, "read nan")), "camera.noise:5:6: read 'nan' is no number of 0 … 1");
  EXPECT_EQ(mistakes_in(with_line(6, "read 0.1")),
            "camera.noise:6:1: 'read' is stated twice for this channel");
  EXPECT_EQ(mistakes_in(with_line(6, "")),
            "camera.noise:4:1: this channel uses 'curve sensor' and must say read and shot");
  EXPECT_EQ(
      mistakes_in(with_line(7, "")),
      "camera.noise:4:1: this channel does not say which curve is used: 'curve sensor' or 'curve points'");
  EXPECT_EQ(mistakes_in(with_line(7, "curve spline")),
            "camera.noise:7:7: curve 'spline' is not known; choose sensor or points");
  EXPECT_EQ(mistakes_in(with_line(8, "point 10 1.5")),
            "camera.noise:8:10: 'point' takes 3 values, not 2: point CODE SD PIXELS");
  EXPECT_EQ(mistakes_in(with_line(8, "point 30 1.5 7")),
            "camera.noise:9:7: code 20.5 is not above the one before, 30; codes must increase");
  EXPECT_EQ(mistakes_in(with_line(8, "point 10 0 7")),
            "camera.noise:8:10: standard deviation '0' is no number of 0.001 … 255");
  EXPECT_EQ(
      mistakes_in(with_line(8, "pont 10 1 7")),
      "camera.noise:8:1: 'pont' is no key; a line starts with white, transfer, channel, read, shot, curve "
      "or point");
  EXPECT_EQ(mistakes_in("nutik noise 0\nwhite 255\ntransfer srgb\n"),
            "camera.noise:3:14: no channel; write 'channel grey', or red, green and blue");
}

TEST(NoiseFile, TakesCommentsBlanksAndWindowsLineEnds) {
  const CameraNoise plain = parse_noise(kGrey, "camera.noise");
  std::string typed = "\xEF\xBB\xBF# my camera, ISO 800\r\n\r\n";
  for (const char c : std::string(kGrey)) {
    if (c == '\n') {
      typed += "  # a note\r\n";
    } else {
      typed += c == ' ' ? std::string("\t ") : std::string(1, c);
    }
  }
  EXPECT_EQ(parse_noise(typed, "camera.noise"), plain);
}

TEST(CameraNoise, IsWhatItsFormulaSays) {
  CameraNoise noise = parse_noise(kGrey, "camera.noise");
  noise.transfer = Transfer::linear();
  for (const double code : {0.0, 51.0, 255.0}) {  // linear: the slope is 255 codes for each unit of light
    const double in_light = 0.002 * 0.002 + 0.0001 * code / 255;
    EXPECT_NEAR(noise.sd(0, code), std::sqrt(255 * 255 * in_light + 1.0 / 12), 1e-12);
  }
  noise.channels[0].curve = NoiseCurve::points;
  EXPECT_EQ(noise.sd(0, 0), 1.5);
  EXPECT_EQ(noise.sd(0, 10), 1.5);
  EXPECT_NEAR(noise.sd(0, 15.25), 1.75, 1e-12);
  EXPECT_EQ(noise.sd(0, 255), 2);
}

TEST(CameraNoise, LightAndCodeStandardDeviationsAreInverse) {
  for (const Transfer& transfer :
       {Transfer::srgb(), Transfer::bt709(), Transfer::linear(), Transfer::gamma(2.2)}) {
    for (const double code : {0.0, 3.0, 100.0, 255.0}) {
      for (const double light_sd : {1e-3, 0.01, 0.1}) {
        const double code_sd = code_sd_of(light_sd, code, 255, transfer);
        EXPECT_NEAR(light_sd_of(code_sd, code, 255, transfer), light_sd, 1e-6 * light_sd)
            << transfer.text() << ", code " << code;
      }
    }
  }
  EXPECT_EQ(light_sd_of(0.1, 100, 255, Transfer::srgb()), 0);  // less than rounding alone
}

}  // namespace
}  // namespace nutik::test

// One brightness for a person to see, whichever command shows a capture; files that say what they hold.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "capture/format.hpp"
#include "capture/transfer.hpp"
#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

class Colour : public AppTest {
 protected:
  void succeed(const Words& words) const { make(over(words)); }

  // A still scene of a linear 12-bit camera: even fields of 64 x 64 pixels, from light 0.01 to 1.
  void write_scene() const {
    std::filesystem::create_directories(scratch_ / "scene");
    Picture picture({256, 64, 1}, ValueType::code16, 4095);
    const auto codes = picture.values<std::uint16_t>();
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = kCodes[i % 256 / 64];
    for (const char* name : {"scene/a.pgm", "scene/b.pgm", "scene/c.pgm", "scene/d.pgm"}) {
      scratch_.write(name, netpbm_file(picture, true));
    }
  }
  static constexpr std::uint16_t kCodes[] = {41, 410, 1638, 4095};

  // What a screen shows of a field, as 8-bit sRGB.
  static int shown(std::size_t field) {
    return static_cast<int>(std::lround(255 * Transfer::srgb().fraction_of(kCodes[field] / 4095.0)));
  }
};

TEST_F(Colour, OfALinearCaptureIsTheSameInPictureSheetAndVideo) {
  write_scene();
  succeed("-q -f 30 scene scene.tik");
  succeed("--start 0s --exposure 0.1s scene.tik picture.png");
  succeed("contact --every 4f --columns 1 --width 280 scene.tik sheet.png");
  succeed("sweep --start 0s --exposure 0.05s --shift 0..1f/1f --each each-%d.png scene.tik sweep.png");
  succeed("video --out-fps 10 --out-angle 360 scene.tik video.mkv");
  const cv::Mat exposed = picture("picture.png"), each = picture("each-1.png");
  const cv::Mat sheet = cv::imread((scratch_ / "sheet.png").string(), cv::IMREAD_COLOR);
  cv::Mat frame;
  ASSERT_TRUE(cv::VideoCapture((scratch_ / "video.mkv").string(), cv::CAP_FFMPEG).read(frame));
  ASSERT_EQ(exposed.depth(), CV_16U);
  for (std::size_t field = 0; field < 4; ++field) {
    const int x = static_cast<int>(field) * 64 + 32;
    const double exact = 65'535 * Transfer::srgb().fraction_of(kCodes[field] / 4095.0);
    EXPECT_NEAR(exposed.at<std::uint16_t>(32, x), exact, 0.51);
    EXPECT_NEAR(each.at<std::uint16_t>(32, x), exact, 0.51);
    EXPECT_EQ(sheet.at<cv::Vec3b>(12 + 26 + 32, 12 + x)[0], shown(field)) << "of the sheet, field " << field;
    EXPECT_NEAR(frame.at<cv::Vec3b>(32, x)[0], shown(field), 1) << "of the video, field " << field;
  }
  EXPECT_EQ(exposed.at<std::uint16_t>(32, 250), 65'535) << "white is white";
}

TEST_F(Colour, OfTheSourceIsKeptWhereThatIsAskedFor) {
  write_scene();
  expect_says(run("--start 0s --exposure 1f -f 30 scene shown.png").out,
              "codes srgb with white 65535 (the capture's: linear with white 4095)");
  succeed("--start 0s --exposure 1f -f 30 --out-transfer source scene codes.png");
  const cv::Mat codes = picture("codes.png");
  for (std::size_t field = 0; field < 4; ++field) {
    EXPECT_EQ(codes.at<std::uint16_t>(32, static_cast<int>(field) * 64 + 32), kCodes[field]);
  }
  expect_says(run("reproduce codes.png").out, "--out-transfer source");
  expect_refused("--start 0s --exposure 1f -f 30 --out-transfer srgb scene x.pfm", 2, "(--out-transfer)");
}

// A .tik whose codes are said to stand for other light is exposed so.
TEST_F(Colour, OfACaptureFollowsAStatedTransfer) {
  write_scene();
  succeed("-q -f 30 scene scene.tik");
  succeed("--start 0s --exposure 1f --transfer srgb --depth 8 scene.tik srgb.png");
  const cv::Mat codes = picture("srgb.png");
  for (std::size_t field = 0; field < 4; ++field) {
    EXPECT_EQ(codes.at<std::uint8_t>(32, static_cast<int>(field) * 64 + 32),
              std::lround(kCodes[field] / 4095.0 * 255));
  }
}

// What would be read as something else is said, with the picture that it is of.
TEST_F(Colour, ThatAPictureDoesNotNameIsNoted) {
  scratch_.write("still.ppm", netpbm_file(random_stills({16, 16, 3}, 255, 1, 1)[0], false));
  const auto told = [&](const std::string& words) {
    const auto result = make(over(Words("--start 0f --exposure 1f -f 1 still.ppm " + words)));
    return result.out + result.err;
  };
  for (const auto& [words, unnamed] : std::vector<std::pair<std::string, std::string>>{
           {"a.pfm --primaries p3", "a.pfm does not name the primaries p3: state that when it is read"},
           {"a.npy --primaries ap0", "a.npy does not name the primaries ap0: state"},
           {"a.ppm --depth 16", "a.ppm does not name the transfer function srgb: state"},
           {"a.ppm --depth 8 --out-transfer linear", "a.ppm does not name the transfer function linear: state"},
           {"a.ppm --depth 8 --out-transfer source --transfer pq --primaries bt2020",
            "a.ppm does not name the transfer function pq and the primaries bt2020: state"}})
    expect_says(told(words), unnamed);
  for (const char* words :
       {"a.pfm", "a.ppm --depth 8", "a.ppm --depth 16 --out-transfer linear", "a.exr --primaries p3",
        "a.ppm --depth 8 --primaries p3", "a.tif --depth float --primaries p3"})
    EXPECT_EQ(told(words).find("does not name"), std::string::npos) << words;
}

// Codes under what is clear are whatever a program left there.
TEST_F(Colour, OfAPictureThatIsComparedIsNotTransparent) {
  scratch_.write("still.ppm", netpbm_file(random_stills({16, 16, 1}, 255, 1, 1)[0], false));
  TiffOptions options{8};
  options.extra = 1;
  scratch_.write("clear.tif", tiff_file(random_stills({16, 16, 4}, 255, 1, 1), options));
  expect_refused("mask -f 1 --threshold clear.tif 100 still.ppm mask.png", 3,
                 "clear.tif has transparency beside its codes; save it without");
  scratch_.write("f.fn", "M0 [0:1], [1000000:1]\n");
  expect_refused("-f 1 -k f.fn -m clear.tif still.ppm x.png", 3,
                 "clear.tif has transparency beside its codes; save it without");
}

// HLG's and PQ's codes go on behind white. What codes to be seen cut off is counted and said, with what keeps it.
TEST_F(Colour, AboveWhiteIsNotCutOffInSilence) {
  write_scene();
  const Words exposing("--start 0s --exposure 1f -f 30 scene");
  const auto told = [&](const std::string& transfer, const Words& more) {
    const auto result = make(exposing + "--transfer" + transfer + more);
    return result.out + result.err;
  };
  constexpr const char* kSaid = "brighter come out white";
  // In HLG the field of code 4095 lies above 75 %, in PQ too, and no other above 203 cd/m².
  for (const auto& [transfer, share, stops] :
       std::vector<std::array<std::string, 3>>{{"hlg", "26.5", "-2.0"}, {"pq", "2.03", "-5.7"}}) {
    const std::string said = told(transfer, {"x.png"});
    expect_says(said, "note: white is " + share + " % of the light that " + transfer +
                          " reaches, and 4096 pixels brighter come out white; nutik-cl expose --ev " + stops +
                          " shows");
    const std::string all = told(transfer, {"--ev", stops, "x.png"});
    EXPECT_EQ(all.find(kSaid), std::string::npos) << all;
    expect_says(all, "no pixel below 0 or above 1");
    expect_says(told(transfer, {"x.exr"}),
                "note: white is " + share + " % of the light that " + transfer + " reaches, which is 1 here; --gain ");
    EXPECT_EQ(told(transfer, {"--out-transfer", "source", "x.png"}).find(kSaid), std::string::npos);
    expect_says(told(transfer, {"--json", "x.png"}), kSaid);
  }
  EXPECT_EQ(told("srgb", {"x.png"}).find(kSaid), std::string::npos);
  scratch_.write("list", "--start 0s --exposure 1f a.png\n--start 1f --exposure 1f b.png\n");
  expect_says(run("background -f 30 --transfer hlg scene plate.png").err,
              "4096 pixels hold more light than white and come out white; an .exr");
  for (const Words words :
       {"batch -f 30 --transfer hlg list scene", "contact -f 30 --transfer hlg --every 1f scene sheet.png",
        "video -f 30 --transfer hlg --out-fps 30 scene x.mkv"}) {
    const auto result = make(words);
    expect_says(result.out + result.err, kSaid);
  }
}

// A grey card of 18 % that was filmed as its maker's table has it is 18 % of white: within half a code of 10 bits.
// Makers count whole codes, or codes between video's black and white.
TEST_F(Colour, OfCamerasCurvesIsReflectance) {
  NEEDS_FFMPEG();
  for (const LogCurve& curve : log_curves()) {
    const std::string name(curve.name);
    const double signal = curve.signal_of(0.18);
    const int code = static_cast<int>(std::lround(curve.is_of_whole_codes ? 1023 * signal : 64 + 876 * signal));
    scratch_.write("raw", planes_of(std::vector<std::array<int, 3>>(32 * 32, {code, 512, 512})));
    test::make(scratch_, "-f rawvideo -s 32x32 -pix_fmt yuv444p10le -r 25 -i raw -c:v ffv1 -color_range tv grey.mkv");
    succeed("--start 0s --exposure 1f --transfer " + name + " --out-transfer linear --depth 16 grey.mkv grey.png");
    const cv::Mat grey = picture("grey.png");
    const double step = curve.is_of_whole_codes ? 0.5 / 1023 : 0.5 / 876;
    for (int channel = 0; channel < 3; ++channel) {
      const double light = grey.at<cv::Vec3w>(16, 16)[channel] / 65'535.0;
      EXPECT_GE(light, curve.light_of(signal - step)) << name;
      EXPECT_LE(light, curve.light_of(signal + step)) << name;
    }
  }
  succeed("-q --transfer vlog grey.mkv grey.tik");
  const auto info = run("info grey.tik");
  expect_says(info.out + info.err, "vlog:video");
  expect_says(info.out + info.err, "vgamut");
}

// Light has another mean by another transfer function: what holds means is not said to be something else afterwards.
TEST_F(Colour, OfMeansOfLightStaysWhatItIs) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i testsrc2=s=64x48:d=0.4:r=25 -vf noise=alls=20:allf=t -c:v ffv1 -pix_fmt gray10le "
             "clip.mkv");
  const std::string camera =
      "nutik noise 0\nwhite 1023\ntransfer linear\nchannel grey\nread 0.002\nshot 0.0001\n"
      "curve sensor\n";
  scratch_.write("camera.noise", camera);
  const Words exposing("--start 0s --exposure 3f");
  for (const auto& [options, reason] : std::vector<std::pair<Words, std::string>>{
           {"--noise camera.noise", "what a camera's noise explains was held as its mean"},
           {"--scale 1/2", "pictures were scaled"}}) {
    succeed("encode -q clip.mkv means.tik" + options);
    const std::string said = "means.tik holds codes that are means of light by linear: " + reason;
    expect_refused("--transfer srgb means.tik x.png" + exposing, 2, said);
    expect_refused("contact --transfer srgb means.tik x.png", 2, said);
    expect_refused("trace --pixel 1,1 --transfer srgb means.tik --start 0s --exposure 3f", 2, said);
    expect_refused("retime --transfer srgb means.tik x.tik", 2, said);
    EXPECT_FALSE(exists("x.tik"));
    succeed("--transfer linear means.tik x.png" + exposing);
    // A corrected capture still knows.
    succeed("retime -f 50 means.tik fast.tik");
    expect_refused("retime --transfer srgb fast.tik x.tik", 2, reason);
    // The clip itself is read by any.
    succeed("--transfer srgb clip.mkv x.png" + exposing + options);
  }
  // Codes that no transfer function went into are the same by any: capture and clip make one picture.
  for (const Words options : {"--crop 32x32+8+8", "--deflicker", "--tolerance 2"}) {
    succeed("encode -q clip.mkv codes.tik" + options);
    succeed("--transfer srgb --no-recipe codes.tik held.png" + exposing);
    succeed("--transfer srgb --no-recipe clip.mkv read.png" + exposing + options);
    EXPECT_EQ(file("held.png"), file("read.png")) << options[0];
  }
}

// Names and data of a PNG's chunks before its pixels.
std::map<std::string, std::string> chunks_of(const std::string& png) {
  std::map<std::string, std::string> chunks;
  for (std::size_t at = 8; at + 8 < png.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(png[at + i]);
    const std::string name = png.substr(at + 4, 4);
    if (name == "IDAT") break;
    chunks[name] = png.substr(at + 8, size);
    at += 12 + size;
  }
  return chunks;
}

TEST_F(Colour, StandsInTheFile) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i testsrc2=s=64x48:d=0.2:r=25 -vf setsar=32/27 -c:v ffv1 -pix_fmt yuv420p10le "
             "-colorspace bt2020nc -color_primaries bt2020 -color_trc arib-std-b67 clip.mkv");
  const auto coded = [&](const char* out) {
    succeed({"--start", "0s", "--exposure", "1f", "--out-transfer", out, "--keep-pixels", "clip.mkv", "x.png"});
    return chunks_of(file("x.png"));
  };
  auto srgb = coded("srgb");
  EXPECT_EQ(srgb["cICP"], std::string("\x01\x0D\x00\x01", 4));
  EXPECT_EQ(srgb.count("sRGB"), 1u);
  EXPECT_EQ(srgb["gAMA"], std::string("\x00\x00\xB1\x8F", 4));
  EXPECT_EQ(srgb["pHYs"],
            std::string("\x00\x00\x00\x1B\x00\x00\x00\x20\x00", 9));  // 27 and 32 for one length
  auto source = coded("source");
  EXPECT_EQ(source["cICP"], std::string("\x09\x12\x00\x01", 4));
  EXPECT_EQ(source.count("sRGB") + source.count("gAMA"), 0u);
  auto linear = coded("linear");
  EXPECT_EQ(linear["cICP"], std::string("\x01\x08\x00\x01", 4));
  EXPECT_EQ(linear["gAMA"], std::string("\x00\x01\x86\xA0", 4));
  auto gamma = coded("gamma:1.8");
  EXPECT_EQ(gamma.count("cICP"), 0u);
  EXPECT_EQ(gamma["gAMA"], std::string("\x00\x00\xD9\x04", 4));  // 1 / 1.8

  succeed("-q clip.mkv clip.tik");
  const json info = answer("info clip.tik");
  EXPECT_EQ(info["pixel_aspect"], "32:27");
  EXPECT_EQ(info["primaries"], "bt2020");
  EXPECT_EQ(info["transfer"], "hlg");
  EXPECT_EQ(info["version"], 1);
  succeed("video --out-fps 25 --keep-pixels clip.tik video.mp4");
  const json stream = json::parse(shell("ffprobe -v error -of json -show_streams video.mp4").out)["streams"][0];
  EXPECT_EQ(stream["sample_aspect_ratio"], "32:27");
  EXPECT_EQ(stream["color_transfer"], "iec61966-2-1");
  EXPECT_EQ(stream["color_primaries"], "bt709");
  // Round things look round on a sheet.
  succeed("contact --every 1f --columns 1 clip.tik sheet.png");
  const cv::Mat sheet = cv::imread((scratch_ / "sheet.png").string());
  EXPECT_EQ(sheet.cols, 2 * 12 + std::max(96, static_cast<int>(std::lround(64 * 32.0 / 27))));
}

// What people look at has square pixels, what is measured has the capture's.
class AnamorphicPixels : public Colour {
 protected:
  // A moving picture of 64 x 48 pixels, each twice as wide as high.
  void SetUp() override {
    std::string raw;
    for (const Picture& still : random_stills({64, 48, 3}, 255, 6, 3))
      raw.append(reinterpret_cast<const char*>(still.bytes.data()), still.bytes.size());
    scratch_.write("clip.raw", raw);
    succeed("--raw 64x48:rgb24 -f 25 --pixel-aspect 2:1 -q clip.raw clip.tik");
  }
  [[nodiscard]] cv::Size size_of(const char* name) const { return picture(name).size(); }
};

TEST_F(AnamorphicPixels, AreSquareForEyesAndKeptForMeasuring) {
  const std::string exposure = "--start 0s --exposure 2f clip.tik ";
  const json json = answer(exposure + "eyes.png");
  EXPECT_EQ(json["width"], 128);
  EXPECT_EQ(json["notes"][0], "pixels of 2:1 were made square: 64 x 48 became 128 x 48 (--keep-pixels)");
  succeed(exposure + "eyes.jpg");
  EXPECT_EQ(size_of("eyes.png"), cv::Size(128, 48));
  EXPECT_EQ(size_of("eyes.jpg"), cv::Size(128, 48));
  succeed(exposure + "kept.png --keep-pixels");
  succeed(exposure + "deep.png --depth 16");
  succeed(exposure + "own.png --out-transfer source");
  for (const char* exact : {"x.tif", "x.ppm", "x.exr", "x.pfm"}) succeed(exposure + exact);
  for (const char* name : {"kept.png", "deep.png", "own.png", "x.tif", "x.ppm"})
    EXPECT_EQ(size_of(name), cv::Size(64, 48)) << name;
  const cv::Mat kept = cv::imread((scratch_ / "kept.png").string()),
                eyes = cv::imread((scratch_ / "eyes.png").string());
  EXPECT_EQ(cv::norm(kept, cv::imread((scratch_ / "x.ppm").string()), cv::NORM_INF), 0);
  cv::Mat wide;
  cv::resize(kept, wide, eyes.size(), 0, 0, cv::INTER_LANCZOS4);
  EXPECT_EQ(cv::norm(wide, eyes, cv::NORM_INF), 0);
}

TEST_F(AnamorphicPixels, AreSquareInPlatesStudiesAndFilms) {
  NEEDS_FFMPEG();
  succeed("background --by 254 clip.tik plate.png");
  EXPECT_EQ(size_of("plate.png"), cv::Size(128, 48));
  succeed("--every 2f --exposure 2f clip.tik s-%d.png");
  EXPECT_EQ(size_of("s-1.png"), cv::Size(128, 48));
  scratch_.write("list.txt", "--start 0s --exposure 2f b.png\n--start 0s --exposure 2f --keep-pixels k.png\n");
  const auto batch = run("batch list.txt clip.tik");
  EXPECT_EQ(size_of("b.png"), cv::Size(128, 48));
  EXPECT_EQ(size_of("k.png"), cv::Size(64, 48));
  const auto shape_of = [&](const std::string& words, const std::string& film) {
    succeed("video --out-fps 25 " + words + " clip.tik " + film);
    const json stream = json::parse(shell("ffprobe -v error -of json -show_streams " + film).out)["streams"][0];
    return format("{} x {}, {}", stream["width"].get<int>(), stream["height"].get<int>(),
                  stream.value("sample_aspect_ratio", "1:1"));
  };
  EXPECT_EQ(shape_of("", "eyes.mp4"), "128 x 48, 1:1");
  EXPECT_EQ(shape_of("--keep-pixels", "kept.mp4"), "64 x 48, 2:1");
  EXPECT_EQ(shape_of("", "exact.mkv"), "64 x 48, 2:1");
}

// Also of commands that have no --ev themselves.
TEST_F(Colour, ThatIsCutOffAtWhiteIsNotedWithWhatShowsIt) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i color=white:s=64x48:d=0.2:r=10 -pix_fmt yuv420p10le -color_trc smpte2084 "
             "-color_primaries bt2020 -colorspace bt2020nc -c:v ffv1 clip.mkv");
  const auto told = run("contact clip.mkv sheet.png");
  const std::string start = "come out white; nutik-cl ";
  const auto at = told.err.find(start);
  ASSERT_NE(at, std::string::npos) << told.err;
  std::istringstream advice(told.err.substr(at + start.size()));
  std::vector<std::string> words(3);
  for (std::string& word : words) advice >> word;
  expect_says(run(Words(words) + "--start 0f --exposure 1f clip.mkv shown.png").out, "no pixel below 0 or above 1");
}

TEST_F(Colour, OfACaptureIsCorrectedWithoutItsClip) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i testsrc2=s=64x48:d=1:r=30 -c:v ffv1 -pix_fmt yuv420p clip.mkv");
  succeed("-q clip.mkv clip.tik");
  expect_says(make("retime clip.tik -f 960 -a 180 --transfer linear --in-place").out,
              "960 pictures a second, shutter 180 degrees, transfer linear");
  succeed("-q -f 960 -a 180 --transfer linear clip.mkv anew.tik");
  for (const char* name : {"clip", "anew"}) {
    succeed({"--start", "3f", "--exposure", "20ms", std::string(name) + ".tik", std::string(name) + ".pfm"});
  }
  EXPECT_EQ(file("clip.pfm"), file("anew.pfm"));
  expect_refused(
      2, {{"retime clip.tik --in-place", "what is to be corrected?"},
          {"retime clip.tik -f 9", "say where to write: nutik-cl retime … clip.tik NEW.tik"},
          {"retime - -f 9 --in-place", "standard input cannot be changed in place; state --output NEW.tik"},
          {"retime clip.tik -f 9 new.tik --in-place", "two outputs: new.tik and the capture itself"}});
  expect_refused(3,
                 {{"retime clip.mkv -f 9 --in-place",
                   "clip.mkv is no .tik capture, and only those are corrected: state a clip's rate"},
                  {"retime clip.mkv --in-place", "(--fps, --shutter-angle, --transfer)"},
                  {"info clip.mkv", "clip.mkv is no .tik capture; a clip becomes one when it is encoded"}});
  EXPECT_FALSE(exists("-"));
  // As it is encoded by that curve.
  succeed("-q --transfer slog3 clip.mkv slog3.tik");
  expect_says(answer("info slog3.tik")["transfer"].get<std::string>(), "slog3:video");
  expect_says(make("retime anew.tik --transfer slog3 -o log.tik").err, "them slog3:video; state that (--transfer)");
  EXPECT_EQ(make("retime anew.tik --transfer slog3:video -o log.tik --overwrite").err, "");
}

}  // namespace
}  // namespace nutik::test

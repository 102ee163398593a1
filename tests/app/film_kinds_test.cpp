// Films as editors, players and the web take them: decoded again by others, with their tags, and with the clip's sound.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <sstream>

#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"

namespace nutik::test {
namespace {

class FilmKinds : public AppTest {
 protected:
  // `codec_name=h264` and the like, a line each.
  [[nodiscard]] std::string probed(const std::string& name, const std::string& stream = "v") const {
    return shell("ffprobe -v error -count_frames -select_streams " + stream +
                 " -show_entries stream=codec_name,profile,pix_fmt,r_frame_rate,nb_read_frames,color_space,"
                 "color_transfer,color_primaries,start_time -of default=nw=1 " +
                 name)
        .out;
  }
  // When each frame is shown, in seconds.
  [[nodiscard]] std::vector<double> times(const std::string& name) const {
    std::istringstream lines(shell("ffprobe -v error -select_streams v -show_entries "
                                   "frame=best_effort_timestamp_time -of csv=p=0 " +
                                   name)
                                 .out);
    std::vector<double> found;
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) found.push_back(std::stod(line));
    return found;
  }
  // All frames as others decode them, RGB of 8 bits. FFmpeg takes chroma as centred unless it is told.
  [[nodiscard]] std::string decoded(const std::string& name, bool has_left_chroma = false) const {
    test::make(scratch_, "-i " + name + (has_left_chroma ? " -vf scale=in_h_chr_pos=0" : "") +
                             " -vsync 0 -f rawvideo -pix_fmt rgb24 decoded");
    return file("decoded");
  }
  static double mean_difference(const std::string& a, const std::string& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += std::abs(static_cast<int>(static_cast<unsigned char>(a[i])) -
                      static_cast<int>(static_cast<unsigned char>(b[i])));
    return sum / static_cast<double>(a.size());
  }
};

struct Kind {
  std::string film, codec, is, pixels;
  double most;  // codes of 8 bits by which frames differ in the mean
};

TEST_F(FilmKinds, AreDecodedAgain) {
  NEEDS_FFMPEG();
  constexpr int kFrames = 6;
  test::make(scratch_,
             "-f lavfi -i testsrc2=s=320x180:d=1:r=24000/1001 -vf boxblur=4 -frames:v 6 -c:v ffv1 -pix_fmt "
             "bgr0 clip.mkv");
  const std::string source = decoded("clip.mkv");
  ASSERT_EQ(source.size(), std::size_t{320} * 180 * 3 * kFrames);
  const std::vector<Kind> kinds{
      {"a.mkv", "ffv1", "ffv1", "bgr0", 0.0},
      {"a.mp4", "h264", "h264", "yuv420p", 2.5},
      {"b.mp4", "h264-10", "h264", "yuv420p10le", 2.5},
      {"c.mp4", "h265", "hevc", "yuv420p", 2.5},
      {"d.mp4", "h265-10", "hevc", "yuv420p10le", 2.5},
      {"e.mp4", "av1", "av1", "yuv420p", 3},
      {"f.mkv", "av1-10", "av1", "yuv420p10le", 3},
      {"g.webm", "vp9", "vp9", "yuv420p", 3},
      {"h.mov", "prores", "prores", "yuv422p10le", 1.5},
      {"i.mov", "prores-proxy", "prores", "yuv422p10le", 3},
      {"j.mov", "prores-lt", "prores", "yuv422p10le", 2},
      {"k.mov", "prores-422", "prores", "yuv422p10le", 2},
      {"l.mov", "prores-4444", "prores", "yuv444p12le", 1.5},
      {"m.mov", "dnxhr-lb", "dnxhd", "yuv422p", 4},
      {"n.mov", "dnxhr-sq", "dnxhd", "yuv422p", 2},
      {"o.mov", "dnxhr-hq", "dnxhd", "yuv422p", 2},
      {"p.mxf", "dnxhr-hqx", "dnxhd", "yuv422p10le", 2},
      {"q.mov", "dnxhr-444", "dnxhd", "yuv444p10le", 2},
      {"r.avi", "mjpeg", "mjpeg", "yuvj420p", 3},
      {"s.gif", "gif", "gif", "bgra", 6},
  };
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.codec);
    make("video --out-fps 24000/1001 --out-angle 360 --video-codec " + kind.codec + " clip.mkv " + kind.film);
    const std::string told = probed(kind.film);
    expect_says(told,
                {"codec_name=" + kind.is + "\n", "pix_fmt=" + kind.pixels + "\n", "nb_read_frames=6\n"});
    const bool is_coarse = kind.codec == "gif";
    if (!is_coarse) expect_says(told, "r_frame_rate=24000/1001\n");
    const std::string frames = decoded(kind.film, kind.is == "dnxhd" || kind.pixels.ends_with("10le"));
    ASSERT_EQ(frames.size(), source.size());
    EXPECT_LE(mean_difference(frames, source), kind.most);
    const std::vector<double> shown = times(kind.film);
    ASSERT_EQ(shown.size(), std::size_t{kFrames});
    for (std::size_t k = 0; k < shown.size(); ++k)
      EXPECT_NEAR(shown[k] - shown[0], static_cast<double>(k) * 1001 / 24'000, is_coarse ? 0.011 : 0.00101);
    // Below 720 lines.
    const bool is_lossless = kind.codec == "ffv1" || is_coarse;
    if (!is_lossless)
      expect_says(told, "color_space=" + std::string(kind.is == "dnxhd"   ? "bt709"
                                                     : kind.is == "mjpeg" ? "bt470bg"
                                                                          : "smpte170m"));
    if (kind.codec.starts_with("prores-4444")) expect_says(told, "profile=4444\n");
    if (kind.codec == "dnxhr-hqx") expect_says(told, "profile=DNXHR HQX\n");
  }
  make("video --out-fps 24000/1001 --out-angle 360 clip.mkv web.webp");
  const std::string webp = file("web.webp");
  EXPECT_EQ(webp.substr(0, 4) + webp.substr(8, 4), "RIFFWEBP");
  // FFmpeg reads no animation: the first picture, which is whole and lies behind a header of 16 bytes, as a file of its
  // own. The others hold what changes.
  std::size_t frames = 0;
  std::uint32_t shown_ms = 0;
  const auto number_at = [&](std::size_t at, std::size_t size) {
    std::uint32_t number = 0;
    std::memcpy(&number, webp.data() + at, size);
    return number;
  };
  for (std::size_t at = webp.find("ANMF"); at != webp.npos; at = webp.find("ANMF", at + 4)) {
    if (frames == 0) {
      const std::string picture = "WEBP" + webp.substr(at + 24, number_at(at + 4, 4) - 16);
      const auto size = static_cast<std::uint32_t>(picture.size());
      scratch_.write("one.webp", "RIFF" + std::string(reinterpret_cast<const char*>(&size), 4) + picture);
      EXPECT_LE(mean_difference(decoded("one.webp"), source.substr(0, source.size() / kFrames)), 4);
    }
    EXPECT_NEAR(shown_ms, static_cast<double>(frames++) * 1001 / 24, 1.01);
    shown_ms += number_at(at + 20, 3);
  }
  EXPECT_EQ(frames, std::size_t{kFrames});
  // Stills lose nothing.
  for (const std::string extension : {"png", "tif", "ppm"}) {
    make("video --out-fps 24000/1001 --out-angle 360 clip.mkv still-%d." + extension);
    EXPECT_EQ(decoded("still-%d." + extension), source) << extension;
  }
}

TEST_F(FilmKinds, HaveTheQualityThatIsAskedFor) {
  NEEDS_FFMPEG();
  test::make(scratch_,
             "-f lavfi -i testsrc2=s=320x180:d=1:r=24 -vf noise=alls=30:allf=t -frames:v 6 -c:v ffv1 "
             "-pix_fmt bgr0 clip.mkv");
  const auto bytes = [&](const std::string& words, const std::string& name) {
    make("video -q --overwrite --out-fps 24 --out-angle 360 " + words + " clip.mkv " + name);
    return file(name).size();
  };
  for (const char* codec : {"h264", "h265-10", "av1"}) {
    const std::string of = "--video-codec " + std::string(codec) + " ";
    EXPECT_GT(bytes(of + "--crf 10", "a.mp4"), bytes(of + "--crf 40", "a.mp4")) << codec;
    EXPECT_GT(bytes(of + "--quality 90", "a.mp4"), bytes(of + "--quality 20", "a.mp4")) << codec;
  }
  EXPECT_GT(bytes("--video-codec mjpeg --crf 2", "a.avi"), bytes("--video-codec mjpeg --crf 20", "a.avi"));
  EXPECT_GT(bytes("--crf 90", "a.webp"), bytes("--crf 10", "a.webp"));
  expect_refused("video --crf 60 clip.mkv x.mp4", 2,
                 "h264's own scale runs from 1 (best) to 51, and 60 is outside");
  bytes("--quality 100", "best.mp4");
  expect_says(probed("best.mp4"), "profile=High\n");  // which players know
  expect_refused("video --crf 3 clip.mkv x.mkv", 2, "ffv1 has no scale of quality: it loses nothing");
  expect_refused("video --quality 3 clip.mkv x.mov --video-codec prores", 2,
                 "prores has no scale of quality; choose another");
  expect_refused("video --crf 3 clip.mkv x-%d.png", 2, "pictures have none");
}

// libx265, which looks more frames ahead, leaves a time undefined: five of six such films failed, so four are made.
TEST_F(FilmKinds, MayBeAFrameLong) {
  NEEDS_FFMPEG();
  std::string red;
  for (int i = 0; i < 6 * 256 * 256; ++i) red.append("\xff\xff\0\0\0\0", 6);
  scratch_.write("red.raw", red);
  for (int time = 0; time < 4; ++time) {
    const auto made = run_program({"video", "--overwrite", "--raw", "256x256:rgb48le", "-f", "25", "--out-fps", "25",
                                   "--video-codec", "h265", "--frames", "0", "red.raw", "film.mp4"},
                                  scratch_.folder());
    ASSERT_EQ(made.status, 0) << made.err;
    expect_says(probed("film.mp4"), "nb_read_frames=1\n");
  }
}

// An edge between colours moved by half a pixel, and again in each film of a film. Chroma of 10 bits lies left of the
// pair that shares it, as in DNxHR, that of 8 bits between both, as it is read again; a clip of 8 bits gets its own
// back.
TEST_F(FilmKinds, KeepChromaInItsPlace) {
  NEEDS_FFMPEG();
  const auto edge = [&](const std::string& name) {  // in samples of chroma, the first 32 of a row
    test::make(scratch_, "-i " + name + " -vf extractplanes=u -frames:v 1 -f rawvideo -pix_fmt gray16le plane");
    std::uint16_t row[32];
    std::memcpy(row, file("plane").data(), sizeof row);
    const double middle = (row[0] + row[31]) / 2.0;
    std::size_t i = 1;
    while (i < 31 && row[i] < middle) ++i;
    return static_cast<double>(i) - (row[i] - middle) / (row[i] - row[i - 1]);
  };
  for (const std::string pixels : {"yuv422p10le", "yuv420p"}) {
    const std::string edged = "geq=lum='lum(X,Y)':cr='cr(X,Y)':cb='if(gte(X,16),150,100)*" +
                              std::string(pixels == "yuv420p" ? "1'" : "4'");
    test::make(scratch_, "-f lavfi -i color=gray:s=256x128:r=25:d=0.2 -vf \"format=" + pixels + "," + edged +
                             "\" -c:v ffv1 -color_range tv -y clip.mkv");
    for (const auto& [codec, kind] :
         {std::pair{"prores", ".mov"}, {"dnxhr-hq", ".mov"}, {"h264", ".mkv"}, {"h265-10", ".mkv"}}) {
      const std::string film = std::string("film") + kind;
      make("video --overwrite --out-fps 25 --out-angle 360 --video-codec " + std::string(codec) + " clip.mkv " + film);
      const bool is_centred = pixels != "yuv420p" && codec == std::string_view("h264");
      EXPECT_NEAR(edge(film), edge("clip.mkv") - (is_centred ? 0.25 : 0), 0.05) << pixels << " " << codec;
      const auto said = shell("ffprobe -v error -show_streams " + film).out;
      if (film == "film.mkv") expect_says(said, is_centred ? "chroma_location=center\n" : "chroma_location=left\n");
    }
  }
}

// HLG comes in and goes out with its codes and tags, in 10 bits and BT.2020's matrix.
TEST_F(FilmKinds, KeepHighDynamicRange) {
  NEEDS_FFMPEG();
  for (const auto& [curve, name] : {std::pair{"arib-std-b67", "hlg"}, {"smpte2084", "pq"}}) {
    test::make(scratch_,
               "-f lavfi -i gradients=c0=0x804020:c1=0x2060a0:x0=0:y0=0:x1=319:y1=179:nb_colors=2:s=320x180:d=1:r=25 "
               "-frames:v 5 -c:v ffv1 -pix_fmt yuv420p10le "
               "-colorspace bt2020nc "
               "-color_primaries bt2020 -color_trc " +
                   std::string(curve) + " -color_range tv hdr.mkv");
    make(
        "video --overwrite --out-fps 25 --out-angle 360 --out-transfer source --video-codec h265-10 --crf 4 "
        "hdr.mkv film.mp4");
    const std::string told = probed("film.mp4");
    expect_says(told, {"pix_fmt=yuv420p10le\n", "color_space=bt2020nc\n",
                       "color_transfer=" + std::string(curve) + "\n", "color_primaries=bt2020\n",
                       "nb_read_frames=5\n"});
    test::make(scratch_, "-i hdr.mkv -f rawvideo -pix_fmt yuv420p10le before");
    test::make(scratch_, "-i film.mp4 -f rawvideo -pix_fmt yuv420p10le after");
    const std::string before = file("before"), after = file("after");
    ASSERT_EQ(before.size(), after.size());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < before.size(); i += 2) {
      std::uint16_t a = 0, b = 0;
      std::memcpy(&a, before.data() + i, 2);
      std::memcpy(&b, after.data() + i, 2);
      sum += std::abs(a - b);
    }
    EXPECT_LE(sum / static_cast<double>(before.size() / 2), 2.5) << name;  // codes of 10 bits
    expect_says(make("video --out-transfer source --video-codec h265 hdr.mkv " + std::string(name) + ".mp4").err,
                "h265 has 8 bits, in which " + std::string(name) + " shows bands");
  }
}

// A screen's primaries and light are told by the first picture, or by the container of a film.
TEST_F(FilmKinds, KeepWhatIsSaidOfTheScreen) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i color=gray:s=64x64:r=25:d=0.2 -c:v libx265 -pix_fmt yuv420p10le -x265-params "
                       "\"log-level=none:colorprim=bt2020:transfer=smpte2084:colormatrix=bt2020nc:max-cll=900,400:"
                       "master-display=G(13250,34500)B(7500,3000)R(34000,16000)WP(15635,16450)L(10000000,1)\" "
                       "screen.mp4");
  const auto told = [&](const std::string& words, const std::string& clip, const std::string& film) {
    make("video --out-fps 25 " + words + clip + " " + film);
    return shell("ffprobe -v error -show_streams " + film).out;
  };
  const std::string kept = "--out-transfer source --video-codec h265-10 ", source = kept + "--out-angle 360 ";
  expect_says(told(source, "screen.mp4", "a.mkv"), {"red_x=17/25\n", "max_luminance=1000/1\n", "max_content=900\n"});
  expect_says(told(source, "a.mkv", "b.mp4"), {"red_x=34000/50000\n", "max_content=900\n", "max_average=400\n"});
  expect_says(told(source + "--shutter hann --normalize integral ", "screen.mp4", "c.mkv"), "max_content=900\n");
  scratch_.write("two.fn", "M0 [0:1], [40000000:1], [40000001:0]\nM1 [0:0.5], [40000000:0.5], [40000001:0]\n");
  scratch_.write("bright.fn", "M0 [0:1], [40000000:1], [40000001:0]\nM1 [0:3], [40000000:3], [40000001:0]\n");
  make("mask --tag 0 --rectangle 0,0,64,64 --size 64x64 -o 0.pgm");
  make("mask --tag 1 --rectangle 0,0,64,64 --size 64x64 -o 1.pgm");
  const std::string keys = kept + "--mask-blend alpha --mask-key 0s 0.pgm --mask-key 0.1s 1.pgm -k ";
  expect_says(told(keys + "two.fn ", "screen.mp4", "e.mkv"), "max_content=900\n");
  // That light has become another, or brighter.
  for (const std::string& other :
       {std::string(), keys + "bright.fn ", source + "--ev 0.1 ", source + "--gain 2 --combine lighten ",
        source + "--shutter spline:0=0,0.5=3,1=0 ", source + "--negative offset "})
    EXPECT_EQ(told("--overwrite " + other, "screen.mp4", "d.mp4").find("side_data_type"), std::string::npos) << other;
}

// What a reader has to be told of a film, for no number says it; and what editors would read in another way.
TEST_F(FilmKinds, TellWhatTheyDoNotName) {
  NEEDS_FFMPEG();
  test::make(scratch_, "-f lavfi -i gradients=s=256x144:d=1:r=25 -frames:v 3 -c:v ffv1 -pix_fmt yuv420p10le clip.mkv");
  const auto notes = [&](const std::string& words, const std::string& film) {
    return answer("video --overwrite --out-transfer source --out-fps " + words + " clip.mkv " + film)["notes"].dump();
  };
  expect_says(notes("25 --transfer slog3 --video-codec prores", "a.mov"),
              "does not name the transfer function slog3:video: state");
  expect_says(notes("25 --transfer slog3 --primaries sgamut3 --video-codec h265-10", "a.mp4"),
              "does not name the transfer function slog3:video and the primaries sgamut3: state");
  const std::string hlg = "25 --transfer hlg --primaries bt2020 ";
  expect_says(notes(hlg, "a.avi"), "does not name the transfer function hlg and the primaries bt2020: state");
  for (const auto& [depth, said] : {std::pair{"16", true}, {"8", false}, {"16 --out-transfer linear", false}}) {
    const std::string film = answer("video --overwrite --out-fps 25 clip.mkv a.avi --depth " + Words(depth)).dump();
    EXPECT_EQ(film.find("does not name the transfer function") != std::string::npos, said) << depth;
  }
  EXPECT_EQ(notes(hlg + "--video-codec dnxhr-hqx", "a.mov").find("does not name"), std::string::npos);
  // Apple has a key for its curve.
  const std::string apples = "25 --video-codec dnxhr-hqx --transfer applelog --primaries ";
  for (const std::string primaries : {"bt2020", "apple-wide-gamut"}) {
    EXPECT_EQ(notes(apples + primaries, "a.mov").find("does not name"), std::string::npos);
    expect_says(answer("encode --overwrite a.mov a.tik").dump(), {"transfer applelog", "primaries " + primaries});
  }
  for (const auto& [stated, meant] : {std::pair{"23.976", "24000"}, {"23.98", "24000"}, {"59.94", "60000"}})
    expect_says(notes(stated, "a.mp4"), "as stated; editors mean " + std::string(meant) + "/1001 by that");
  for (const char* stated : {"24", "24000/1001", "29.9"})
    EXPECT_EQ(notes(stated, "a.mp4").find("editors"), std::string::npos) << stated;
  expect_refused("video --out-fps 23.976 clip.mkv b.mxf", 2,
                 "and not 23.976; state one of these (--out-fps 24000/1001)");
  expect_refused("video --out-fps 59.94 clip.mkv b.mxf", 2, "(--out-fps 60000/1001)");
  const std::string brighter = "video --overwrite --out-transfer gamma:2.8 --out-fps 25 clip.mkv ";
  expect_says(answer(brighter + "a.mxf")["notes"].dump(), "does not name the transfer function gamma:2.8: state");
  EXPECT_EQ(answer(brighter + "a.mov")["notes"].dump().find("does not name"), std::string::npos);
  expect_says(notes("25 --pixel-aspect 4:3 --keep-pixels", "a.mxf"), "a .mxf does not tell that pixels are 4:3");
}

class FilmSoundTest : public FilmKinds {
 protected:
  // Four seconds of 25 frames each: black and silent but for a flash of frame 50, and a tone that begins with it.
  void make_clap(const std::string& name, const std::string& sound) const {
    test::make(scratch_,
               "-f lavfi -i color=black:s=256x128:r=25:d=4 -f lavfi -i "
               "aevalsrc=\"if(between(t\\,2\\,2.1)\\,sin(2*PI*1000*t)\\,0)\":s=48000:d=4 "
               "-vf \"drawbox=c=white:t=fill:enable=eq(n\\,50)\" -c:v mpeg4 -q:v 2 -c:a " +
                   sound + " " + name);
  }
  // The frame that is bright, and when the sound begins, in frames.
  [[nodiscard]] std::pair<double, double> clap(const std::string& name, double rate) const {
    test::make(scratch_, "-copyts -i " + name + " -an -vsync 0 -f rawvideo -pix_fmt gray frames -vn -af "
                         "aresample=async=1:first_pts=0 -f f32le -ac 1 -ar 48000 sound");
    const std::string frames = file("frames"), sound = file("sound");
    std::size_t frame = 0;
    while (frame * 256 * 128 < frames.size() &&
           static_cast<unsigned char>(frames[frame * 256 * 128 + 1000]) < 128)
      ++frame;
    std::size_t sample = 0;
    for (float value = 0; sample * 4 + 4 <= sound.size(); ++sample) {
      std::memcpy(&value, sound.data() + sample * 4, 4);
      if (std::fabs(value) > 0.2F) break;
    }
    return {static_cast<double>(frame), static_cast<double>(sample) / 48'000 * rate};
  }
};

TEST_F(FilmSoundTest, StaysOnItsFrameBehindAGap) {
  NEEDS_FFMPEG();
  make_clap("whole.mkv", "pcm_s16le");
  test::make(
      scratch_,
      "-i whole.mkv -c:v copy -c:a pcm_s16le -af \"asetnsamples=48,aselect=not(between(t\\,1\\,1.0795))\" gap.mkv");
  make("video --out-fps 25 --out-angle 360 gap.mkv gap.mov");
  const auto [frame, sound] = clap("gap.mov", 25);
  EXPECT_EQ(frame, 50);
  EXPECT_NEAR(sound, frame, 0.3);
}

TEST_F(FilmSoundTest, LiesOnItsFrame) {
  NEEDS_FFMPEG();
  make_clap("clip.mp4", "aac");
  make_clap("plain.mov", "pcm_s16le");
  // As packets are, and encoded anew.
  const std::vector<std::pair<std::string, std::string>> films{
      {"clip.mp4", "a.mp4"},  {"clip.mp4", "a.mkv"},   {"clip.mp4", "a.mov"},
      {"clip.mp4", "a.webm"}, {"clip.mp4", "a.avi"},   {"clip.mp4", "a.mxf"},  {"plain.mov", "b.mp4"},
      {"plain.mov", "b.mkv"}, {"plain.mov", "b.webm"}, {"plain.mov", "b.avi"}};
  for (const auto& [clip, film] : films) {
    SCOPED_TRACE(clip + " as " + film);
    const auto made = make("video --out-fps 25 --out-angle 360 --from 1s --to 3.5s " + clip + " " + film);
    EXPECT_EQ((made.out + made.err).find("left out"), std::string::npos) << made.err;
    const auto [frame, sound] = clap(film, 25);
    EXPECT_EQ(frame, 25);
    EXPECT_NEAR(sound, frame, 1.0);
    const std::string length =
        run_shell("ffprobe -v error -show_entries format=duration -of csv=p=0 " + film, scratch_.folder()).out;
    EXPECT_NEAR(std::stod(length), 2.5, 0.1);
  }
}

// What is taken of a clip's pictures moves no sound: fields, a stream that was cut in its middle, one that ends at
// damage, samples between, and a sound that begins behind the pictures.
TEST_F(FilmSoundTest, LiesOnItsFrameWhateverIsTakenOfTheClip) {
  NEEDS_FFMPEG();
  const auto lies_at = [&](double at, const std::string& words, const std::string& film, double rate) {
    SCOPED_TRACE(words);
    const auto made = make("video --out-fps " + format("{}", rate) + " --out-angle 360 " + words + " " + film);
    EXPECT_EQ((made.out + made.err).find("sound is left out"), std::string::npos) << made.err;
    const auto [frame, sound] = clap(film, rate);
    EXPECT_NEAR(frame, at, 1.0);
    EXPECT_NEAR(sound, frame, 1.0);
  };
  make_clap("clip.mp4", "aac");
  lies_at(100, "--deinterlace fields clip.mp4", "fields.mp4", 50);
  lies_at(50, "--between 3 clip.mp4", "between.mp4", 25);
  test::make(scratch_, "-i clip.mp4 -c:v mpeg2video -g 12 -bf 2 -q:v 2 -c:a mp2 whole.ts");
  // Broadcasts are cut anywhere, between packets of 188 bytes.
  const std::string whole = file("whole.ts");
  scratch_.write("cut.ts", whole.substr(whole.size() / 5 / 188 * 188));
  const auto late = clap("cut.ts", 25);
  lies_at(late.first, "cut.ts", "cut.mp4", 25);
  test::make(scratch_, "-i clip.mp4 -c:v ffv1 -g 1 -slicecrc 1 -c:a copy plain.mkv");
  std::string damaged = file("plain.mkv");
  damaged.replace(damaged.size() - damaged.size() / 8, 400, 400, '\xA5');
  scratch_.write("damaged.mkv", damaged);
  lies_at(50, "--ignore-errors damaged.mkv", "damaged.mp4", 25);
  test::make(scratch_, "-i clip.mp4 -itsoffset 1.5 -ss 1.5 -i clip.mp4 -map 0:v -map 1:a -c:v copy -c:a ac3 late.mkv");
  for (const char* film : {"late.avi", "late.mp4", "late.mov"}) lies_at(50, "late.mkv", film, 25);
  test::make(scratch_, "-i late.mkv -c:v copy -c:a flac flac.mkv");
  lies_at(50, "flac.mkv", "flac.mp4", 25);
  // Opus, which a copy would move: from film to film it stays where it is.
  test::make(scratch_, "-i late.mkv -c:v libvpx-vp9 -c:a libopus opus0.webm");
  for (int film = 1; film < 4; ++film) lies_at(50, format("opus{}.webm", film - 1), format("opus{}.webm", film), 25);
}

// A clap on a cut's first frame is heard whole, and nothing behind its last one.
TEST_F(FilmSoundTest, BeginsAndEndsWithACut) {
  NEEDS_FFMPEG();
  make_clap("aac.mp4", "aac");
  make_clap("alac.mov", "alac");
  make_clap("flac.mkv", "flac");
  make_clap("opus.mkv", "libopus");  // whose pictures FFmpeg 5 delays
  make_clap("pcm.mov", "pcm_s24le");
  const std::vector<std::array<std::string, 3>> films{
      {"aac.mp4", "a.mp4", "aac"},   {"aac.mp4", "a.mkv", "flac"},  {"alac.mov", "b.mp4", "alac"},
      {"alac.mov", "b.mov", "alac"}, {"flac.mkv", "c.mkv", "flac"}, {"flac.mkv", "c.webm", "opus"},
      {"opus.mkv", "d.mp4", "aac"},  {"opus.mkv", "d.webm", "opus"}, {"pcm.mov", "e.avi", "pcm_s24le"},
      {"pcm.mov", "e.mkv", "pcm_s24le"}};
  for (const auto& [clip, film, codec] : films) {
    SCOPED_TRACE(clip + " as " + film);
    make("video --out-fps 25 --out-angle 360 --from 50f --to 60f " + clip + " " + film);
    expect_says(probed(film, "a"), "codec_name=" + codec + "\n");
    const auto [frame, sound] = clap(film, 25);
    EXPECT_EQ(frame, 0);
    EXPECT_NEAR(sound, 0, 0.03);
    EXPECT_NEAR(static_cast<double>(file("sound").size()) / 4 / 48'000, 0.4, 0.04);
  }
}

// PCM of 48 kHz goes into a .mxf, up to its last picture: FFmpeg ends the file where a sound ends. One that ends before
// the film is no sound of it.
TEST_F(FilmSoundTest, MayEndBeforeThePictures) {
  NEEDS_FFMPEG();
  make_clap("clap.mov", "pcm_s24le -ar 44100");
  test::make(scratch_, "-i clap.mov -t 2.5 -i clap.mov -map 0:v -map 1:a -c copy clip.mov");
  make("video --out-fps 30000/1001 --out-angle 360 --between off clip.mov a.mxf");
  expect_says(probed("a.mxf", "a"), "codec_name=pcm_s24le\n");
  expect_says(probed("a.mxf"), "nb_read_frames=119\n");
  const auto [frame, sound] = clap("a.mxf", 30'000.0 / 1001);
  EXPECT_NEAR(sound, frame, 1.0);
  for (const char* film : {"b.mp4", "b.mkv", "b.mxf"}) {
    const nlohmann::json told = answer("video --out-fps 25 --from 3s clip.mov " + std::string(film));
    EXPECT_TRUE(told["sound"].is_null());
    expect_says(told["notes"].dump(), "the clip's sound is left out: there is none while the film lasts");
  }
}

TEST_F(FilmSoundTest, KeepsDepthLanguageAndTitle) {
  NEEDS_FFMPEG();
  make_clap("clip.mkv", "flac -sample_fmt s32 -metadata:s:a language=deu -metadata:s:a title=Stage");
  const auto told = [&](const std::string& film) {
    make("video --out-fps 25 --out-angle 360 clip.mkv " + film);
    return run_shell("ffprobe -v error -select_streams a -show_streams " + film, scratch_.folder()).out;
  };
  expect_says(told("film.mkv"), {"bits_per_raw_sample=24\n", "TAG:language=deu\n", "TAG:title=Stage\n"});
  expect_says(told("film.avi"), "codec_name=pcm_s24le\n");
}

// Where nothing is said of sound, a film without it is better than none.
TEST_F(FilmSoundTest, IsMixedDownOrLeftOutForAReason) {
  NEEDS_FFMPEG();
  make_clap("clip.mp4", "aac");
  const std::string program = "'" NUTIK_TEST_PROGRAM "' video --json --overwrite --out-fps 25 - film.mp4";
  for (int time = 0; time < 2; ++time) {  // the second finds a film of that name
    const auto piped = run_shell("(cat clip.mp4 | " + program + ")", scratch_.folder());
    ASSERT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(nlohmann::json::parse(piped.out)["sound"]["codec"], "aac");
  }
  const auto channels = [&](int count) {
    std::string each = "0";
    for (int k = 1; k < count; ++k) each += "|0";
    test::make(scratch_, "-i clip.mp4 -f lavfi -i \"aevalsrc=" + each +
                             ":s=48000:d=4\" -map 0:v -map 1:a -c:v copy -c:a pcm_s16le " + "many.mov");
    const auto made = make("video --overwrite --out-fps 25 many.mov many.webm");
    return made.out + made.err;
  };
  expect_says(channels(4), "the sound's 4 channels are mixed down to 2, as libopus does not encode them");
  expect_says(channels(9), "nothing says where its 9 channels are heard");  // no FFmpeg supposes any places of 9
  const std::filesystem::path folder = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path();
  std::filesystem::copy(NUTIK_TEST_PROGRAM, scratch_ / "alone");
  std::filesystem::copy(folder / "nutik-videos.so", scratch_ / "nutik-videos.so");
  const auto alone =
      run_shell("env -u NUTIK_MODULES ./alone video --out-fps 25 clip.mp4 alone.webm", scratch_.folder());
  EXPECT_EQ(alone.status, 0);
  expect_says(alone.err + alone.out, "nutik-filters.so was not found");
}

// A film says which of two tracks it has: the one that players take.
TEST_F(FilmSoundTest, IsToldOf) {
  NEEDS_FFMPEG();
  make_clap("clip.mp4", "aac");
  test::make(
      scratch_,
      "-i clip.mp4 -f lavfi -i anullsrc=r=48000:cl=mono -shortest -map 0:v -map 1:a -map 0:a -c:v copy -c:a:0 mp2 "
      "-c:a:1 copy -disposition:a:0 0 -disposition:a:1 default two.mkv");
  const nlohmann::json told = answer("video --out-fps 25 --out-angle 360 --from 1s --to 3.5s two.mkv two.mp4");
  EXPECT_EQ(told["sound"]["codec"], "aac");
  EXPECT_EQ(told["sound"]["track"], 2);
  EXPECT_EQ(told["sound"]["tracks"], 2);
  EXPECT_EQ(told["sound"]["speed"], 1.0);
  EXPECT_NEAR(told["sound"]["start_s"].get<double>(), 1.0, 0.04);  // the file's, whose pictures begin later than 0
  EXPECT_NEAR(told["sound"]["seconds"].get<double>(), 2.5, 0.05);
  const nlohmann::json squared =
      answer("video --out-fps 25 --out-angle 360 --from 1s --to 3.5s --pixel-aspect 4:3 two.mkv squared.mp4");
  EXPECT_GT(squared["width"], told["width"]);
  EXPECT_EQ(squared["sound"]["codec"], "aac");
  expect_says(told["notes"].dump(), "the clip has 2 tracks of sound, and the film track 2");
  EXPECT_NEAR(clap("two.mp4", 25).second, 25, 1.0);
  EXPECT_TRUE(answer("video --out-fps 25 --speed 0.5 two.mkv slow.mp4")["sound"].is_null());
  test::make(scratch_, "-i clip.mp4 -an -c copy silent.mp4");
  EXPECT_TRUE(answer("video --out-fps 25 silent.mp4 none.mp4")["sound"].is_null());
  const auto stretched = make("video --out-fps 25 --sound stretch --overwrite silent.mp4 none.mp4");
  expect_says(stretched.out + stretched.err, "silent.mp4 has no sound to stretch");
}

TEST_F(FilmSoundTest, IsLeftOutAloudOrStretched) {
  NEEDS_FFMPEG();
  make_clap("clip.mp4", "aac");
  const auto slow = make("video --out-fps 25 --out-angle 360 --from 1s --speed 0.5 clip.mp4 slow.mp4");
  expect_says(slow.out + slow.err,
              "the clip's sound is left out: the film runs 0.5 times as fast as the file");
  EXPECT_EQ(probed("slow.mp4", "a"), "");
  for (const auto& [speed, at] : {std::pair{"0.5", 50.0}, {"0.25", 100.0}, {"2", 12.5}}) {
    make("video --overwrite --out-fps 25 --out-angle 360 --sound stretch --from 1s --speed " +
         std::string(speed) + " clip.mp4 slow.mp4");
    const auto [frame, sound] = clap("slow.mp4", 25);
    EXPECT_NEAR(frame, at, 0.5) << speed;
    EXPECT_NEAR(sound, at, 1.0) << speed;
  }
  // 8000 / 60 is no whole number: a rounded rate would have drifted by 0.3 s.
  make_clap("slow.mov", "pcm_s16le -ar 8000");
  make("video --out-fps 5 --out-angle 360 --between off --sound stretch --speed 1/60 --to 2.1s slow.mov drift.mov");
  const auto [flash, tone] = clap("drift.mov", 5);
  EXPECT_NEAR(flash, 600, 0.5);
  EXPECT_NEAR(tone, flash, 0.1);
  test::make(scratch_, "-i clip.mp4 -vf \"setpts=(N+min(N\\,50))/25/TB\" -vsync passthrough -c:a copy uneven.mp4");
  const auto even = make("video -f 25 --out-fps 25 --between off --sound stretch uneven.mp4 even.mp4");
  expect_says(even.out + even.err, "the file's pictures do not lie at even times");
  make("video --out-fps 25 --sound no clip.mp4 mute.mp4");
  EXPECT_EQ(probed("mute.mp4", "a"), "");
  const auto gif = make("video --out-fps 25 clip.mp4 a.gif");
  expect_says(gif.out + gif.err, "the clip's sound is left out: .gif holds none");
  expect_refused("video --sound loud clip.mp4 x.mp4", 2, "choose clip, stretch or no");
  // A phone's slow motion, which plays at an eighth of the speed of life: so the film does that runs as slow.
  test::make(scratch_,
             "-i clip.mp4 -c copy -movflags use_metadata_tags -metadata com.android.capture.fps=200 phone.mp4");
  make("video --out-fps 25 --out-angle 360 --speed 1/8 phone.mp4 same.mp4");
  const auto [frame, sound] = clap("same.mp4", 25);
  EXPECT_EQ(frame, 50);
  EXPECT_NEAR(sound, 50, 1.0);
}

}  // namespace
}  // namespace nutik::test

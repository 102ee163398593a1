// How fast phones and cameras filmed, where their files say it in a place of their own.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "media/cameras/photron_header.hpp"
#include "media/input_checksum.hpp"
#include "support/bytes.hpp"
#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

std::string phone_clip(const char* played, const std::string& words) {
  return "-f lavfi -i testsrc2=s=32x32:d=1:r=" + std::string(played) +
         " -fflags +bitexact -map_metadata -1 -movflags use_metadata_tags -c:v mpeg4 " + words + " clip.mp4";
}

std::string android(const char* rate) { return "-metadata com.android.capture.fps=" + std::string(rate); }

TEST(CaptureRate, IsAndroidsWhereTheFilePlaysSlower) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, phone_clip("30", android("240.000000")));
  const auto clip = open_test_clip(scratch / "clip.mp4");
  EXPECT_EQ(clip->info().timing.rate, (Rational{240, 1}));
  expect_says(notes_of(*clip), "com.android.capture.fps says that 240");
  const ClipOptions options{.rate = Rational{960, 1}};
  const auto stated = open_test_clip(scratch / "clip.mp4", options);
  EXPECT_EQ(timeline_of("", stated->info(), options, 30).rate(), (Rational{960, 1}));
  test::make(scratch, phone_clip("30", android("3")));  // time-lapse
  EXPECT_EQ(open_test_clip(scratch / "clip.mp4")->info().timing.rate, (Rational{3, 1}));
}

std::string box(const std::string& type, const std::string& data) {
  return big_endian(data.size() + 8, 4) + type + data;
}

std::string sony_story(const char* rate, const char* curve, const char* gamut) {
  return std::string(
             "<?xml version=\"1.0\"?><NonRealTimeMeta><VideoFormat><VideoFrame videoCodec=\"AVC\" captureFps=\"") +
         rate + "\" formatFps=\"23.98p\"/></VideoFormat><AcquisitionRecord><Group name=\"CameraUnitMetadataSet\">" +
         "<Item name=\"CaptureGammaEquation\" value=\"" + curve + "\"/><Item name=\"CaptureColorPrimaries\" value=\"" +
         gamut + "\"/></Group></AcquisitionRecord></NonRealTimeMeta>";
}

// In a file beside the clip, or in a box of it. Other curves than those that are known here are left to the container.
TEST(CaptureRate, AndCurveAreSonysWhereItsXmlSaysThem) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, phone_clip("24000/1001", ""));
  const std::string without = input_checksum(scratch / "clip.mp4");
  scratch.write("clipM01.XML", sony_story("119.88p", "s-log3-cine", "s-gamut3-cine"));
  const auto beside = open_test_clip(scratch / "clip.mp4");
  EXPECT_EQ(beside->info().timing.rate, (Rational{120'000, 1001}));
  EXPECT_EQ(beside->info().format.transfer.text(), "slog3:video");
  EXPECT_EQ(beside->info().format.primaries, Primaries::sgamut3_cine);
  expect_says(notes_of(*beside), "Sony's captureFps says that 120000/1001");
  EXPECT_EQ(beside->info().timing.rate_from, "clipM01.XML");
  EXPECT_NE(input_checksum(scratch / "clip.mp4"), without);
  EXPECT_EQ(beside->info().facts.front().line(), "transfer slog3, from clipM01.XML");
  scratch.write("otherM01.XML", "<other/>");
  const std::string story = sony_story("240p", "s-log2", "s-gamut");
  const std::string plain = read_file(scratch / "clip.mp4");
  const std::string version(4, '\0');
  scratch.write("within.mp4", plain + box("meta", version + box("xml ", version + story)));
  const auto within = open_test_clip(scratch / "within.mp4");
  EXPECT_EQ(within->info().format.transfer.text(), "slog2:video");
  EXPECT_EQ(within->info().format.primaries, Primaries::sgamut3);
  const std::string own = input_checksum(scratch / "within.mp4");
  scratch.write("withinM01.XML", story);
  EXPECT_EQ(input_checksum(scratch / "within.mp4"), own);
  scratch.write("other.mp4", plain + box("meta", version + box("xml ", version + sony_story("x", "rec709", ""))));
  const auto other = open_test_clip(scratch / "other.mp4");
  EXPECT_EQ(other->info().format.transfer, Transfer::srgb());
  EXPECT_EQ(other->info().timing.rate, (Rational{24'000, 1001}));
}

std::string item(const std::string& key, const std::string& value) {
  return "\x06\x0E\x2B\x34" + key + "\x83" + big_endian(value.size(), 3) + value;
}

const std::string kBt709Curve = "\x06\x0E\x2B\x34\x04\x01\x01\x01\x04\x01\x01\x01\x01\x02" + std::string(2, '\0');

std::string sonys_label(std::uint32_t which) {
  return "\x06\x0E\x2B\x34\x04\x01\x01\x06\x0E\x06\x04\x01" + big_endian(which, 4);
}

// Ancillary data: a packet of another kind, then the camera unit's set in two.
std::string camera_packets(std::uint32_t curve, std::uint32_t gamut, std::uint32_t rate) {
  const auto tagged = [](std::uint32_t tag, const std::string& value) {
    return big_endian(tag, 2) + big_endian(value.size(), 2) + value;
  };
  const std::string unit =
      item("\x02\x53\x01\x01\x0C\x02\x01\x01\x02\x01" + std::string(2, '\0'),
           tagged(0x8114, "S-Log") + tagged(0x3210, sonys_label(curve)) + tagged(0x3219, sonys_label(gamut)) +
               tagged(0x8106, big_endian(rate, 4) + big_endian(1001, 4)));
  const auto packet = [](const std::string& kind, const std::string& data) {
    std::string bytes = kind + big_endian(data.size(), 1) + data;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return big_endian(10, 2) + "\x01\x04" + big_endian(bytes.size(), 2) + big_endian(bytes.size(), 4) +
           big_endian(1, 4) + bytes;
  };
  return item("\x01\x02\x01\x01\x0D\x01\x03\x01\x17\x01\x02\x01", big_endian(3, 2) + packet("\x61\x01", "other") +
                                                                      packet("\x43\x05", "\x01" + unit.substr(0, 30)) +
                                                                      packet("\x43\x05", "\x02" + unit.substr(30)));
}

TEST(CaptureRate, AndCurveAreSonysWhereMxfSaysThem) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch,
             "-f lavfi -i testsrc2=s=64x64:d=1:r=24000/1001 -f lavfi -i sine=d=1:r=48000 -c:v mpeg2video "
             "-color_trc bt709 clip.mxf");
  const std::string plain = read_file(scratch / "clip.mxf");
  const auto clip_of = [&](const std::string& bytes) {
    scratch.write("clip.mxf", bytes);
    const auto clip = open_test_clip(scratch / "clip.mxf");
    const auto& info = clip->info();
    return info.format.transfer.text() + " " + std::string(to_text(info.format.primaries)) + " " +
           info.timing.rate.value().text();
  };
  EXPECT_EQ(clip_of(plain), "srgb bt709 24000/1001");
  std::string labelled = plain;
  ASSERT_NE(labelled.find(kBt709Curve), labelled.npos);
  for (std::size_t at = 0; (at = labelled.find(kBt709Curve, at)) != labelled.npos;)
    labelled.replace(at, kBt709Curve.size(), sonys_label(0x01010605));
  EXPECT_EQ(clip_of(labelled), "slog3:video sgamut3-cine 24000/1001");
  EXPECT_EQ(clip_of(plain + camera_packets(0x01010508, 0x01030103, 120'000)), "slog2:video sgamut3 120000/1001");
  EXPECT_EQ(clip_of(plain + camera_packets(0x01010604, 0x01030104, 24'000)), "slog3:video sgamut3 24000/1001");
  EXPECT_EQ(clip_of(plain + camera_packets(0x01010705, 0x01030105, 24'000)), "srgb bt709 24000/1001");  // S-Cinetone
  const std::string packets = camera_packets(0x01010604, 0x01030104, 120'000);
  for (std::size_t cut = 1; cut < packets.size(); cut += 7)  // what is cut off is not there
    EXPECT_EQ(clip_of(plain + packets.substr(0, cut)), "srgb bt709 24000/1001") << cut;
}

// A box at the end of the description of the only track, with the sizes of all that it lies in.
std::string described(std::string file, const std::string& more) {
  std::size_t end = 0;
  for (const char* name : {"moov", "trak", "mdia", "minf", "stbl", "stsd", "mp4v"}) {
    const std::size_t at = file.find(name, end) - 4;
    end = at + 8;
    const auto byte = [&](std::size_t k) { return std::size_t{static_cast<unsigned char>(file[at + k])}; };
    const std::size_t size = (byte(2) << 8) + byte(3) + more.size();
    file[at + 2] = static_cast<char>(size >> 8);
    file[at + 3] = static_cast<char>(size);
    if (std::string(name) == "mp4v") file.insert(at + size - more.size(), more);
  }
  return file;
}

TEST(CaptureRate, AndCurvesOfApplesAndArrisAreReadFromTheirKeys) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const auto curve_of = [&](const std::string& name) {
    const auto& format = open_test_clip(scratch / name)->info().format;
    return format.transfer.text() + " " + std::string(to_text(format.primaries));
  };
  const auto keyed = [&](const std::string& words) {
    test::make(scratch, phone_clip("30", words));
    return curve_of("clip.mp4");
  };
  EXPECT_EQ(keyed(""), "srgb bt709");
  const std::string plain = read_file(scratch / "clip.mp4");
  EXPECT_EQ(keyed("-metadata com.apple.proapps.customgamma=com.apple.rec2020.apple-log"), "applelog bt2020");
  EXPECT_EQ(keyed("-metadata com.apple.proapps.customgamma=com.apple.apple-wide-gamut.apple-log"),
            "applelog apple-wide-gamut");
  EXPECT_EQ(keyed("-metadata com.apple.proapps.customgamma=com.apple.other"), "srgb bt709");
  EXPECT_EQ(keyed("-metadata com.arri.camera.ColorGammaSxS=LOG-C -metadata com.arri.camera.ExposureIndexAsa=800"),
            "logc3 arri-wg3");
  EXPECT_EQ(keyed("-metadata com.arri.camera.ColorGammaSxS=LOG-C -metadata com.arri.camera.ExposureIndexAsa=400"),
            "srgb bt709");
  const auto other = open_test_clip(scratch / "clip.mp4");
  expect_says(notes_of(*other), "LOG-C at exposure index 400");
  scratch.write("in-track.mp4", described(plain, box("logs", "com.apple.rec2020.apple-log")));
  EXPECT_EQ(curve_of("in-track.mp4"), "applelog bt2020");
  scratch.write("beside.mp4", plain + box("logs", "com.apple.rec2020.apple-log"));
  EXPECT_EQ(curve_of("beside.mp4"), "srgb bt709");
}

TEST(CaptureRate, ChangesNothingWhereTheFileRunsAtIt) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, phone_clip("240", android("240")));
  const auto clip = open_test_clip(scratch / "clip.mp4");
  EXPECT_EQ(clip->info().timing.rate, (Rational{240, 1}));
  EXPECT_EQ(notes_of(*clip), "");
  expect_says(clip->info().timing.rate_from, "com.android.capture.fps");
}

TEST(CaptureRate, IsOnlyNamedWhereItFitsNoTimes) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, phone_clip("25", android("33")));
  const auto clip = open_test_clip(scratch / "clip.mp4");
  EXPECT_EQ(clip->info().timing.rate, (Rational{25, 1}));
  ASSERT_EQ(clip->info().notes.size(), 1u);
  expect_says(notes_of(*clip), "its own times are taken");
  EXPECT_EQ(clip->info().notes[0].settings, std::vector{Setting::frame_rate});
}

TEST(CaptureRate, ThatIsNoneIsSaid) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const char* value : {"fast", "0", "-240", "nan", "1/0"}) {
    test::make(scratch, phone_clip("25", android(value)));
    const auto clip = open_test_clip(scratch / "clip.mp4");
    EXPECT_EQ(clip->info().timing.rate, (Rational{25, 1})) << value;
    ASSERT_EQ(clip->info().notes.size(), 1u) << value;
    expect_says(notes_of(*clip), "com.android.capture.fps is '" + std::string(value) + "', which is no rate");
    EXPECT_EQ(clip->info().notes[0].settings, std::vector{Setting::frame_rate});
  }
}

// A clip whose pictures of these numbers, of two seconds, were left out.
void make_phone_clip_without(const Scratch& scratch, const std::string& pictures, const std::string& words) {
  test::make(scratch, "-f lavfi -i testsrc2=s=32x32:d=2:r=30 -vf \"select='not(" + pictures +
                          ")'\" -fps_mode vfr -movflags use_metadata_tags "
                          "-metadata com.android.capture.fps=240 -c:v mpeg4 " +
                          words);
}

// Pictures that phones leave out stay left out: times are pressed, not made even, and the gaps count for nothing in
// how much. Clocks of containers round differences, to a millisecond of 33 1/3 in Matroska.
TEST(CaptureRate, KeepsTheUnevennessOfTimes) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  struct Case {
    const char* left_out;  // as a condition on n
    bool (*is_left_out)(int n);
    double factor;
  };
  for (const Case& dropped :
       {Case{"eq(n,20)", [](int n) { return n == 20; }, 8},
        Case{"eq(mod(n,10),4)", [](int n) { return n % 10 == 4; }, 8},
        Case{"eq(mod(n,30),3)+eq(mod(n,30),4)+eq(mod(n,30),17)",
             [](int n) { return n % 30 == 3 || n % 30 == 4 || n % 30 == 17; }, 8},
        // Two of three: the usual difference is not the period.
        Case{"gt(mod(n,5),0)*lt(mod(n,5),4)", [](int n) { return n % 5 > 0 && n % 5 < 4; }, 8}}) {
    for (const auto& [file, words, off_ns] :
         {std::tuple("clip.mp4", "clip.mp4", 2.0), std::tuple("clip.mkv", "clip.mkv", 0.5e6 / 8 + 2)}) {
      SCOPED_TRACE(std::string(dropped.left_out) + " " + file);
      make_phone_clip_without(scratch, dropped.left_out, words);
      const auto clip = open_test_clip(scratch / file);
      expect_says(notes_of(*clip), "which the file plays as 30");
      const Timeline timeline = timeline_of("", clip->info(), {}, clip->info().sample_count);
      ASSERT_FALSE(timeline.is_constant());
      std::uint64_t sample = 0;
      for (int n = 0; n < 60; ++n) {
        if (dropped.is_left_out(n)) continue;
        EXPECT_NEAR(static_cast<double>(timeline.start_ns(sample++)), n * 1e9 / 240, off_ns) << n;
      }
      EXPECT_EQ(sample, timeline.sample_count());
    }
  }
}

// One picture that comes half a period late does not make the period half as long, and times that tremble about the
// rate of filming are those of filming.
TEST(CaptureRate, IsNotMistakenForSingleTimes) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const auto clip_of = [&](const std::string& times) {
    test::make(scratch, "-f lavfi -i testsrc2=s=32x32:d=2:r=30 -vf \"settb=1/60000,setpts='" + times +
                            "'\" -fps_mode vfr -enc_time_base 1:60000 -movflags use_metadata_tags "
                            "-metadata com.android.capture.fps=240 -video_track_timescale 60000 "
                            "-c:v mpeg4 -y clip.mp4");
    return open_test_clip(scratch / "clip.mp4");
  };
  const auto late = clip_of("2000*N+1000*gte(N,30)");
  expect_says(notes_of(*late), "which the file plays as 30");
  EXPECT_NEAR(static_cast<double>(late->info().timing.starts_ns[29]), 29e9 / 240, 2);
  const auto trembling = clip_of("250*N+14*mod(N*N,7)");
  EXPECT_EQ(notes_of(*trembling).find("com.android"), std::string::npos) << notes_of(*trembling);
  EXPECT_EQ(trembling->info().timing.rate_from, "the file, as com.android.capture.fps says");
}

// Times that follow no rate press to none.
TEST(CaptureRate, IsOnlyNamedWhereTimesFollowNoRate) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(
      scratch,
      "-f lavfi -i testsrc2=s=32x32:d=1:r=30 -vf \"settb=1/1000,setpts='33*N+14*mod(N*N,7)'\" -fps_mode vfr "
      "-enc_time_base 1:1000 -movflags use_metadata_tags -metadata com.android.capture.fps=240 "
      "-video_track_timescale 1000 -c:v mpeg4 clip.mp4");
  const auto clip = open_test_clip(scratch / "clip.mp4");
  ASSERT_FALSE(clip->info().timing.rate);
  EXPECT_EQ(clip->info().timing.starts_ns[1], 47'000'000);
  expect_says(notes_of(*clip), "at uneven times, of no rate that can be told: its own times are taken");
}

// Adds boxes at the end of the last box, moov.
void add_to_moov(const std::filesystem::path& path, const std::string& boxes) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const std::size_t moov = bytes.find("moov") - 4;
  ASSERT_LT(moov, bytes.size());
  const std::string whole = box("moov", bytes.substr(moov + 8) + boxes);
  std::ofstream(path, std::ios::binary) << bytes.substr(0, moov) + whole;
}

std::string samsung_boxes(char mode, const std::string& fixed_point) {
  const std::string author = "samp" + std::string("\x01\x03\x00", 3) + mode;
  return box("udta", box("smta", std::string(4, '\0') + box("saut", author) + box("srfr", fixed_point)));
}

TEST(CaptureRate, IsSamsungsByItsRecordingMode) {
  NEEDS_FFMPEG();
  const std::string fixed_point("\x00\xF0\x80\x00", 4);  // 240.5
  const Scratch scratch;
  for (const auto& [mode, rate] :
       {std::pair{12, Rational{240, 1}}, {13, {120, 1}}, {21, {481, 2}}, {0, {30, 1}}}) {
    test::make(scratch, phone_clip("30", ""));
    add_to_moov(scratch / "clip.mp4", samsung_boxes(static_cast<char>(mode), fixed_point));
    const auto clip = open_test_clip(scratch / "clip.mp4");
    EXPECT_EQ(clip->info().timing.rate, rate) << mode;
    EXPECT_EQ(clip->info().notes.empty(), mode == 0);
  }
}

// Super slow motion, and slow motion whose box of the rate holds none.
TEST(CaptureRate, IsNotKnownOfAllOfSamsungsSlowModes) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const int mode : {7, 9, 22, 23, 21}) {
    test::make(scratch, phone_clip("30", ""));
    add_to_moov(scratch / "clip.mp4", samsung_boxes(static_cast<char>(mode), std::string(4, '\0')));
    const auto clip = open_test_clip(scratch / "clip.mp4");
    EXPECT_EQ(clip->info().timing.rate, (Rational{30, 1})) << mode;
    ASSERT_EQ(clip->info().notes.size(), 1u) << mode;
    expect_says(notes_of(*clip), "calls the recording slow motion");
    EXPECT_EQ(clip->info().notes[0].settings, std::vector{Setting::frame_rate});
  }
}

TEST(CaptureRate, IsNotKnownOfSamsungsSlowParts) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, phone_clip("30", ""));
  std::ofstream(scratch / "clip.mp4", std::ios::binary | std::ios::app)
      << std::string("\x00\x00\x90\x08", 4) << "SlowMotion_Data120*1*1" << std::string("\x20\x00\x00\x00", 4)
      << "SEFT";
  const auto clip = open_test_clip(scratch / "clip.mp4");
  EXPECT_EQ(clip->info().timing.rate, (Rational{30, 1}));
  expect_says(notes_of(*clip), "slow motion");
}

TEST(CaptureRate, OfACineComesWithItsShutter) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "cine_781.cine")) GTEST_SKIP() << "no clips in " << media;
  const auto clip = open_test_clip(media / "cine_781.cine");
  EXPECT_EQ(clip->info().timing.exposed_ns, 9696);
  const Timeline timeline = timeline_of("", clip->info(), {}, 15);
  for (std::uint64_t k = 0; k < 15; ++k) {
    EXPECT_NEAR(static_cast<double>(timeline.end_ns(k) - timeline.start_ns(k)), 9696, 1) << k;
  }
  // The other has no list of exposures, but the setup's shutter of 70 µs.
  const auto other = open_test_clip(media / "data_small_cine.cine");
  EXPECT_EQ(other->info().timing.exposed_ns, 70'000);
}

TEST(CaptureRate, IsReadOfPhotronsHeaders) {
  const PhotronHeader text = parse_photron_header(
      "#Camera Information Header\nDate : 2023/1/18\nRecord Rate(fps) : 30000\nShutter Speed(s) : 1/50000\n");
  EXPECT_EQ(text.rate, (Rational{30'000, 1}));
  EXPECT_EQ(text.exposed_ns, 20'000);
  const PhotronHeader xml =
      parse_photron_header("<cih><recordRate>2000</recordRate><shutterSpeed>4000</shutterSpeed>");
  EXPECT_EQ(xml.rate, (Rational{2000, 1}));
  EXPECT_EQ(xml.exposed_ns, 250'000);
  for (const char* nothing : {"", "Record Rate(fps) :", "Record Rate(fps) : 0",
                              "<recordRate>fast</recordRate>", "Record Rate(fps) : 1/0"}) {
    EXPECT_EQ(parse_photron_header(nothing).rate, std::nullopt) << nothing;
  }
}

// A word, or a time that another line gives. Of what was saved the shutter was closed between the pictures.
TEST(CaptureRate, OfPhotronsComesWithAShutterThatStaysOpen) {
  const Scratch scratch;
  scratch.write("raw.mraw", std::string(4 * 4 * 2 * 3, '\1'));
  const auto angle_of = [&](const std::string& lines) {
    scratch.write("raw.cih", lines);
    const ClipOptions raw{.raw = RawVideo{4, 4, "gray16le"}};
    const auto clip = open_test_clip(scratch / "raw.mraw", raw);
    EXPECT_TRUE(clip->info().timing.exposed_ns) << lines;
    return timeline_of("", clip->info(), raw, 3).shutter_angle().value();
  };
  for (const char* word : {"OPEN", "Open", "open\r"}) {
    const std::string lines = "Record Rate(fps) : 30000\nShutter Speed(s) : " + std::string(word) + "\n";
    EXPECT_EQ(angle_of(lines), 360.0) << word;
    EXPECT_NEAR(angle_of(lines + "Save Step : 4\n"), 90.0, 0.01) << word;
    EXPECT_NEAR(angle_of(lines + "Shutter Type2(nsec) : 20000\n"), 216.0, 1e-6) << word;
  }
  EXPECT_EQ(parse_photron_header("Record Rate(fps) : 30000\nShutter Speed(s) : Auto\n").exposed_ns,
            std::nullopt);
  EXPECT_EQ(parse_photron_header("Shutter Speed(s) : OPEN\n").exposed_ns, std::nullopt);
}

TEST(CaptureRate, OfPicturesIsThatOfTheHeaderBesideThem) {
  const Scratch scratch;
  const std::string header = "Record Rate(fps) : 1000\nShutter Speed(s) : 1/4000\n";
  std::filesystem::create_directories(scratch / "stills");
  const std::vector<Picture> stills = random_stills({4, 4, 1}, 4095, 2, 1);
  scratch.write("stills/a.pgm", netpbm_file(stills[0], true));
  scratch.write("stills/b.pgm", netpbm_file(stills[1], true));
  scratch.write("stills/camera.cih", header);
  scratch.write("raw.mraw", std::string(4 * 4 * 2 * 3, '\1'));
  scratch.write("raw.cihx", "<recordRate>500</recordRate>");
  const ClipOptions raw{.raw = RawVideo{4, 4, "gray16le"}};
  const auto folder = open_test_clip(scratch / "stills"), file = open_test_clip(scratch / "raw.mraw", raw);
  EXPECT_EQ(folder->info().timing.rate_from, "camera.cih");
  const Timeline timeline = timeline_of("", folder->info(), {}, 2);
  EXPECT_EQ(timeline.rate(), (Rational{1000, 1}));
  EXPECT_EQ(timeline.shutter_angle(), (Rational{90, 1}));
  EXPECT_EQ(timeline_of("", file->info(), raw, 3).rate(), (Rational{500, 1}));
  scratch.write("stills/other.cih", header);  // which of the two?
  EXPECT_FALSE(open_test_clip(scratch / "stills")->info().timing.is_known());
}

// The shared recording, whose header the camera wrote.
TEST(CaptureRate, OfARecordedHeaderIsTheCameras) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "ball_12bit.cihx")) GTEST_SKIP() << "no clips in " << media;
  const auto header = photron_header_of(media / "ball_12bit.mraw");
  ASSERT_TRUE(header);
  EXPECT_EQ(header->rate, (Rational{30'000, 1}));
  EXPECT_EQ(header->exposed_ns, 20'000);
}

}  // namespace
}  // namespace nutik::test

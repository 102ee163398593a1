// Which of the containers that FFmpeg knows are read, what is believed of them, and what is refused by name.
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "align/registrar.hpp"
#include "media/module.hpp"
#include "media/videos/containers.hpp"
#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/stills.hpp"
#include "system/mapped_file.hpp"

namespace nutik::test {
namespace {

// A limit that follows from a file's size has a limit itself: FFmpeg's settings are ints.
TEST(Containers, WithoutASizeAreReadHoweverLargeTheyAre) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  constexpr Shape kShape{352, 288, 1};
  scratch.write("raw", bytes_of(random_stills(kShape, 255, 12, 1)));
  for (const auto& [name, codec] : std::vector<std::pair<std::string, std::string>>{
           {"a.ts", "-c:v mpeg2video -q:v 1"},
           {"a.mts", "-c:v libx264 -preset ultrafast -qp 4 -f mpegts"},
           {"a.m2ts", "-c:v libx264 -preset ultrafast -qp 4 -bf 0"},
           {"a.mpg", "-c:v mpeg2video -q:v 1"},
           {"a.m2v", "-c:v mpeg2video -q:v 1"},
           {"a.h264", "-c:v libx264 -preset ultrafast -qp 4"},
           {"a.hevc", "-c:v libx265 -preset ultrafast -x265-params qp=4:log-level=none"},
           {"a.mpeg4", "-c:v mpeg4 -q:v 1 -f m4v"},
           {"a.h263", "-c:v h263 -q:v 1"},
           {"a.mjpeg", "-c:v mjpeg -q:v 1 -pix_fmt yuvj420p"},
           {"a.obu", "-c:v libaom-av1 -cpu-used 8 -crf 1 -row-mt 1"},
           {"a.drc", "-c:v vc2"},
           {"a.dv", "-s 720x576 -pix_fmt yuv420p"}}) {
    SCOPED_TRACE(name);
    make(scratch, from_raw(kShape, "gray") + "-pix_fmt yuv420p " + codec + " " + name);
    ASSERT_GT(std::filesystem::file_size(scratch / name), 261'000u);
    EXPECT_EQ(read_all(*open_test_clip(scratch / name, {.interlaced = Interlaced::ignored})).size(), 12u);
  }
}

// What stands in backquotes in that row of SECURITY.md.
std::set<std::string> listed(const std::string& row) {
  std::istringstream page(read_file(NUTIK_SECURITY_PAGE));
  std::set<std::string> names;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| " + row)) continue;
    for (std::size_t from = line.find('`'); from != std::string::npos;) {
      const std::size_t to = line.find('`', from + 1);
      names.insert(line.substr(from + 1, to - from - 1));
      from = line.find('`', to + 1);
    }
  }
  return names;
}

TEST(Containers, AreThoseThatTheSecurityPageLists) {
  std::set<std::string> read, refused;
  for (const videos::Containers& containers : videos::kContainers)
    (containers.refusal.empty() ? read : refused).insert(containers.names.begin(), containers.names.end());
  EXPECT_EQ(listed("containers of FFmpeg that are read"), read);
  EXPECT_EQ(listed("refused by name"), refused);
  const std::set<std::string> modules = listed("modules");
  for (const char* file : {VideoModule::kFile, StillModule::kFile, MotionModule::kFile})
    EXPECT_TRUE(modules.contains(file)) << file;
}

// Playlists, and whatever else names files, beside a film that they could show.
TEST(Containers, ThatNameOtherFilesAreRefused) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25:d=1 -c:v mpeg2video a.ts");
  EXPECT_EQ(read_all(*open_test_clip(scratch / "a.ts")).size(), 25u);
  const auto said_of = [&](const std::string& name, const std::string& text) {
    const auto path = scratch.write(name, text);
    return message_of<InputError>([&] { read_all(*open_test_clip(path)); });
  };
  const std::string hls = "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\na.ts\n";
  for (const auto& [name, kind, text] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"l.m3u8", "hls", hls},
           {"self.m3u8", "hls", "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nself.m3u8\n"},
           {"l.mpd", "",
            "<?xml version=\"1.0\"?>\n<MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\" type=\"static\" "
            "profiles=\"urn:mpeg:dash:profile:isoff-on-demand:2011\" "
            "mediaPresentationDuration=\"PT1S\"><Period><AdaptationSet "
            "mimeType=\"video/mp4\"><Representation id=\"1\" "
            "bandwidth=\"1\"><BaseURL>a.ts</BaseURL></Representation></AdaptationSet></Period></MPD>"},
           {"l.txt", "concat", "ffconcat version 1.0\nfile a.ts\n"},
           {"holiday.mp4", "concat", "ffconcat version 1.0\nfile a.ts\n"},
           {"l.sdp", "",
            "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 5004 RTP/AVP 96\n"}}) {
    const std::string said = said_of(name, text);
    if (kind.empty()) {
      EXPECT_NE(said.find("is a text, and no clip"), std::string::npos) << name << ": " << said;
      continue;
    }
    EXPECT_NE(said.find("it is taken for " + kind + " ("), std::string::npos) << name << ": " << said;
    EXPECT_NE(said.find("names other files"), std::string::npos) << name << ": " << said;
  }
  EXPECT_NE(said_of("film.mp4", hls), "");
}

TEST(Containers, OfWhichTooLittleIsKnownAreRefusedByName) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  std::string numbers;
  for (int k = 0; k < 3000; ++k) numbers += std::to_string(k) + " ";
  scratch.write("n.txt", numbers);
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 1 a.fits");
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 1 a.dpx");
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 1 a.webp");
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 1 a.bmp");
  make(scratch, "-f lavfi -i sine=duration=1 a.wav");
  std::string ser = "LUCAM-RECORDER";
  for (const std::uint32_t number : {0u, 0u, 0u, 8u, 4u, 16u, 1u})
    ser.append(reinterpret_cast<const char*>(&number), sizeof number);
  scratch.write("a.ser", ser.append(136 + 64, '\0'));
  scratch.write("a.y4m", "YUV4MPEG2 W8 H6 F25:1 Im C420jpeg\nFRAME I12p\n" + std::string(72, 'x'));
  for (const auto& [name, said] : std::vector<std::pair<std::string, std::string>>{
           {"a.y4m", " is no video that can be read: its header, of yuv4mpegpipe (YUV4MPEG pipe), is damaged or "},
           {"n.txt", " is a text, and no clip; stills are listed in a .csv"},
           {"a.fits",
            " is no video that can be read: it is taken for fits (Flexible Image Transport System), which would be "
            "stretched"},
           {"a.dpx", " is a DPX picture, which is not read; make PNGs of them: ffmpeg -i"},
           {"a.webp", " is a WebP picture, which is not read; make PNGs of such files: "},
           {"a.bmp", " is a BMP picture, which is not read; make PNGs of such files: "},
           {"a.wav",
            " is no video that can be read: it is taken for wav (WAV / WAVE (Waveform Audio)), which is not read"},
           {"a.ser", " is no video that can be read: it is taken for ser ("},
           {"a.ser", "which would be read with bytes, depth and times as few of its writers mean them"}}) {
    expect_clip_refused(scratch / name, {}, (said.starts_with(' ') ? name : "") + said);
  }
}

// FFmpeg takes what stands before a colon for a protocol.
TEST(Containers, HaveTheNameThatWasStatedWhateverItLooksLike) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25:d=0.4 -c:v ffv1 part.mkv");
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25:d=0.8 -c:v ffv1 whole.mkv");
  std::filesystem::rename(scratch / "whole.mkv", scratch / "file:part.mkv");
  std::filesystem::copy_file(scratch / "part.mkv", scratch / "12:30:01.mkv");
  const auto in = [&](const std::vector<std::string>& words) {
    const auto ran = run_program(words, scratch.folder());
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.out;
  };
  expect_says(in({"encode", "file:part.mkv", "a.tik"}), "20 samples");
  expect_says(in({"encode", "12:30:01.mkv", "b.tik"}), "10 samples");
  in({"video", "b.tik", "12:30 film.mkv"});
  EXPECT_GT(read_all(*open_test_clip(scratch / "12:30 film.mkv")).size(), 5u);
}

// FFmpeg makes 25 a second of nothing.
TEST(Containers, WhoseRateNobodyStatesNeedOne) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const std::string film = "-f lavfi -i testsrc2=s=64x48:r=50 -frames:v 6 ";
  const std::string untold = " does not say how fast it was taken; state the rate";
  const auto expect_untold = [&](const std::string& name, const std::string& said) {
    SCOPED_TRACE(name);
    expect_clip_refused(scratch / name, {}, name + said);
    const ClipOptions stated{.rate = Rational{240, 1}};
    const auto clip = open_test_clip(scratch / name, stated);
    EXPECT_GT(read_all(*clip).size(), 0u);
    EXPECT_EQ(timeline_of(name, clip->info(), stated, {360, 1}, 6).rate(), (Rational{240, 1}));
  };
  const std::string vui = film + "-c:v libx264 -preset ultrafast -bsf:v h264_metadata=tick_rate=";
  make(scratch, film + "-c:v libx264 -preset ultrafast t.h264");
  std::string y4m = "YUV4MPEG2 W4 H2 Ip Cmono\n";
  for (int k = 0; k < 6; ++k) y4m += "FRAME\n01234567";
  scratch.write("b.y4m", y4m);
  scratch.write("c.y4m", y4m.insert(y4m.find(" Ip"), " F0:0"));
  make(scratch, film + "-c:v mjpeg -pix_fmt yuvj420p a.mjpeg");
  make(scratch, film + "-c:v mjpeg -pix_fmt yuvj420p -f mpjpeg a.mpjpeg");
  make(scratch, film + "-c:v mjpeg -pix_fmt yuvj420p told.avi");
  std::string avi = read_file(scratch / "told.avi");
  const std::string junk("JUNK\xEC\xFF\0\0", 8);  // fills the 64 KiB that are searched for a rate
  scratch.write("junk.avi", avi.substr(0, 12) + junk + std::string(65'512, '.') + "strh" + avi.substr(12));
  avi.replace(avi.find("avih") + 8, 4, 4, '\0');
  avi.replace(avi.find("strh") + 28, 8, 8, '\0');
  scratch.write("a.avi", avi);
  make(scratch, film + "told.gif");
  std::string gif = read_file(scratch / "told.gif");
  const std::string control = "\x21\xF9\x04";
  for (auto at = gif.find(control); at != gif.npos; at = gif.find(control, at + 1))
    gif.replace(at + 4, 2, 2, '\0');
  scratch.write("a.gif", gif);
  for (const char* name : {"b.y4m", "c.y4m", "a.mjpeg", "a.mpjpeg", "a.avi", "a.gif"})
    expect_untold(name, untold);
  for (const char* ticks : {"2000000", "180000"}) {
    const std::string name = std::string(ticks) + ".h264";
    make(scratch, vui + ticks + " " + name);
    expect_untold(name, " does not say how fast it was taken: its header states ");
  }
  for (const char* name : {"told.avi", "junk.avi", "told.gif", "t.h264"}) {
    const auto rate = open_test_clip(scratch / name)->info().timing.rate;
    EXPECT_EQ(rate, (Rational{50, 1})) << name << " has " << (rate ? rate->text() : "no rate");
  }
}

// The edit list of the file has one part: adds bytes behind it, and sets the speed of the first.
std::string with_edits(std::string file, const std::string& more, const std::string& speed) {
  const auto add = [&](std::size_t at, std::size_t count) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<std::uint8_t>(file[at + i]);
    number += static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<char>(number >> (24 - 8 * i));
  };
  const std::size_t list = file.find("elst");
  file.replace(list + 20, 4, speed);
  file.insert(list + 24, more);
  for (const char* box : {"moov", "trak", "edts", "elst"}) add(file.find(box) - 4, more.size());
  add(list + 8, more.size() / 12);
  return file;
}

TEST(Containers, WithAnEditListGivePicturesOnceInTheirOrder) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch,
       "-f lavfi -i testsrc2=s=64x48:r=100 -frames:v 20 -c:v libx264 -bf 0 -pix_fmt yuv420p whole.mp4");
  const std::string whole = read_file(scratch / "whole.mp4");
  const auto plain = open_test_clip(scratch / "whole.mp4");
  EXPECT_TRUE(plain->info().notes.empty());
  const auto pictures = read_all(*plain);
  ASSERT_EQ(pictures.size(), 20u);
  const std::string normal("\0\1\0\0", 4), quarter("\0\0\x40\0", 4);
  const std::string again = std::string("\0\0\0\xC8\0\0\0\0", 8) + normal;
  for (const std::string& edited : {with_edits(whole, again, normal), with_edits(whole, "", quarter)}) {
    const auto clip = open_test_clip(scratch.write("edited.mp4", edited));
    EXPECT_TRUE(read_all(*clip) == pictures);
    EXPECT_EQ(clip->info().timing.rate, (Rational{100, 1}));
    ASSERT_EQ(clip->info().notes.size(), 1u);
    expect_says(clip->info().notes[0].text, "edit list");
  }
}

TEST(Containers, NameWhatIsMissingOrNotKnown) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const std::string film = "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 5 -pix_fmt ";
  make(scratch, film + "yuv420p -c:v libx264 a.mp4");
  const std::string whole = read_file(scratch / "a.mp4");
  expect_clip_refused(scratch.write("b.mp4", whole.substr(0, whole.find("moov") - 4)), {},
                      "its index (moov) is missing");
  make(scratch, film + "gray -c:v rawvideo a.avi");
  std::string avi = read_file(scratch / "a.avi");
  for (auto at = avi.find("Y800"); at != avi.npos; at = avi.find("Y800", at)) avi.replace(at, 4, "BA81");
  expect_clip_refused(scratch.write("b.avi", avi), {}, "which the file calls 'BA81'");
  make(scratch, "-i a.mp4 -i a.mp4 -map 0 -map 1 -c copy two.mkv");
  const auto notes = open_test_clip(scratch / "two.mkv")->info().notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].text.find("the file has 2 streams of pictures, and stream 0 is taken"), 0u)
      << notes[0].text;
}

TEST(Containers, OfASongWithACoverHoldNoFilm) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 1 cover.jpg");
  const std::string song = "-f lavfi -i sine=d=1 -i cover.jpg ", cover = "-disposition:v:0 attached_pic ";
  make(scratch, song + "-map 0 -map 1 -c:a aac -c:v copy " + cover + "song.m4a");
  expect_clip_refused(scratch / "song.m4a", {}, "song.m4a has no video stream");
  make(scratch, song + "-f lavfi -i testsrc2=s=32x32:r=25:d=0.04 -map 0 -map 1 -map 2 -c:a aac -c:v:0 copy "
                       "-c:v:1 mpeg4 " + cover + "film.mp4");
  const auto clip = open_test_clip(scratch / "film.mp4");
  EXPECT_EQ(clip->info().format.shape, (Shape{32, 32, 3})) << "the cover was taken";
  EXPECT_TRUE(clip->info().notes.empty());
}

// FFmpeg knows bitmaps with a new line behind their first letters alone.
TEST(Containers, OfBitmapsAreKnownByTheirFirstBytes) {
  const Scratch scratch;
  for (const char* name : {"a.pbm", "a.dat"}) {
    for (const std::string& bytes : {std::string("P4 3 2\n\xA0\x40"), std::string("P1 3 2\n101\n010\n")}) {
      const auto clip = open_test_clip(scratch.write(name, bytes));
      EXPECT_EQ(clip->info().format.shape, (Shape{3, 2, 1}));
      const auto rasters = read_all(*clip);
      ASSERT_EQ(rasters.size(), 1u);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(std::to_integer<int>(rasters[0][i]), i % 2 == 0 ? 0 : 255) << i;
    }
  }
}

// What was lost is a warning, which is said also where notes are not.
TEST(Containers, ThatWereCutOffWarn) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const std::string film = "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 20 ";
  for (const auto& [name, codec] :
       std::vector<std::pair<std::string, std::string>>{{"a.mkv", "-c:v ffv1"},
                                                        {"a.gif", ""},
                                                        {"a.y4m", "-pix_fmt yuv420p"},
                                                        {"live.mkv", "-c:v mjpeg -live 1"}}) {
    SCOPED_TRACE(name);
    make(scratch, film + codec + " " + name);
    EXPECT_TRUE(std::ranges::none_of(open_test_clip(scratch / name)->info().notes, &Note::is_warning));
    const std::string whole = read_file(scratch / name);
    const auto cut = open_test_clip(scratch.write("cut-" + name, whole.substr(0, whole.size() * 2 / 3)));
    EXPECT_TRUE(std::ranges::any_of(cut->info().notes, &Note::is_warning));
  }
}

// An index ends what ffmpeg writes, and others' files have none: only a picture that is not all there is left out.
TEST(Containers, WithoutAnIndexAreReadToTheirEnd) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 20 -c:v mjpeg -write_index 0 a.nut");
  const auto pictures = read_all(*open_test_clip(scratch / "a.nut"));
  EXPECT_EQ(pictures.size(), 20u);
  EXPECT_TRUE(open_test_clip(scratch / "a.nut")->info().notes.empty());
  const std::string whole = read_file(scratch / "a.nut");
  for (const std::size_t missing : {1u, 2u, 10u, 100u}) {
    const auto cut = open_test_clip(scratch.write("cut.nut", whole.substr(0, whole.size() - missing)));
    ASSERT_EQ(cut->info().notes.size(), 1u) << missing;
    EXPECT_TRUE(cut->info().notes[0].is_warning);
    EXPECT_EQ(read_all(*cut), std::vector(pictures.begin(), pictures.end() - 1)) << missing;
  }
}

// A stream tells no length: only where it was cut between two pictures nothing shows it.
TEST(Containers, ThatWereStreamedAndCutOffWarn) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 20 -c:v libx264 -live 1 a.mkv");
  const std::string whole = read_file(scratch / "a.mkv");
  EXPECT_TRUE(open_test_clip(scratch / "a.mkv")->info().notes.empty());
  constexpr std::size_t kBytes = 300;
  std::size_t silent = 0, pictures = 20;
  for (std::size_t missing = 1; missing < kBytes; ++missing) {
    const auto cut = open_test_clip(scratch.write("cut.mkv", whole.substr(0, whole.size() - missing)));
    if (std::ranges::any_of(cut->info().notes, &Note::is_warning)) continue;
    ++silent;
    EXPECT_LT(cut->info().sample_count, pictures) << missing;  // one less at each
    pictures = cut->info().sample_count;
  }
  EXPECT_LT(silent, 20u);
}

// As of a capture: what was made of a file that changed meanwhile is not used.
TEST(Containers, ThatAreMadeShorterWhileTheyAreReadAreNoticed) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25 -frames:v 20 -c:v ffv1 a.mkv");
  {
    const auto clip = open_test_clip(scratch / "a.mkv");
    EXPECT_NO_THROW(check_mapped_files());
    std::filesystem::resize_file(scratch / "a.mkv", 3000);
    EXPECT_THROW(check_mapped_files(), InputError);
  }
}

}  // namespace
}  // namespace nutik::test

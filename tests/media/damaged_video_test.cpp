// Videos that were damaged or cut off: refused, the same pictures, or a note. Decoders hand out pictures all the same.
#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kVideoShape{64, 48, 1};
constexpr int kPictures = 30;

class DamagedVideo : public testing::Test {
 protected:
  void make_clip(const std::string& codec, const std::string& name) const {
    const auto pictures = random_stills(kVideoShape, 255, kPictures, 1);
    scratch_.write("raw", bytes_of(pictures));
    test::make(scratch_, from_raw(kVideoShape, "gray") + codec + " " + name);
  }
  // A copy of whole.mkv in whose middle the bytes of three pictures are lost.
  std::filesystem::path write_hole() const {
    std::string damaged = read_file(scratch_ / "whole.mkv");
    const std::size_t lost = 3 * (damaged.size() / kPictures);
    damaged.replace(damaged.size() / 2, lost, lost, '\x0f');
    return scratch_.write("damaged.mkv", damaged);
  }
  Scratch scratch_;
};

TEST_F(DamagedVideo, OfFfv1IsNeverExposedSilently) {
  NEEDS_FFMPEG();
  make_clip("-c:v ffv1 -level 3 -slices 4 -slicecrc 1", "whole.mkv");
  const std::string whole = read_file(scratch_ / "whole.mkv");
  const auto pictures = read_all(*open_test_clip(scratch_ / "whole.mkv"));
  ASSERT_EQ(pictures.size(), std::size_t{kPictures});
  Random random(7);
  int refused = 0;
  for (int flip = 0; flip < 40; ++flip) {
    std::string damaged = whole;
    // Behind what tells where pictures lie, which a container may lose without a decoder's knowing.
    const auto at =
        static_cast<std::size_t>(random.whole(2000, static_cast<std::int64_t>(whole.size()) - 1000));
    damaged[at] = static_cast<char>(damaged[at] ^ 1 << random.whole(0, 7));
    const auto path = scratch_.write("damaged.mkv", damaged);
    try {
      const auto clip = open_test_clip(path);
      const auto read = read_all(*clip);
      EXPECT_TRUE(read == pictures || !clip->info().notes.empty()) << "byte " << at << " of " << whole.size();
    } catch (const InputError& error) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
}

// Decoders conceal it, and tell of that from threads of their own.
TEST_F(DamagedVideo, IsRefusedEachTimeOrNever) {
  NEEDS_FFMPEG();
  for (const auto& [codec, least] : {std::pair("libx264", 10), {"libx265 -x265-params log-level=none", 1}}) {
    test::make(scratch_, "-f lavfi -i testsrc2=s=320x240:r=30:d=1 -c:v " + std::string(codec) + " whole.mkv");
    const std::string whole = read_file(scratch_ / "whole.mkv");
    Random random(3);
    int refused = 0;
    for (int damage = 0; damage < 20; ++damage) {
      std::string damaged = whole;
      // Behind the first picture and what tells of the others.
      const auto at = static_cast<std::size_t>(random.whole(static_cast<std::int64_t>(whole.size()) / 2,
                                                            static_cast<std::int64_t>(whole.size()) - 1000));
      for (std::size_t i = 0; i < 40; ++i) damaged[at + i] = static_cast<char>(random.whole(0, 255));
      const auto path = scratch_.write("damaged.mkv", damaged);
      int times = 0;
      for (int time = 0; time < 5; ++time) {
        try {
          read_all(*open_test_clip(path));
        } catch (const InputError&) {
          ++times;
        }
      }
      EXPECT_TRUE(times == 0 || times == 5) << codec << ", byte " << at << ": " << times << " times";
      refused += times > 0 ? 1 : 0;
    }
    EXPECT_GE(refused, least) << codec;
  }
}

// A container's reader goes on behind what it does not understand, and nobody else knows of the pictures there.
TEST_F(DamagedVideo, WithAHoleIsRefused) {
  NEEDS_FFMPEG();
  make_clip("-c:v ffv1 -level 3", "whole.mkv");
  const auto pictures = read_all(*open_test_clip(scratch_ / "whole.mkv"));
  const auto path = write_hole();
  expect_error<InputError>([&] { read_all(*open_test_clip(path)); }, {"pictures before it can be taken"});
  const auto clip = open_test_clip(path, {.ends_at_damage = true});
  const auto read = read_all(*clip);
  EXPECT_TRUE(clip->ended_early());
  ASSERT_LE(read.size(), 15u);
  EXPECT_GE(read.size(), 10u);
  for (std::size_t k = 0; k < read.size(); ++k) EXPECT_TRUE(read[k] == pictures[k]) << k;
}

// Pictures that are passed over are counted, and behind a hole they would be others.
TEST_F(DamagedVideo, WithAHoleBeforeAPartIsRefused) {
  NEEDS_FFMPEG();
  make_clip("-c:v rawvideo", "whole.mkv");
  const auto pictures = read_all(*open_test_clip(scratch_ / "whole.mkv"));
  const auto path = write_hole();
  const ClipOptions options{.from = ClipMoment{22, true}};
  expect_error<InputError>([&] { read_all(*open_test_clip(path, options)); },
                           {"pictures are missing behind the first "});
  EXPECT_TRUE(read_all(*open_test_clip(scratch_ / "whole.mkv", options)) ==
              std::vector(pictures.begin() + 22, pictures.end()));
}

// Where no picture comes before a hole it is no hole, and time 0 is that of the first picture behind it.
TEST_F(DamagedVideo, WithoutItsStartSaysSo) {
  NEEDS_FFMPEG();
  make_clip("-c:v ffv1 -level 3 -g 1 -cluster_time_limit 200", "whole.mkv");
  std::string damaged = read_file(scratch_ / "whole.mkv");
  const auto pictures = read_all(*open_test_clip(scratch_ / "whole.mkv"));
  const std::string cluster = "\x1F\x43\xB6\x75";
  const auto first = damaged.find(cluster), later = damaged.find(cluster, damaged.size() / 3);
  ASSERT_LT(later, damaged.size());
  damaged.erase(first, later - first);
  const auto clip = open_test_clip(scratch_.write("damaged.mkv", damaged));
  const auto read = read_all(*clip);
  ASSERT_LT(read.size(), pictures.size());
  const std::size_t missing = pictures.size() - read.size();
  for (std::size_t k = 0; k < read.size(); ++k) EXPECT_TRUE(read[k] == pictures[k + missing]) << k;
  ASSERT_EQ(clip->info().notes.size(), 1u);
  EXPECT_EQ(
      clip->info().notes[0].text,
      format("the file lasts {:.4g} s from its start on, and its first picture comes after {:.4g} s: those "
             "before it were cut off, or cannot be read. Time 0 is that of the first that can",
             kPictures / 25.0, static_cast<double>(missing) / 25.0));
}

// As programs cut films without encoding them anew: each part begins when it did in the film.
TEST_F(DamagedVideo, IsNoSegmentOfAFilm) {
  NEEDS_FFMPEG();
  make_clip("-c:v libx264 -bf 0 -g 10 -sc_threshold 0 -f segment -segment_time 0.4", "part%d.mkv");
  const auto clip = open_test_clip(scratch_ / "part1.mkv");
  EXPECT_EQ(read_all(*clip).size(), 10u);
  for (const Note& note : clip->info().notes) ADD_FAILURE() << note.text;
}

// Cut in front of a key picture to whose group pictures belong that are shown before it, and refer to what is gone.
TEST_F(DamagedVideo, IsNoneThatWasCutWithoutEncodingIt) {
  NEEDS_FFMPEG();
  for (const std::string pyramid : {"", ":b-pyramid=2:ref=6"}) {
    make_clip("-c:v libx264 -pix_fmt yuv420p -bf 4 -x264opts open-gop=1:keyint=10" + pyramid, "whole.ts");
    const auto pictures = read_all(*open_test_clip(scratch_ / "whole.ts"));
    test::make(scratch_, "-i whole.ts -c copy whole.mp4");
    for (const std::string film : {"whole.ts", "whole.mp4"}) {
      for (const std::string part : {"cut.ts", "cut.mp4", "cut.mkv"}) {
        if (film == "whole.mp4" && part == "cut.ts") continue;
        test::make(scratch_, "-ss 0.53 -i " + film + " -c copy " + part);
        const auto read = read_all(*open_test_clip(scratch_ / part));
        EXPECT_GT(read.size(), 5u) << film << part;
        for (std::size_t k = 0; k < std::min(read.size(), pictures.size()); ++k)
          EXPECT_TRUE(read[read.size() - 1 - k] == pictures[pictures.size() - 1 - k]) << film << part << k;
      }
    }
  }
}

// Before a decoder makes room for them.
TEST_F(DamagedVideo, OfMorePixelsThanItsBytesHoldIsRefused) {
  const auto said_of = [&](const char* size) {
    const auto path = scratch_.write("a.y4m", std::string("YUV4MPEG2 ") + size + " F25:1 C420jpeg\nFRAME\n1234");
    return message_of<InputError>([&] { read_all(*open_test_clip(path)); });
  };
  const std::string said = said_of("W12000 H12000");
  expect_says(said, "12000 x 12000 pixels are more than its ");
  EXPECT_EQ(said_of("W7680 H4320").find("more than its"), std::string::npos) << "of black such a clip may be as small";
}

// As far as it goes: the pictures before the damage, and why there are no more.
TEST_F(DamagedVideo, IsTakenAsFarAsItGoesWhereThatIsAsked) {
  NEEDS_FFMPEG();
  make_clip("-c:v ffv1 -level 3 -slices 4 -slicecrc 1", "whole.mkv");
  const std::string whole = read_file(scratch_ / "whole.mkv");
  const auto pictures = read_all(*open_test_clip(scratch_ / "whole.mkv"));
  std::string damaged = whole;
  damaged[whole.size() * 2 / 3] = static_cast<char>(damaged[whole.size() * 2 / 3] ^ 8);
  const auto path = scratch_.write("damaged.mkv", damaged);
  const auto error = error_of<InputError>([&] { read_all(*open_test_clip(path)); });
  ASSERT_TRUE(error) << "it was read";
  EXPECT_EQ(error->settings(), std::vector{Setting::end_at_damage}) << error->what();
  const ClipOptions options{.ends_at_damage = true};
  const auto clip = open_test_clip(path, options);
  const auto read = read_all(*clip);
  // Some pictures before the damaged one, at 2/3 of the file, may be lost with it: decoders are ahead.
  EXPECT_GE(read.size(), 10u);
  EXPECT_LE(read.size(), 20u);
  for (std::size_t k = 0; k < read.size(); ++k) EXPECT_TRUE(read[k] == pictures[k]) << k;
  ASSERT_TRUE(clip->ended_early());
  EXPECT_NE(clip->ended_early()->find("damaged.mkv is taken as far as it goes, " +
                                      std::to_string(read.size()) + " of 30 pictures: "),
            std::string::npos)
      << *clip->ended_early();
  const auto undamaged = open_test_clip(scratch_ / "whole.mkv", options);
  EXPECT_TRUE(read_all(*undamaged) == pictures);
  EXPECT_FALSE(undamaged->ended_early());
  // The first picture has to be there.
  damaged = whole;
  for (std::size_t at = 2000; at < damaged.size(); at += 500)
    damaged[at] = static_cast<char>(damaged[at] ^ 8);
  EXPECT_THROW(read_all(*open_test_clip(scratch_.write("all.mkv", damaged), options)), InputError);
}

// Whatever is wrong with a picture, the way out is named: those before it. Of the first there is none.
TEST_F(DamagedVideo, NamesThePicturesThatCanBeTaken) {
  const auto stills = random_stills({8, 8, 1}, 255, 4, 1);
  for (int k = 0; k < 4; ++k) {
    scratch_.write("s" + std::to_string(k) + ".pgm",
                   k == 2 ? "P5\n8 8\n255\nshort" : netpbm_file(stills[static_cast<std::size_t>(k)], true));
  }
  const auto refusal = [&](const std::string& pattern) {
    const auto error = error_of<InputError>([&] { read_all(*open_test_clip(scratch_ / pattern)); });
    return error.value_or(InputError("it was read"));
  };
  const InputError of_third = refusal("s*.pgm"), of_first = refusal("s[23].pgm");
  const std::string third = of_third.what(), first = of_first.what();
  expect_says(third, "s2.pgm cannot be read: it was cut off");
  expect_says(third, "; a folder or table without it keeps the others, and the 2 pictures before it can be taken");
  EXPECT_EQ(of_third.settings(), std::vector{Setting::end_at_damage});
  EXPECT_EQ(first.find("can be taken"), std::string::npos) << first;
  EXPECT_EQ(of_first.settings(), std::vector<Setting>());
}

// Where a container tells how long it lasts, or has whole pictures only, a note says what is missing; elsewhere the
// decoder refuses the picture that was cut.
TEST_F(DamagedVideo, ThatWasCutOffSaysSo) {
  NEEDS_FFMPEG();
  const std::string lasts = "the file says that it lasts 1.2 s, and its pictures end after ",
                    within = "it was cut off within picture ";
  struct Cut {
    std::string codec, name, note;
  };
  for (const auto& [codec, name, note] :
       std::vector<Cut>{{"-c:v ffv1", "c.mkv", lasts},
                        {"-c:v libx264 -qp 0 -pix_fmt gray", "h.mkv", lasts},
                        {"-c:v mjpeg -pix_fmt yuvj420p", "m.avi", "the file " + within.substr(3)},
                        {"-f yuv4mpegpipe -pix_fmt gray", "p.y4m", within}}) {
    SCOPED_TRACE(name);
    make_clip(codec, name);
    EXPECT_TRUE(open_test_clip(scratch_ / name)->info().notes.empty());
    const std::string whole = read_file(scratch_ / name);
    for (const double share : {0.3, 0.5, 0.7}) {
      const auto path = scratch_.write(
          "cut-" + name,
          whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
      const auto clip = open_test_clip(path);
      EXPECT_LT(read_all(*clip).size(), std::size_t{kPictures}) << share;
      ASSERT_EQ(clip->info().notes.size(), 1u) << share;
      EXPECT_TRUE(clip->info().notes[0].text.starts_with(note))
          << share << ": " << clip->info().notes[0].text;
    }
  }
}

TEST_F(DamagedVideo, WithSoundThatLastsLongerIsWhole) {
  NEEDS_FFMPEG();
  scratch_.write("raw", bytes_of(random_stills(kVideoShape, 255, kPictures, 1)));
  for (const char* name : {"s.mkv", "s.mp4", "s.avi"}) {
    test::make(scratch_, from_raw(kVideoShape, "gray") +
                             "-f lavfi -i sine=duration=5 -c:v mjpeg -pix_fmt yuvj420p -c:a aac " + name);
    const auto clip = open_test_clip(scratch_ / name);
    EXPECT_TRUE(clip->info().notes.empty()) << name << ": " << clip->info().notes.front().text;
    EXPECT_EQ(read_all(*clip).size(), std::size_t{kPictures}) << name;
  }
}

}  // namespace
}  // namespace nutik::test

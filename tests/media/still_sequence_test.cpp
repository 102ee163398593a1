// Which files a folder, a pattern or a numbered name stands for, and what is said where it stands
// for none.
#include "media/stills/still_sequence.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

class StillSequence : public testing::Test {
 protected:
  void touch(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      std::filesystem::create_directories((scratch_ / name).parent_path());
      scratch_.write(name, "x");
    }
  }

  [[nodiscard]] std::string listed(const std::string& path) const {
    const auto files = list_stills(scratch_ / path);
    if (!files) return "no stills";
    std::string text;
    for (const auto& file : *files) text += (text.empty() ? "" : " ") + file.filename().string();
    return text;
  }

  void expect_refused(const std::string& path, const std::vector<std::string>& parts) const {
    SCOPED_TRACE(path);
    expect_error<InputError>([&] { return listed(path); }, parts);
  }

  Scratch scratch_;
};

TEST_F(StillSequence, AFolderHoldsItsPicturesAsAPersonCounts) {
  touch({"a/f10.png", "a/f9.PNG", "a/f1.png", "a/f009.png", "a/notes.txt", "a/Thumbs.db", "a/._f1.png"});
  EXPECT_EQ(listed("a"), "f1.png f9.PNG f009.png f10.png");
  EXPECT_EQ(listed("a/"), listed("a"));
  std::filesystem::create_directory(scratch_ / "a/f2.png");  // a folder in spite of its name
  EXPECT_EQ(listed("a"), "f1.png f9.PNG f009.png f10.png");
}

TEST_F(StillSequence, WhatIsNotNumberedAlikeIsNotTakenAlong) {
  const auto note = [&](const std::string& folder) {
    return left_out_note(scratch_ / folder, *list_stills(scratch_ / folder)).value_or("nothing");
  };
  touch({"a/1.png", "a/2.png", "a/3.png", "a/1 (copy).png", "a/3.bak.png"});
  EXPECT_EQ(listed("a"), "1.png 2.png 3.png");
  expect_says(note("a"),
              "not taken along, because their names are of another kind than 1.png: 1 (copy).png, 3.bak.png;");
  EXPECT_EQ(listed("a/*.png").size(), std::string("1.png 2.png 3.png 1 (copy).png 3.bak.png").size());
  touch({"words/dawn.png", "words/noon.png", "words/dusk1.png", "words/dusk2.png"});
  EXPECT_EQ(listed("words"), "dawn.png dusk1.png dusk2.png noon.png");
  EXPECT_EQ(note("words"), "nothing");
  touch({"times/2026-01-01 10.00.58.png", "times/2026-01-01 10.01.00.png"});
  EXPECT_EQ(note("times"), "nothing");
}

TEST_F(StillSequence, TwoSequencesInAFolderAreNotRunTogether) {
  touch({"a/left_000.png", "a/left_001.png", "a/right_000.png", "a/right_001.png"});
  expect_refused("a", {"a: the folder holds two sequences, of left_000.png (2 pictures) and of right_000.png (2)",
                       "a/left_*.png' or '", "a/*.png' takes all"});
  EXPECT_EQ(listed("a/left_*.png"), "left_000.png left_001.png");
}

TEST_F(StillSequence, TwoKindsInAFolderAreNotMixed) {
  touch({"a/f1.tif", "a/f2.tiff", "b/f1.png", "b/f2.png", "b/preview.jpg"});
  EXPECT_EQ(listed("a"), "f1.tif f2.tiff");
  expect_refused("b", {"b: the folder holds PNG files (f1.png) and JPEG files (preview.jpg)", "b/*.png'"});
  EXPECT_EQ(listed("b/*.png"), "f1.png f2.png");
}

TEST_F(StillSequence, PatternsAreThoseOfTheShell) {
  touch({"cam1/f1.png", "cam1/f2.png", "cam1/f12.png", "cam2/f3.png", "cam1/.f4.png", "cam1/f1.txt"});
  EXPECT_EQ(listed("cam1/*.png"), "f1.png f2.png f12.png");
  EXPECT_EQ(listed("cam1/f?.png"), "f1.png f2.png");
  EXPECT_EQ(listed("cam1/f[2-9].png"), "f2.png");
  EXPECT_EQ(listed("cam*/f?.png"), "f1.png f2.png f3.png");
  expect_refused("cam1/*.tif", {"cam1/*.tif: no file matches"});
  expect_refused("absent/*.png", {"absent/*.png: no file matches"});
  touch({"a[b]/f1.png", "a[b]/f2.png", "ab/f3.png"});
  EXPECT_EQ(listed("a[b]/*.png"), "f1.png f2.png") << "a folder that is there likewise";
  touch({"f[1].png", "f1.png"});
  EXPECT_EQ(listed("f[1].png"), "f[1].png") << "a file that is there goes before a pattern";
}

TEST_F(StillSequence, NumbersAreReadAsPrintfWritesThem) {
  touch({"f0008.png", "f0009.png", "f0010.png", "f8.png", "f9.png", "f10.png", "f0010.txt", "fx.png"});
  EXPECT_EQ(listed("f%04d.png"), "f0008.png f0009.png f0010.png");
  EXPECT_EQ(listed("f%d.png"), "f8.png f9.png f10.png");
  EXPECT_EQ(listed("f%i.png"), listed("f%d.png"));
  touch({"g 9.png", "g10.png", "h99.png", "h100.png"});
  EXPECT_EQ(listed("g%2d.png"), "g 9.png g10.png");
  EXPECT_EQ(listed("h%02d.png"), "h99.png h100.png");
  touch({"100%_1.png", "100%_2.png"});
  EXPECT_EQ(listed("100%_%d.png"), "100%_1.png 100%_2.png");
}

TEST_F(StillSequence, SaysWhichNumberIsMissing) {
  touch({"f0001.png", "f0002.png", "f0005.png"});
  expect_refused("f%04d.png", {"f%04d.png: f0003.png is missing between f0002.png and f0005.png", "f*.png'"});
  expect_refused("f%d.png", {"no file has such a name, f1.png for one",
                             "f0005.png is there: its zeros are written %04d"});
  expect_refused("g%d.png", {"g%d.png: no file has such a name, g1.png for one"});
  expect_refused("absent/g%d.png", {"no file has such a name"});
}

TEST_F(StillSequence, TellsOfAHoleInAFolder) {
  const auto note = [&](const std::string& folder, const std::vector<std::string>& names) {
    std::vector<std::string> files;
    for (const std::string& name : names) files.push_back(folder + "/" + name);
    touch(files);
    return missing_still_note(folder, *list_stills(scratch_ / folder)).value_or("nothing");
  };
  EXPECT_EQ(
      note("one", {"frame_0001.png", "frame_0002.png", "frame_0004.png"}),
      "one: frame_0003.png is missing between frame_0002.png and frame_0004.png; pictures behind a hole "
      "get the times of earlier ones. A table of stills (.csv) gives each its own time; if nothing was "
      "lost: 'one/*.png'");
  const auto starts = [&](const std::string& text, std::string_view start) {
    EXPECT_TRUE(text.starts_with(start)) << text;
  };
  starts(note("wide", {"cam2_8b.tif", "cam2_9b.tif", "cam2_12b.tif", "cam2_14b.tif"}),
         "wide: cam2_10b.tif is missing between cam2_9b.tif and cam2_12b.tif, and 2 more;");
  starts(note("tens", {"0010.png", "0020.png", "0040.png"}), "tens: 0030.png is missing");
  EXPECT_EQ(note("whole", {"9.png", "10.png", "11.png"}), "nothing");
  EXPECT_EQ(note("twos", {"f2.png", "f4.png", "f6.png"}), "nothing");
  EXPECT_EQ(note("times", {"t0000.png", "t0033.png", "t0067.png", "t0100.png"}), "nothing");
  EXPECT_EQ(note("cameras", {"a1.png", "a2.png", "b4.png"}), "nothing");
  EXPECT_EQ(note("words", {"dawn.png", "noon.png", "dusk5.png"}), "nothing");
  EXPECT_EQ(note("twice", {"f1.png", "f01.png", "f3.png"}), "nothing");
  EXPECT_EQ(note("clock", {"IMG_20260812_223050.jpg", "IMG_20260812_223055.jpg", "IMG_20260812_223100.jpg"}),
            "nothing");
  EXPECT_EQ(note("whole-clock", {"20260812223055123.jpg", "20260812223056123.jpg", "20260812223100123.jpg"}),
            "nothing");
  starts(note("days", {"20260812_000058.jpg", "20260812_000059.jpg", "20260812_000061.jpg"}),
         "days: 20260812_000060.jpg is missing");
  EXPECT_EQ(note("single", {"f7.png"}), "nothing");
}

TEST_F(StillSequence, LeavesOtherFilesToOthers) {
  touch({"clip.mp4", "still.png"});
  std::filesystem::create_directory(scratch_ / "empty");
  EXPECT_EQ(listed("clip.mp4"), "no stills");
  EXPECT_EQ(listed("absent.mp4"), "no stills");
  EXPECT_EQ(listed("still.png"), "still.png");
  expect_refused("empty",
                 {"empty: the folder holds no picture (PNG, JPEG, TIFF, DNG, Netpbm, OpenEXR, PFM, NumPy)"});
}

TEST_F(StillSequence, NamesWhatIsMadeFromIt) {
  touch({"frames.2/f1.png", "frames.2/f2.png", "clip.mp4"});
  const auto name = [&](const char* path) { return sequence_name(scratch_ / path); };
  EXPECT_EQ(name("clip.mp4"), "clip");
  EXPECT_EQ(name("frames.2"), "frames.2");
  EXPECT_EQ(name("frames.2/"), "frames.2");
  EXPECT_EQ(name("frames.2/."), "frames.2");
  EXPECT_EQ(name("frames.2/*.png"), "frames.2");
  EXPECT_EQ(name("frames.2/f%d.png"), "f");
  EXPECT_EQ(name("frames.2/%04d.png"), "frames.2");
  EXPECT_EQ(name("shot_%04d.png"), "shot");
  EXPECT_EQ(name("shot_*"), "shot");
}

}  // namespace
}  // namespace nutik::test

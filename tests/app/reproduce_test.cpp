// Pictures carry how they were made, and can be made again from that.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/still_clip.hpp"

namespace nutik::test {
namespace {

class Reproduce : public AppTest {
 protected:
  void SetUp() override {
    write_still_clip(scratch_.folder(), 24, 40);
    make("-f 40 frames clip.tik");
    scratch_.write("it's f.fn",
                   "M0 [0:1], [50000000:0] # caf\xe9\nM9 [10000000:0], [60000000:2], [90000000:0]\n");
    std::string mask = "P2 24 24 255\n";
    for (int i = 0; i < 24 * 24; ++i) mask += i % 5 == 0 ? "9 " : "0 ";
    scratch_.write("mask.pgm", mask);
  }
};

TEST_F(Reproduce, MakesPixelsSquareOrKeepsThemAsBefore) {
  make("-f 40 --pixel-aspect 2:1 frames wide.tik");
  make("--exposure 33ms wide.tik square.png");
  make("--exposure 33ms --keep-pixels wide.tik kept.png");
  ASSERT_NE(file("square.png"), file("kept.png"));
  for (const char* picture : {"square.png", "kept.png"}) expect_made_again(picture);
}

TEST_F(Reproduce, MakesTheSameBytes) {
  int number = 0;
  for (const std::string extension : {".png", ".tif", ".pgm"}) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--start", "0.1s", "--exposure", "3f", "clip.tik"},
          {"--exposure", "0.3s", "--shutter", "spline:0=0,0.3=1,1=0", "--normalize", "integral", "--ev",
           "-0.5", "--renderer", "reference", "clip.tik"},
          {"-k", "it's f.fn", "-m", "mask.pgm", "--start", "250ms", "clip.tik", "--precision", "single"},
          {"-f", "40", "-a", "90", "--exposure", "33ms", "--tolerance", "2", "--transfer", "gamma:2",
           "frames"},
          {"-f", "40", "--exposure", "33ms", "frames/*.pgm"}}) {
      const std::string picture = "picture " + std::to_string(number++) + extension;
      make(words + Words{"-o", picture});
      expect_made_again(picture);
    }
  }
  make("--exposure 50ms --depth float clip.tik light.tif");
  expect_made_again("light.tif");
}

// Names in any encoding, and with what would number pictures.
TEST_F(Reproduce, KeepsNamesAsTheyAre) {
  for (const std::string name : {"caf\xe9.tik", "p%d.tik"}) {
    std::filesystem::copy(scratch_ / "clip.tik", scratch_ / name);
    make({"--start", "0s", "--exposure", "50ms", name, "a.png", "--overwrite"});
    expect_made_again("a.png");
  }
  const std::string out = make({"--start", "0s", "--exposure", "50ms", "p%d.tik"}).out;
  EXPECT_TRUE(out.starts_with("p_d-")) << out;
}

TEST_F(Reproduce, NamesTheProgramAsItWasRun) {
  make("--exposure 50ms clip.tik a.png");
  const std::filesystem::path program = NUTIK_TEST_PROGRAM;
  std::filesystem::create_directory(scratch_ / "my tools");
  std::filesystem::create_symlink(program, scratch_ / "my tools/nutik-cl");
  const auto found = shell("PATH='" + program.parent_path().string() + "':$PATH; nutik-cl reproduce a.png");
  EXPECT_TRUE(found.out.starts_with("nutik-cl expose ")) << found.out << found.err;
  const auto quoted = shell("'my tools/nutik-cl' reproduce a.png");
  EXPECT_TRUE(quoted.out.starts_with("'my tools/nutik-cl' expose ")) << quoted.out << quoted.err;
  shell("'my tools/nutik-cl' reproduce a.png | sh");
}

TEST_F(Reproduce, MakesOnePictureOfASeries) {
  make({"-k", "it's f.fn", "-m", "mask.pgm", "--every", "1/7s", "--count", "3", "clip.tik", "s-%d.png"});
  expect_says(make("reproduce s-2.png").out, " --start 2/7s ");
  expect_made_again("s-2.png");
  make("-f 40 --exposure 20ms --every 10f --start 1f frames t-%d.png");
  expect_made_again("t-3.png");
}

// As plain intervals where they are such, else from functions that the pictures carry.
TEST_F(Reproduce, MakesOnePictureOfASweep) {
  const auto sweep = [&](const Words& words) { return make("sweep" + words + "clip.tik sheet.png").err; };
  EXPECT_EQ(sweep({"--start", "1f", "--exposure", "3f", "--shift", "-1f..5f/3f", "--scale-gain",
                   "0.3..1/0.35", "--ev", "0.5", "--normalize", "integral", "--each", "box-%d.png"}),
            "");
  const std::string box = make("reproduce box-4.png").out;
  expect_says(box, {" --start 75ms ", " --exposure 75ms ", " --gain 0.9"});
  EXPECT_EQ(sweep({"--exposure", "0.1s", "--shutter", "strobe:3", "--shift", "0..0.2s/0.1s", "--stretch",
                   "1..2/1", "--each", "strobe-%d.tif"}),
            "");
  sweep({"-k", "it's f.fn", "-m", "mask.pgm", "--start", "20ms", "--shift", "-60ms..0.1s/80ms", "--stretch",
         "0.7..2/1", "--each", "file-%d.pgm"});
  expect_says(make("reproduce file-5.pgm").err, "file-5.fn is not there; the functions");
  EXPECT_EQ(
      sweep({"--exposure", "0.1s", "--shutter", "hann", "--stretch", "0.5..2/0.5", "--each", "hann-%d.png"}),
      "");
  for (const char* picture : {"box-0.png", "box-4.png", "box-8.png", "strobe-2.tif", "strobe-4.tif",
                              "file-0.pgm", "file-3.pgm", "file-5.pgm", "hann-0.png", "hann-1.png"}) {
    expect_made_again(picture);
  }

  // expose refuses what lies outside the capture.
  expect_says(
      sweep({"--start", "0.9s", "--exposure", "0.1s", "--shift", "0..0.1s/0.1s", "--each", "no-%d.png"}),
      "warning: no-1.png: it carries no recipe: ");
  expect_made_again("no-0.png");
  make({"reproduce", "no-1.png"}, 3);
}

// A sheet is made anew by the command that made it, with all that lies on it and how it lies.
TEST_F(Reproduce, MakesSheets) {
  make(
      "contact --start 0.1s --every 1/7s --exposure 2f --columns 2 --width 300 --negative abs --transfer "
      "gamma:2 clip.tik contact.png");
  make({"contact", "-f", "40", "-a", "90", "--tolerance", "2", "frames", "-o", "whole clip.tif"});
  make({"sweep", "-k", "it's f.fn", "-m", "mask.pgm", "--shift", "-1f..3f/2f", "--scale-gain", "0.5..1/0.25", "--width",
        "500", "--precision", "fixed", "clip.tik", "sweep.jpg"});
  make(
      "sweep --exposure 0.1s --shutter hann --stretch 0.5..2/0.5 --columns 1 --out-transfer linear "
      "--renderer reference --each one-%d.png clip.tik one.png");
  expect_made_again("contact.png", "contact");
  expect_made_again("whole clip.tif", "contact");
  expect_made_again("sweep.jpg", "sweep");
  expect_made_again("one.png", "sweep");
  expect_made_again("one-2.png");

  make("contact --no-recipe clip.tik silent.png");
  expect_refused({"reproduce", "silent.png"}, 3,
                 "silent.png carries no recipe. Exposures, sheets and a video's stills do");
}

// Whatever a stranger's sheet says, what is printed makes a sheet or a picture.
TEST_F(Reproduce, RefusesCommandsThatLeaveNoRecipes) {
  make("contact clip.tik a.ppm");
  std::string sheet = file("a.ppm");
  const auto replace = [&](const std::string& what, const std::string& by) {
    const auto at = sheet.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    sheet.replace(at, what.size(), by);
    scratch_.write("a.ppm", sheet);
  };
  const auto refused = [&](const std::string& why) { expect_refused("reproduce a.ppm", 3, why); };
  replace("\"contact\"", "\"recover\"");
  refused("its recipe is one of 'recover', which leaves none");
  replace("\"recover\"", "\"contact\"");
  replace("\"options\":{", "\"options\":{\"shift\":\"1f..2f/1f\"");
  refused("its recipe states '--shift 1f..2f/1f', which no recipe of nutik-cl");
}

TEST_F(Reproduce, LooksForTheFilesItNeeds) {
  make({"-k", "it's f.fn", "-m", "mask.pgm", "clip.tik", "a.png"});
  const std::string picture = file("a.png");
  std::filesystem::create_directory(scratch_ / "kept");
  std::filesystem::rename(scratch_ / "clip.tik", scratch_ / "kept/clip.tik");
  EXPECT_EQ(make("reproduce a.png", 3).err,
            "warning: the capture clip.tik is not in the current folder; name its folder: nutik-cl reproduce "
            "PICTURE FOLDER\n");
  expect_says(make("reproduce a.png kept").out, " kept/clip.tik -o a.png");

  // Another capture of the same name is not taken for it.
  make("-f 41 frames clip.tik");
  expect_says(make("reproduce a.png kept").out, " kept/clip.tik ");
  expect_says(make("reproduce a.png", 3).err,
              "clip.tik is not the capture that the picture was made from: its checksum differs");
  std::filesystem::rename(scratch_ / "kept/clip.tik", scratch_ / "clip.tik");

  scratch_.write("mask.pgm", "P2 24 24 255\n" + std::string(24 * 24 * 2, ' '));
  expect_says(make("reproduce a.png", 3).err, "mask.pgm is not the mask that");
}

TEST_F(Reproduce, WritesFunctionsThatAreGoneOrChanged) {
  make({"-k", "it's f.fn", "-m", "mask.pgm", "clip.tik", "a.png"});
  const std::string functions = file("it's f.fn");
  scratch_.write("it's f.fn", "M0 [0:0]\n");
  EXPECT_EQ(make("reproduce a.png").err,
            "warning: it's f.fn was changed since; the functions that the picture was made with were written to "
            "a-again/it's f.fn\n");
  EXPECT_EQ(file("a-again/it's f.fn"), functions);
  expect_made_again("a.png");
  std::filesystem::remove(scratch_ / "it's f.fn");
  std::filesystem::remove(scratch_ / "a-again/it's f.fn");
  expect_says(make("reproduce a.png").err, "is not there; the functions");
  expect_made_again("a.png");
  scratch_.write("a-again/it's f.fn", "notes of mine");
  make("reproduce a.png", 5);
  EXPECT_EQ(file("a-again/it's f.fn"), "notes of mine");
}

// A video's still is an exposure like another.
TEST_F(Reproduce, MakesAVideosStills) {
  make(
      "video --out-fps 30000/1001 --from 1/7s --speed 0.3 --shutter hann --ev 1 --out-transfer linear "
      "clip.tik plain-%02d.png");
  for (const std::string name : {"plain-00.png", "plain-07.png"}) expect_made_again(name);
  make({"video", "-k", "it's f.fn", "-m", "mask.pgm", "--depth", "16", "--to", "0.5s", "clip.tik", "f-%d.tif"});
  for (const std::string name : {"f-0.tif", "f-3.tif"}) expect_made_again(name);
  make("video --no-recipe --to 0.2s clip.tik bare-%d.png");
  EXPECT_EQ(file("bare-0.png").find("nutik"), std::string::npos);
}

TEST_F(Reproduce, SaysWhereThereIsNoRecipe) {
  make("--exposure 33ms clip.tik private.png --no-recipe");
  EXPECT_EQ(file("private.png").find("nutik"), std::string::npos);
  EXPECT_EQ(file("private.png").find("clip.tik"), std::string::npos);
  expect_refused("reproduce private.png", 3, "private.png carries no recipe");
  make("activity clip.tik chart.png");
  expect_refused("reproduce chart.png", 3, "not backgrounds, charts, traces, masks");
  expect_refused("reproduce private.png clip.tik", 2, "clip.tik is no folder");
  make("reproduce", 2);
  make("reproduce clip.tik", 3);
}

// A picture may come from anyone, and what is printed may be run.
TEST_F(Reproduce, TakesNoOrdersFromAPicture) {
  const auto expect_no_order = [&](const std::string& recipe, const std::string& message) {
    scratch_.write("evil.pgm", "P5\n# " + recipe + "\n1 1\n255\nx");
    expect_refused("reproduce evil.pgm", 3, message);
  };
  const auto recipe = [](const std::string& capture, const std::string& functions,
                         const std::string& options) {
    return R"({"nutik-cl":"0","capture":{"name":")" + capture + R"(","checksum":"x"},"functions":{"name":")" +
           functions + R"(","text":"M0 [0:1]\n"},"options":{)" + options +
           R"(},"renderer":"opencl","precision":"double"})";
  };
  for (const char* option :
       {R"("ev 1; touch pwned; #":"1")", R"("output":"clip.tik")", R"("rectangle":"1,1,1,1")",
        R"("mask":"m.pgm")", R"("noise":"camera.noise")", R"("no-recipe":"")", R"("delay":"/a/b.png:0s..1s")",
        R"("delay":"rows:")", R"("delay":"rows:1s"},"delay_map":{"name":"m.pgm","checksum":"x")",
        R"("delay":"/a/b.png:0s..1s"},"delay_map":{"name":"m.pgm","checksum":"x")"}) {
    expect_no_order(recipe("clip.tik", "f.fn", option), "its recipe states '--");
  }
  const std::string beside = scratch_.folder().filename().string() + "-pwned.sh";
  for (const std::string& name : {"../" + beside, (scratch_ / "pwned.sh").string(), std::string(".."),
                                  std::string(), std::string("a/b.fn"), std::string(".")}) {
    expect_no_order(recipe("clip.tik", name, ""), "its recipe names '");
    EXPECT_FALSE(std::filesystem::exists(scratch_.folder().parent_path() / beside));
    EXPECT_FALSE(exists("pwned.sh"));
  }
  for (const char* name : {"../clip.tik", "/clip.tik", "a/b/clip.tik", "a/", "..", ""}) {
    expect_no_order(recipe(name, "f.fn", ""), "its recipe names '");
  }
  // What may be shown does not write to the terminal by itself.
  scratch_.write("sly.pgm", "P5\n# " + recipe("\\u001b[2Jclip.tik", "f.fn", "") + "\n1 1\n255\nx");
  EXPECT_EQ(run("reproduce sly.pgm").err.find('\x1b'), std::string::npos);
}

// Who sends a picture may send a folder of links with it, and any text as its functions.
TEST_F(Reproduce, WritesOnlyWhatItReadsAndOnlyIntoItsOwnFolder) {
  const auto again = [&](const std::string& name, const std::string& text, int status) {
    scratch_.write("sent.pgm",
                   R"(P5
# {"nutik-cl":"0","capture":{"name":"clip.tik","checksum":"x"},"functions":{"name":")" +
                       name + R"(","text":")" + text +
                       R"("},"options":{},"renderer":"opencl","precision":"double"}
1 1
255
x)");
    return make("reproduce sent.pgm", status);
  };
  const std::filesystem::path elsewhere = scratch_ / "elsewhere", folder = scratch_ / "sent-again";
  std::filesystem::create_directory(elsewhere);

  const auto result = again("cron", "* * * * * touch pwned", 3);
  expect_says(result.err, "cron in the recipe of sent.pgm has mistakes");
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder));

  std::filesystem::create_directory_symlink("elsewhere", folder);
  expect_says(again("f.fn", "M0 [0:1]", 5).err, "sent-again is a link, or no folder of yours");
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere));

  std::filesystem::remove(folder);
  std::filesystem::create_directory(folder);
  for (const char* target : {"../elsewhere/f.fn", "../it's f.fn"}) {
    std::filesystem::create_symlink(target, folder / "f.fn");
    expect_says(again("f.fn", "M0 [0:1]", 5).err, "sent-again/f.fn exists and is another file");
    std::filesystem::remove(folder / "f.fn");
  }
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere));

  // Longer than a file system takes.
  expect_says(again(std::string(300, 'f'), "M0 [0:1]", 5).err, "cannot be created: File name too long");

  expect_says(again(".profile", "M0 [0:1]", 3).out, " -k sent-again/.profile.fn ");
  EXPECT_EQ(file("sent-again/.profile.fn"), "M0 [0:1]");
  EXPECT_FALSE(std::filesystem::exists(folder / ".profile"));
}

TEST_F(Reproduce, TellsOfPicturesOfEarlierVersions) {
  make("--exposure 0.3s clip.tik a.pgm");
  std::string picture = file("a.pgm");
  const std::size_t seal = picture.find("\"file\":"), options = picture.find("\"options\":{");
  ASSERT_TRUE(seal < options && options != std::string::npos);
  const std::string no_effect = "\"unmapped\":\"zero\",\"shutter-error\":\"0.01\",\"mask-blend\":\"alpha\",";
  scratch_.write("b.pgm", std::string(picture).insert(options + 11, no_effect).erase(seal, 34));
  const ProgramResult told = make("reproduce b.pgm");
  expect_says(told.err, "note: an earlier nutik-cl made the picture");
  EXPECT_EQ(told.out.substr(told.out.find(" expose ")),
            " expose --exposure 0.3s --precision single clip.tik -o b.pgm\n");
  expect_refused(Words{"--exposure", "0.3s", "clip.tik", "b.pgm"}, 2,
                 "b.pgm is there already and is not replaced: an earlier version wrote it");
  scratch_.write("c.pgm", picture.erase(seal, 34));
  const std::string whole = file("c.pgm");
  make("--exposure 0.3s --skip-existing --overwrite clip.tik c.pgm");
  EXPECT_EQ(file("c.pgm"), whole);
}

TEST_F(Reproduce, KeepsTheNoiseOfAClip) {
  const std::string noise =
      "nutik noise 0\nwhite 255\ntransfer srgb\nchannel grey\nread 0.002\nshot 0.0001\n"
      "curve sensor\npoint 10 1.5 100\npoint 20.5 2 50\n";
  scratch_.write("camera.noise", noise);
  make({"-f", "40", "--noise", "camera.noise", "--exposure", "0.2s", "frames", "n.png"});
  expect_made_again("n.png");
  scratch_.write("camera.noise", "another");
  expect_says(make("reproduce n.png").err, "camera.noise was changed since; the noise values");
  EXPECT_EQ(file("n-again/camera.noise"), noise);
  expect_made_again("n.png");
  make("-f 40 --noise auto --exposure 0.2s frames m.png");
  expect_made_again("m.png");
}

// Each picture of a batch has what its line states and what the batch does.
TEST_F(Reproduce, MakesOnePictureOfABatch) {
  make("noise frames -o camera.noise");
  for (const std::string noise : {"auto", "camera.noise"}) {
    scratch_.write("list", "--exposure 0.2s a.png\n-k \"it's f.fn\" -m mask.pgm b.png\n");
    make({"batch", "-f", "40", "--noise", noise, "--sigmas", "1.5", "--block-samples", "16", "--transfer", "gamma:2",
          "list", "frames"});
    for (const char* picture : {"a.png", "b.png"}) {
      const std::string command = make({"reproduce", picture}).out;
      expect_says(command, {" --noise ", " --sigmas 1.5 "});
      expect_made_again(picture);
    }
  }
}

// What a picture says of where it was made: names of files, no folders.
TEST_F(Reproduce, KeepsFoldersToItself) {
  make({"--exposure", "33ms", (scratch_ / "clip.tik").string(), (scratch_ / "a.png").string()});
  const std::string folder = scratch_.folder().filename().string();
  EXPECT_EQ(file("a.png").find(folder), std::string::npos);
  make("--exposure 33ms clip.tik b.png");
  EXPECT_TRUE(file("a.png") == file("b.png"));
}

}  // namespace
}  // namespace nutik::test

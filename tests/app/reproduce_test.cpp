// Pictures carry how they were made, and can be made again from that.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/still_clip.hpp"

namespace nutik {
namespace {

class Reproduce : public test::AppTest {
 protected:
  void SetUp() override {
    test::write_still_clip(scratch_.folder(), 24, 40);
    run("-f 40 frames clip.tik");
    scratch_.write("it's f.fn",
                   "M0 [0:1], [50000000:0] # caf\xe9\nM9 [10000000:0], [60000000:2], [90000000:0]\n");
    std::string mask = "P2 24 24 255\n";
    for (int i = 0; i < 24 * 24; ++i) mask += i % 5 == 0 ? "9 " : "0 ";
    scratch_.write("mask.pgm", mask);
  }
  test::ProgramResult run(const test::Words& words) const { return make(words); }

  // Runs the command that reproduce prints, which names the program as it was run.
  void expect_same_bytes(const std::string& picture, const std::string& made_by = "expose") const {
    const std::string before = file(picture);
    ASSERT_FALSE(before.empty());
    const std::string command = run({"reproduce", picture}).out;
    ASSERT_NE(command.find(" " + made_by + " "), std::string::npos) << command;
    std::filesystem::remove(scratch_ / picture);
    scratch_.write("again.sh", command);
    const auto made = test::run_shell("sh again.sh", scratch_.folder());
    EXPECT_EQ(made.status, 0) << command << made.err;
    EXPECT_TRUE(file(picture) == before) << command;
  }
};

TEST_F(Reproduce, MakesPixelsSquareOrKeepsThemAsBefore) {
  make("-f 40 --pixel-aspect 2:1 frames wide.tik");
  make("--exposure 33ms wide.tik square.png");
  make("--exposure 33ms --keep-pixels wide.tik kept.png");
  ASSERT_NE(file("square.png"), file("kept.png"));
  for (const char* picture : {"square.png", "kept.png"}) expect_same_bytes(picture);
}

TEST_F(Reproduce, MakesTheSameBytes) {
  const std::vector<std::string> functions{"-k", "it's f.fn", "-m", "mask.pgm"};
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
      std::vector<std::string> all = words;
      all.insert(all.end(), {"-o", picture});
      run(all);
      expect_same_bytes(picture);
    }
  }
  run("--exposure 50ms --depth float clip.tik light.tif");
  expect_same_bytes("light.tif");
}

// Names in any encoding, and with what would number pictures.
TEST_F(Reproduce, KeepsNamesAsTheyAre) {
  for (const std::string name : {"caf\xe9.tik", "p%d.tik"}) {
    std::filesystem::copy(scratch_ / "clip.tik", scratch_ / name);
    run({"--start", "0s", "--exposure", "50ms", name, "a.png", "--overwrite"});
    expect_same_bytes("a.png");
  }
  const std::string out = run({"--start", "0s", "--exposure", "50ms", "p%d.tik"}).out;
  EXPECT_TRUE(out.starts_with("p_d-")) << out;
}

TEST_F(Reproduce, NamesTheProgramAsItWasRun) {
  run("--exposure 50ms clip.tik a.png");
  const std::filesystem::path program = NUTIK_TEST_PROGRAM;
  std::filesystem::create_directory(scratch_ / "my tools");
  std::filesystem::create_symlink(program, scratch_ / "my tools/nutik-cl");
  const auto found = test::run_shell(
      "PATH='" + program.parent_path().string() + "':$PATH; nutik-cl reproduce a.png", scratch_.folder());
  EXPECT_TRUE(found.out.starts_with("nutik-cl expose ")) << found.out << found.err;
  const auto quoted = test::run_shell("'my tools/nutik-cl' reproduce a.png", scratch_.folder());
  EXPECT_TRUE(quoted.out.starts_with("'my tools/nutik-cl' expose ")) << quoted.out << quoted.err;
  EXPECT_EQ(test::run_shell("'my tools/nutik-cl' reproduce a.png | sh", scratch_.folder()).status, 0);
}

TEST_F(Reproduce, MakesOnePictureOfASeries) {
  run({"-k", "it's f.fn", "-m", "mask.pgm", "--every", "1/7s", "--count", "3", "clip.tik", "s-%d.png"});
  expect_says(run("reproduce s-2.png").out, " --start 2/7s ");
  expect_same_bytes("s-2.png");
  run("-f 40 --exposure 20ms --every 10f --start 1f frames t-%d.png");
  expect_same_bytes("t-3.png");
}

// As plain intervals where they are such, else from functions that the pictures carry.
TEST_F(Reproduce, MakesOnePictureOfASweep) {
  const auto sweep = [&](test::Words words) {
    words.insert(words.begin(), "sweep");
    words.insert(words.end(), {"clip.tik", "sheet.png"});
    return run(words).err;
  };
  EXPECT_EQ(sweep({"--start", "1f", "--exposure", "3f", "--shift", "-1f..5f/3f", "--scale-gain",
                   "0.3..1/0.35", "--ev", "0.5", "--normalize", "integral", "--each", "box-%d.png"}),
            "");
  const std::string box = run("reproduce box-4.png").out;
  for (const char* part : {" --start 75ms ", " --exposure 75ms ", " --gain 0.9"})
    EXPECT_NE(box.find(part), std::string::npos) << box;
  EXPECT_EQ(sweep({"--exposure", "0.1s", "--shutter", "strobe:3", "--shift", "0..0.2s/0.1s", "--stretch",
                   "1..2/1", "--each", "strobe-%d.tif"}),
            "");
  sweep({"-k", "it's f.fn", "-m", "mask.pgm", "--start", "20ms", "--shift", "-60ms..0.1s/80ms", "--stretch",
         "0.7..2/1", "--each", "file-%d.pgm"});
  expect_says(run("reproduce file-5.pgm").err, "file-5.fn is not there; the functions");
  EXPECT_EQ(
      sweep({"--exposure", "0.1s", "--shutter", "hann", "--stretch", "0.5..2/0.5", "--each", "hann-%d.png"}),
      "");
  for (const char* picture : {"box-0.png", "box-4.png", "box-8.png", "strobe-2.tif", "strobe-4.tif",
                              "file-0.pgm", "file-3.pgm", "file-5.pgm", "hann-0.png", "hann-1.png"}) {
    expect_same_bytes(picture);
  }

  // expose refuses what lies outside the capture.
  expect_says(
      sweep({"--start", "0.9s", "--exposure", "0.1s", "--shift", "0..0.1s/0.1s", "--each", "no-%d.png"}),
      "warning: no-1.png: it carries no recipe: ");
  expect_same_bytes("no-0.png");
  EXPECT_EQ(test::run_here({"reproduce", "no-1.png"}, scratch_.folder()).status, 3);
}

// A sheet is made anew by the command that made it, with all that lies on it and how it lies.
TEST_F(Reproduce, MakesSheets) {
  run("contact --start 0.1s --every 1/7s --exposure 2f --columns 2 --width 300 --negative abs --transfer "
      "gamma:2 clip.tik contact.png");
  run({"contact", "-f", "40", "-a", "90", "--tolerance", "2", "frames", "-o", "whole clip.tif"});
  run({"sweep", "-k", "it's f.fn", "-m", "mask.pgm", "--shift", "-1f..3f/2f", "--scale-gain", "0.5..1/0.25",
       "--width", "500", "--precision", "fixed", "clip.tik", "sweep.jpg"});
  run("sweep --exposure 0.1s --shutter hann --stretch 0.5..2/0.5 --columns 1 --out-transfer linear "
      "--renderer reference --each one-%d.png clip.tik one.png");
  expect_same_bytes("contact.png", "contact");
  expect_same_bytes("whole clip.tif", "contact");
  expect_same_bytes("sweep.jpg", "sweep");
  expect_same_bytes("one.png", "sweep");
  expect_same_bytes("one-2.png");

  run("contact --no-recipe clip.tik silent.png");
  const auto none = test::run_here({"reproduce", "silent.png"}, scratch_.folder());
  EXPECT_EQ(none.status, 3);
  expect_says(none.err, "silent.png carries no recipe. Exposures, sheets and a video's stills do");
}

// Whatever a stranger's sheet says, what is printed makes a sheet or a picture.
TEST_F(Reproduce, RefusesCommandsThatLeaveNoRecipes) {
  run("contact clip.tik a.ppm");
  std::string sheet = file("a.ppm");
  const auto replace = [&](const std::string& what, const std::string& by) {
    const auto at = sheet.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    sheet.replace(at, what.size(), by);
    scratch_.write("a.ppm", sheet);
  };
  const auto refused = [&](const std::string& why) {
    const auto result = test::run_here({"reproduce", "a.ppm"}, scratch_.folder());
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
  };
  replace("\"contact\"", "\"recover\"");
  refused("its recipe is one of 'recover', which leaves none");
  replace("\"recover\"", "\"contact\"");
  replace("\"options\":{", "\"options\":{\"shift\":\"1f..2f/1f\"");
  refused("its recipe states '--shift 1f..2f/1f', which no recipe of nutik-cl");
}

TEST_F(Reproduce, LooksForTheFilesItNeeds) {
  run({"-k", "it's f.fn", "-m", "mask.pgm", "clip.tik", "a.png"});
  const std::string picture = file("a.png");
  std::filesystem::create_directory(scratch_ / "kept");
  std::filesystem::rename(scratch_ / "clip.tik", scratch_ / "kept/clip.tik");
  auto result = test::run_here({"reproduce", "a.png"}, scratch_.folder());
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.err,
            "warning: the capture clip.tik is not in the current folder; name its folder: nutik-cl reproduce "
            "PICTURE FOLDER\n");
  expect_says(run("reproduce a.png kept").out, " kept/clip.tik -o a.png");

  // Another capture of the same name is not taken for it.
  run("-f 41 frames clip.tik");
  expect_says(run("reproduce a.png kept").out, " kept/clip.tik ");
  result = test::run_here({"reproduce", "a.png"}, scratch_.folder());
  EXPECT_EQ(result.status, 3);
  expect_says(result.err, "clip.tik is not the capture that the picture was made from: its checksum differs");
  std::filesystem::rename(scratch_ / "kept/clip.tik", scratch_ / "clip.tik");

  scratch_.write("mask.pgm", "P2 24 24 255\n" + std::string(24 * 24 * 2, ' '));
  result = test::run_here({"reproduce", "a.png"}, scratch_.folder());
  EXPECT_EQ(result.status, 3);
  expect_says(result.err, "mask.pgm is not the mask that");
}

TEST_F(Reproduce, WritesFunctionsThatAreGoneOrChanged) {
  run({"-k", "it's f.fn", "-m", "mask.pgm", "clip.tik", "a.png"});
  const std::string functions = file("it's f.fn");
  scratch_.write("it's f.fn", "M0 [0:0]\n");
  auto result = run("reproduce a.png");
  EXPECT_EQ(
      result.err,
      "warning: it's f.fn was changed since; the functions that the picture was made with were written to "
      "a-again/it's f.fn\n");
  EXPECT_EQ(file("a-again/it's f.fn"), functions);
  expect_same_bytes("a.png");
  std::filesystem::remove(scratch_ / "it's f.fn");
  std::filesystem::remove(scratch_ / "a-again/it's f.fn");
  expect_says(run("reproduce a.png").err, "is not there; the functions");
  expect_same_bytes("a.png");
  scratch_.write("a-again/it's f.fn", "notes of mine");
  result = test::run_here({"reproduce", "a.png"}, scratch_.folder());
  EXPECT_EQ(result.status, 5);
  EXPECT_EQ(file("a-again/it's f.fn"), "notes of mine");
}

// A video's still is an exposure like another.
TEST_F(Reproduce, MakesAVideosStills) {
  run("video --out-fps 30000/1001 --from 1/7s --speed 0.3 --shutter hann --ev 1 --out-transfer linear "
      "clip.tik plain-%02d.png");
  for (const std::string name : {"plain-00.png", "plain-07.png"}) expect_same_bytes(name);
  run({"video", "-k", "it's f.fn", "-m", "mask.pgm", "--depth", "16", "--to", "0.5s", "clip.tik",
       "f-%d.tif"});
  for (const std::string name : {"f-0.tif", "f-3.tif"}) expect_same_bytes(name);
  run("video --no-recipe --to 0.2s clip.tik bare-%d.png");
  EXPECT_EQ(file("bare-0.png").find("nutik"), std::string::npos);
}

TEST_F(Reproduce, SaysWhereThereIsNoRecipe) {
  run("--exposure 33ms clip.tik private.png --no-recipe");
  EXPECT_EQ(file("private.png").find("nutik"), std::string::npos);
  EXPECT_EQ(file("private.png").find("clip.tik"), std::string::npos);
  auto result = test::run_here({"reproduce", "private.png"}, scratch_.folder());
  EXPECT_EQ(result.status, 3);
  expect_says(result.err, "private.png carries no recipe");
  run("activity clip.tik chart.png");
  result = test::run_here({"reproduce", "chart.png"}, scratch_.folder());
  EXPECT_EQ(result.status, 3);
  expect_says(result.err, "not backgrounds, charts, traces, masks");
  result = test::run_here({"reproduce", "private.png", "clip.tik"}, scratch_.folder());
  EXPECT_EQ(result.status, 2);
  expect_says(result.err, "clip.tik is no folder");
  EXPECT_EQ(test::run_here({"reproduce"}, scratch_.folder()).status, 2);
  EXPECT_EQ(test::run_here({"reproduce", "clip.tik"}, scratch_.folder()).status, 3);
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
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "pwned.sh"));
  }
  for (const char* name : {"../clip.tik", "/clip.tik", "a/b/clip.tik", "a/", "..", ""}) {
    expect_no_order(recipe(name, "f.fn", ""), "its recipe names '");
  }
  // What may be shown does not write to the terminal by itself.
  scratch_.write("sly.pgm", "P5\n# " + recipe("\\u001b[2Jclip.tik", "f.fn", "") + "\n1 1\n255\nx");
  const auto result = test::run_here({"reproduce", "sly.pgm"}, scratch_.folder());
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
}

// Who sends a picture may send a folder of links with it, and any text as its functions.
TEST_F(Reproduce, WritesOnlyWhatItReadsAndOnlyIntoItsOwnFolder) {
  const auto again = [&](const std::string& name, const std::string& text) {
    scratch_.write("sent.pgm",
                   R"(P5
# {"nutik-cl":"0","capture":{"name":"clip.tik","checksum":"x"},"functions":{"name":")" +
                       name + R"(","text":")" + text +
                       R"("},"options":{},"renderer":"opencl","precision":"double"}
1 1
255
x)");
    return test::run_here({"reproduce", "sent.pgm"}, scratch_.folder());
  };
  const std::filesystem::path elsewhere = scratch_ / "elsewhere", folder = scratch_ / "sent-again";
  std::filesystem::create_directory(elsewhere);

  auto result = again("cron", "* * * * * touch pwned");
  EXPECT_EQ(result.status, 3) << result.err;
  expect_says(result.err, "cron in the recipe of sent.pgm has mistakes");
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder));

  std::filesystem::create_directory_symlink("elsewhere", folder);
  result = again("f.fn", "M0 [0:1]");
  EXPECT_EQ(result.status, 5) << result.err;
  expect_says(result.err, "sent-again is a link, or no folder of yours");
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere));

  std::filesystem::remove(folder);
  std::filesystem::create_directory(folder);
  for (const char* target : {"../elsewhere/f.fn", "../it's f.fn"}) {
    std::filesystem::create_symlink(target, folder / "f.fn");
    result = again("f.fn", "M0 [0:1]");
    EXPECT_EQ(result.status, 5) << result.err;
    expect_says(result.err, "sent-again/f.fn exists and is another file");
    std::filesystem::remove(folder / "f.fn");
  }
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere));

  result = again(std::string(300, 'f'), "M0 [0:1]");  // longer than a file system takes
  EXPECT_EQ(result.status, 5) << result.err;
  expect_says(result.err, "cannot be created: File name too long");

  result = again(".profile", "M0 [0:1]");
  expect_says(result.out, " -k sent-again/.profile.fn ");
  EXPECT_EQ(file("sent-again/.profile.fn"), "M0 [0:1]");
  EXPECT_FALSE(std::filesystem::exists(folder / ".profile"));
}

TEST_F(Reproduce, KeepsTheNoiseOfAClip) {
  const std::string noise =
      "nutik noise 0\nwhite 255\ntransfer srgb\nchannel grey\nread 0.002\nshot 0.0001\n"
      "curve sensor\npoint 10 1.5 100\npoint 20.5 2 50\n";
  scratch_.write("camera.noise", noise);
  const auto exposed = test::run_here(
      {"-f", "40", "--noise", "camera.noise", "--exposure", "0.2s", "frames", "n.png"}, scratch_.folder());
  ASSERT_EQ(exposed.status, 0) << exposed.err;
  expect_same_bytes("n.png");
  scratch_.write("camera.noise", "another");
  expect_says(run("reproduce n.png").err, "camera.noise was changed since; the noise values");
  EXPECT_EQ(file("n-again/camera.noise"), noise);
  expect_same_bytes("n.png");
  run("-f 40 --noise auto --exposure 0.2s frames m.png");
  expect_same_bytes("m.png");
}

// Each picture of a batch has what its line states and what the batch does.
TEST_F(Reproduce, MakesOnePictureOfABatch) {
  run("noise frames -o camera.noise");
  for (const std::string noise : {"auto", "camera.noise"}) {
    scratch_.write("list", "--exposure 0.2s a.png\n-k \"it's f.fn\" -m mask.pgm b.png\n");
    run({"batch", "-f", "40", "--noise", noise, "--sigmas", "1.5", "--block-samples", "16", "--transfer",
         "gamma:2", "list", "frames"});
    for (const char* picture : {"a.png", "b.png"}) {
      const std::string command = run({"reproduce", picture}).out;
      expect_says(command, {" --noise ", " --sigmas 1.5 "});
      expect_same_bytes(picture);
    }
  }
}

// What a picture says of where it was made: names of files, no folders.
TEST_F(Reproduce, KeepsFoldersToItself) {
  run({"--exposure", "33ms", (scratch_ / "clip.tik").string(), (scratch_ / "a.png").string()});
  const std::string folder = scratch_.folder().filename().string();
  EXPECT_EQ(file("a.png").find(folder), std::string::npos);
  run("--exposure 33ms clip.tik b.png");
  EXPECT_TRUE(file("a.png") == file("b.png"));
}

}  // namespace
}  // namespace nutik

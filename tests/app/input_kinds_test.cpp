// What a file is read as is told by its bytes, whichever way it comes in; what is not read is refused by its kind.
#include <string>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

using namespace std::string_literals;

class InputKinds : public AppTest {
 protected:
  void SetUp() override {
    for (int i = 0; i < 3; ++i) {
      scratch_.write("frame" + std::to_string(i) + ".pgm", "P5 4 3 255\n" + std::string(12, static_cast<char>(60 * i)));
    }
    make("encode -q -f 10 frame%d.pgm clip.tik");
  }

  void expect_shell_refused(const std::string& command, std::string_view part) const {
    expect_says(shell(command, 3).err, part);
  }

  const std::string program_ = NUTIK_TEST_PROGRAM;
};

TEST_F(InputKinds, ACaptureIsOneThroughAPipe) {
  const std::string wanted = " expose -q --start 1f --exposure 1f --out-transfer source ";
  for (const std::string& command :
       {program_ + wanted + "clip.tik file.pgm", program_ + wanted + "- file.pgm < clip.tik",
        "cat clip.tik | " + program_ + wanted + "- file.pgm"}) {
    shell("rm -f file.pgm; " + command);
    EXPECT_TRUE(file("file.pgm").ends_with(std::string(12, 60))) << command;
  }
  expect_says(shell("cat clip.tik | " + program_ + " info -").out, "3 in 1 block");
  expect_shell_refused("cat clip.tik | " + program_ + " encode -f 10 - x.tik", "standard input is a capture (.tik)");
  shell("cat clip.tik | " + program_ + wanted + "-f 10 - x.pgm", 2);
  expect_shell_refused("mkfifo pipe; cat clip.tik > pipe & " + program_ + wanted +
                           "pipe x.pgm; status=$?; kill $!; exit $status",
                       "pipe is no regular file");
  expect_shell_refused(program_ + " study pipe x.pgm", "save the stream to a file first");
}

TEST_F(InputKinds, ACaptureIsNoPicture) {
  shell("mkdir frames && cp clip.tik frames/1.pgm && cp clip.tik frames/2.pgm");
  for (const char* clip : {"frames", "'frames/*.pgm'", "frames/%d.pgm"}) {
    expect_shell_refused(program_ + " encode -f 10 " + clip + " x.tik", "frames/1.pgm is a capture (.tik)");
  }
  const std::string exposure = program_ + " expose --start 0f --exposure 1f clip.tik x.png ";
  expect_shell_refused(exposure + "--delay frames/1.pgm:0s..0.1s", "frames/1.pgm is a capture (.tik)");
  scratch_.write("one.fn", "M0 [0:1], [100000000:1]\n");
  expect_shell_refused(program_ + " -k one.fn -m frames/1.pgm clip.tik x.png", "it is a capture (.tik)");
}

TEST_F(InputKinds, WhatIsNotReadIsNamed) {
  const auto bytes = [](const std::string& start) { return start + std::string(64, '\0'); };
  const auto expect_named = [&](const std::string& name, const std::string& content, std::string_view part) {
    scratch_.write(name, content);
    const std::string named = name + " is " + std::string(part);
    expect_refused({"encode", "-f", "10", name, "x.tik"}, 3, named);
    expect_shell_refused("cp " + name + " one." + name.substr(name.find('.') + 1) + "; mkdir -p f; mv " + name +
                             " f; " + program_ + " encode -f 10 'f/*' x.tik; status=$?; rm -r f; exit $status",
                         part);
  };
  expect_named("a.bmp", bytes("BM\1\2\3\4"), "a BMP picture, which is not read; make PNGs");
  expect_named("a.png", bytes("BM\1\2\3\4"), "a BMP picture");
  expect_named("a.dpx", bytes("SDPX"), "a DPX picture");
  expect_named("a.webp", bytes("RIFF\1\2\3\4WEBP"), "a WebP picture");
  expect_named("a.jp2", bytes("\0\0\0\x0CjP  "s), "a JPEG 2000 picture");
  expect_named("a.jxl", bytes("\xFF\x0A"), "a JPEG XL picture");
  expect_named("a.heic", bytes("\0\0\0\x1C" "ftypheic"s), "a HEIC picture");
  expect_named("a.nef", bytes("MM\0*"s), "a Nikon NEF picture of a sensor, which is not read; make DNGs");
  expect_named("a.cr2", bytes("II*\0\x10\0\0\0CR"s), "a Canon CR2 picture");
  expect_named("a.es", bytes("Event Stream"), "an Event Stream recording");
  expect_named("a.bag", bytes("#ROSBAG V2.0\n"), "a ROS bag");
  expect_named("a.seq", bytes("\xED\xFE\0\0N\0o\0r\0p\0i\0x\0"s), "a NorPix sequence");
  expect_named("a.adder", bytes("addec"), "a compressed ADΔER file, which is not read; save it uncompressed");
  expect_named("a.hdf5", bytes("\x89HDF\r\n\x1a\n"), "an HDF5 file, which is not read; convert events to DAT");
  expect_named("a.nii", bytes("\x5C\1\0\0"s), "a NIfTI volume, which is not read; save it as a TIFF stack");
  expect_named("a.aedat", bytes("#!AER-DAT4.0\r\n"), "an AEDAT file");
  scratch_.write("events.txt", "0.003811 96 133 0\n0.003820 96 133 1\n");
  expect_refused("encode -f 10 events.txt x.tik", 3, "events.txt is a text, and no clip");
  scratch_.write("events.csv", "t,x,y,on\n0,3,4,1\n");
  expect_refused("encode -f 10 events.csv x.tik", 3, "4 columns, and a table of stills has three");
}

TEST_F(InputKinds, AFolderOfWhatIsNotReadNamesIt) {
  shell("mkdir frames && printf 'BM\\1\\2\\3\\4\\0\\0\\0\\0' > frames/1.bmp");
  expect_refused("encode -f 10 frames x.tik", 3, "frames/1.bmp is a BMP picture");
}

}  // namespace
}  // namespace nutik::test

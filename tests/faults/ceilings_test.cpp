// Tiny files that state a huge size are refused before memory is taken for it; large ones are not held whole.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "capture/format.hpp"
#include "support/hostile.hpp"
#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"

namespace nutik::test {
namespace {

struct Ceilings : ProgramTest {
  // All programs that were run, in MB; the largest counts.
  static long peak_mb() {
    struct rusage usage {};
    getrusage(RUSAGE_CHILDREN, &usage);
    return usage.ru_maxrss / 1024;
  }
  // One program that ends well, whatever ran before; 255 is as much or more, or another end.
  long peak_mb_of(const std::vector<std::string>& words) const {
    const pid_t child = fork();
    if (child == 0) _exit(run(words).status == 0 ? static_cast<int>(std::min(peak_mb(), 255L)) : 255);
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : 255;
  }
  // A program that does nothing takes some 60 MB for its libraries, and small pictures may be up to 64 MB.
  static constexpr long kMaxMb = 250;

  void expect_cheaply_refused(const std::vector<std::string>& words, std::string_view part) const {
    expect_refused(words, 3, part);
    EXPECT_LT(peak_mb(), kMaxMb) << words.back();
  }
};

TEST_F(Ceilings, OfTiffs) {
  for (const int compression : {1, 5, 8, 32773}) {
    scratch_.write("t.tif", tiny_tiff(65'536, 65'536, static_cast<std::uint16_t>(compression)));
    expect_cheaply_refused({"encode", "-f", "10", "t.tif", "c.tik"},
                           "t.tif cannot be read: it states 65536 x 65536 pixels, which its ");
  }
}

TEST_F(Ceilings, OfPngs) {
  scratch_.write("p.png", black_png(30'000, 30'000, 10));
  expect_cheaply_refused({"encode", "-f", "10", "p.png", "c.tik"},
                         "p.png cannot be read: it states 30000 x 30000 pixels");
  expect_cheaply_refused({"mask", "--threshold", "p.png", "1..255", "-o", "m.pgm"},
                         "p.png cannot be read: it states 30000 x 30000 pixels");
  scratch_.write("q.png", black_png(100'000, 100'000, 2'000));
  scratch_.write("big.png", read_file(scratch_ / "q.png") + std::string(2 << 20, ' '));
  expect_cheaply_refused({"encode", "-f", "10", "big.png", "c.tik"}, "big.png cannot be read: it has 100000 x ");
}

// A whole PNG of 16000 x 16000 black pixels has 250 kB.
TEST_F(Ceilings, OfMasksAreTheCapturesSize) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  scratch_.write("f.fn", "M0 [0:1], [1000:0]\n");
  scratch_.write("m.png", black_png(16'000, 16'000, 16'000));
  expect_cheaply_refused({"expose", "--renderer", "reference", "-k", "f.fn", "-m", "m.png", "c.tik", "p.png"},
                         "the mask is 16000 x 16000 pixels, the capture 8 x 8");
}

TEST_F(Ceilings, OfCaptures) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::zstd, 0});
  const std::string file = read_file(scratch_ / "c.tik");
  for (const char* size : {"65536 65536", "4294967295 4294967295", "4294967295 1", "900 1"}) {
    std::string damaged = file;
    damaged.replace(damaged.find("\n8 8\n") + 1, 3, size);
    scratch_.write("d.tik", damaged);
    for (const char* command : {"info", "recover", "activity"}) {
      std::vector<std::string> words{command, "d.tik"};
      if (words[0] != "info") words.emplace_back(words[0] == "recover" ? "r.tik" : "a.png");
      expect_cheaply_refused(words, "d.tik: it was cut off or is damaged: it states ");
    }
  }
}

// What is no list may have no end, and no line either.
TEST_F(Ceilings, OfLists) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  expect_cheaply_refused({"batch", "/dev/zero", "c.tik"}, "/dev/zero is no list: it is no text");
  scratch_.write("long.txt", std::string((std::size_t{16} << 20) + 1, '#'));
  expect_cheaply_refused({"batch", "long.txt", "c.tik"}, "long.txt is longer than 16 MiB; make several of it");
  expect_refused({"batch", ".", "c.tik"}, 3, ". is a folder, not a list");
}

// What comes through a pipe may have no end, and a file may be long without taking any room.
TEST_F(Ceilings, OfTexts) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  const auto piped =
      run_shell(format("(yes '# and so on' | '{}' --renderer reference -k - c.tik p.png)", NUTIK_TEST_PROGRAM),
                scratch_.folder());
  EXPECT_EQ(piped.status, 3);
  expect_says(piped.err, "standard input is longer than 256 MiB; no text that a person writes is");
  EXPECT_LT(peak_mb(), 60 + 2 * 256 + 64);  // where it grows, old and new room are there
  for (const char* name : {"long.fn", "long.noise", "long.csv", "long.cih", "long.mraw", "long.path"}) {
    std::filesystem::resize_file(scratch_.write(name, ""), std::uintmax_t{20} << 30);
  }
  const auto expect_long = [&](const std::vector<std::string>& words, const std::string& name) {
    expect_refused(words, 3, name + " is longer than 256 MiB; no text that a person writes is");
  };
  expect_long({"--renderer", "reference", "-k", "long.fn", "c.tik", "p.png"}, "long.fn");
  expect_long(
      {"--renderer", "reference", "--noise", "long.noise", "--start", "0s", "--exposure", "1s", "c.tik", "p.png"},
      "long.noise");
  expect_long({"encode", "long.csv", "d.tik"}, "long.csv");
  expect_long({"encode", "long.cih", "d.tik"}, "long.cih");
  expect_long({"encode", "-f", "10", "--align-along", "long.path", "long.csv", "d.tik"}, "long.path");
}

// Blocks of 16 MB are copied one at a time, from captures of 210 MB.
TEST_F(Ceilings, OfJoining) {
  scratch_.write("black.raw", "");
  std::filesystem::resize_file(scratch_ / "black.raw", 512 * 512 * 800);
  ASSERT_EQ(run({"encode", "-q", "-f", "100", "--codec", "none", "--tiles", "dense", "--raw", "512x512:gray",
                 "black.raw", "c.tik"})
                .status,
            0);
  EXPECT_LT(peak_mb_of({"join", "-q", "c.tik", "c.tik", "-o", "j.tik"}), 150);
  EXPECT_GT(std::filesystem::file_size(scratch_ / "j.tik"), 419'000'000U);
}

}  // namespace
}  // namespace nutik::test

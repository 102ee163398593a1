// Memory is bounded by --memory, however long a capture is.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/program.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::Scratch;

// Runs the program and returns the most memory that it held, in bytes; 0 where it failed.
std::uint64_t peak_bytes(const Scratch& scratch, std::vector<std::string> words) {
  words.insert(words.begin(), NUTIK_TEST_PROGRAM);
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (::chdir(scratch.folder().c_str()) == 0) ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  if (::wait4(child, &status, 0, &usage) != child || status != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// Noise, so that nothing can be left out: 230 kB a picture.
void write_raw_video(const Scratch& scratch, const std::string& name, int pictures) {
  test::Random random(5);
  std::string noise(std::size_t{640} * 360 * 40, '\0');
  for (char& byte : noise) byte = static_cast<char>(random.whole(0, 255));
  std::string video;
  const std::size_t bytes = std::size_t{640} * 360 * static_cast<std::size_t>(pictures);
  while (video.size() < bytes) video.append(noise, 0, bytes - video.size());
  scratch.write(name, video);
}

TEST(Memory, DoesNotGrowWithTheCapture) {
  constexpr std::uint64_t kBudget = 24'000'000;
  // Contexts of codecs, for each thread, and what the allocator keeps of what was freed. Half a budget: who held a
  // budget twice would be found.
  constexpr std::uint64_t kOverhead = kBudget / 2;
  const Scratch scratch;
  write_raw_video(scratch, "tiny.gray", 2);     // what is held besides: program, libraries, device
  write_raw_video(scratch, "short.gray", 120);  // 28 MB: more than the budget already
  write_raw_video(scratch, "long.gray", 720);   // 166 MB
  const std::vector<std::string> options{"-q", "--memory", "24MB", "-f", "240", "--raw", "640x360:gray"};
  const auto peak = [&](std::vector<std::string> words) {
    words.insert(words.begin(), options.begin(), options.begin() + 3);
    return peak_bytes(scratch, words);
  };
  const auto peak_of_clip = [&](std::vector<std::string> words) {
    words.insert(words.begin(), options.begin(), options.end());
    return peak_bytes(scratch, words);
  };
  struct Pair {
    const char* what;
    std::uint64_t of_tiny, of_short, of_long;
  };
  const Pair pairs[] = {
      {"encoding", peak_of_clip({"tiny.gray", "tiny.tik"}), peak_of_clip({"short.gray", "short.tik"}),
       peak_of_clip({"long.gray", "long.tik"})},
      {"exposing a clip", peak_of_clip({"--start", "0s", "--exposure", "2f", "tiny.gray", "e.png"}),
       peak_of_clip({"--start", "0s", "--exposure", "0.4s", "short.gray", "a.png"}),
       peak_of_clip({"--start", "0s", "--exposure", "2.9s", "long.gray", "b.png"})},
      {"exposing a capture", peak({"--start", "0s", "--exposure", "2f", "tiny.tik", "f.png"}),
       peak({"--start", "0s", "--exposure", "0.4s", "short.tik", "c.png"}),
       peak({"--start", "0s", "--exposure", "2.9s", "long.tik", "d.png"})},
  };
  for (const Pair& pair : pairs) {
    ASSERT_GT(pair.of_tiny, 0u) << pair.what;
    ASSERT_GT(pair.of_short, 0u) << pair.what;
    ASSERT_GT(pair.of_long, 0u) << pair.what;
    // Both hold all that they may; the longer one may not hold another budget, a seventh of its length.
    EXPECT_LT(pair.of_long, pair.of_short + kBudget) << pair.what;
    // What a clip of two pictures takes is no part of the budget.
    EXPECT_LT(pair.of_long, pair.of_tiny + kBudget + kOverhead) << pair.what;
    std::printf("%s: %.0f MB of two pictures, %.0f MB, six times as long: %.0f MB\n", pair.what,
                static_cast<double>(pair.of_tiny) * 1e-6, static_cast<double>(pair.of_short) * 1e-6,
                static_cast<double>(pair.of_long) * 1e-6);
  }
}

TEST(Memory, SaysWhatIsTooLittle) {
  const Scratch scratch;
  write_raw_video(scratch, "clip.gray", 40);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"-f", "240", "--raw", "640x360:gray", "clip.gray", "clip.tik"};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_program(words, scratch.folder());
  };
  const auto small = run({"--memory", "1MB"});
  EXPECT_EQ(small.status, 2);
  EXPECT_NE(
      small.err.find("1 MB of memory are too little for pictures of 230 kB, of which 8 are held; allow more: "
                     "--memory 2MB"),
      std::string::npos)
      << small.err;
  EXPECT_EQ(run({"--memory", "2MB"}).status, 0);
  const auto blocks = run({"--memory", "20MB", "--block-samples", "30"});
  EXPECT_EQ(blocks.status, 2);
  EXPECT_NE(blocks.err.find("(--block-samples 14)"), std::string::npos) << blocks.err;
  EXPECT_EQ(run({"--memory", "20MB", "--block-samples", "14"}).status, 0);
  for (const char* size : {"20000000", "20 mb", "20000K", "20mIb", "1g"}) {
    EXPECT_EQ(run({"--memory", size}).status, 0) << size;
  }
  for (const char* size : {"much", "0", "-3MB", "1.5GB", "2XB", "5i", "20EB", "1 0MB", "7kMB"}) {
    const auto senseless = run({"--memory", size});
    EXPECT_EQ(senseless.status, 2) << size;
    EXPECT_NE(senseless.err.find(std::string("--memory '") + size + "' is no size"), std::string::npos)
        << senseless.err;
  }
}

}  // namespace
}  // namespace nutik

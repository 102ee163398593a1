// Every command keeps to --memory, and says the least that it works with.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <regex>
#include <thread>

#include "capture/format.hpp"
#include "capture/memory_needs.hpp"
#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

struct Measured {
  int status = -1;
  std::uint64_t peak_bytes = 0;  // of anonymous memory
  std::string err;
};

// Runs the program and looks at its memory all the time. Pages of mapped files do not count: the system takes them
// back when it needs them.
Measured run(const Scratch& scratch, std::vector<std::string> words) {
  words.insert(words.begin(), NUTIK_TEST_PROGRAM);
  const std::string err = (scratch / "err").string();
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int out = ::open("/dev/null", O_WRONLY),
              to = ::open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    if (::dup2(out, 1) == 1 && ::dup2(to, 2) == 2 && ::chdir(scratch.folder().c_str()) == 0) {
      ::execv(arguments[0], arguments.data());
    }
    ::_exit(127);
  }
  Measured result;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    std::ifstream proc(format("/proc/{}/status", child));
    // Until the program is loaded it is this process's memory.
    std::string line;
    if (!std::getline(proc, line) || line != "Name:\tnutik-cl") continue;
    while (std::getline(proc, line)) {
      if (!line.starts_with("RssAnon:")) continue;
      result.peak_bytes = std::max<std::uint64_t>(result.peak_bytes, std::stoull(line.substr(8)) * 1024);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.err = read_file(err);
  return result;
}

// Noise, so that nothing can be left out.
void write_raw_video(const Scratch& scratch, const std::string& name, std::size_t pixels,
                     std::size_t pictures) {
  Random random(5);
  std::string noise(pixels * 8, '\0');
  for (char& byte : noise) byte = static_cast<char>(random.whole(0, 255));
  std::string video;
  while (video.size() < pixels * pictures) video.append(noise, 0, pixels * pictures - video.size());
  scratch.write(name, video);
}

// A still scene of all greys, with noise of a few codes.
void write_still_video(const Scratch& scratch, const std::string& name, std::size_t pixels,
                       std::size_t pictures) {
  Random random(6);
  // One after the other, again and again, and none twice within the 16 that noise is measured on at a time.
  std::vector<std::string> noisy(17, std::string(pixels, '\0'));
  for (std::string& picture : noisy) {
    for (std::size_t i = 0; i < pixels; ++i) {
      picture[i] = static_cast<char>(30 + i % 180 + static_cast<std::size_t>(random.whole(0, 6)));
    }
  }
  std::string video;
  for (std::size_t k = 0; k < pictures; ++k) video += noisy[k % noisy.size()];
  scratch.write(name, video);
}

// What the budget does not count: what the allocator keeps of freed pieces (2 MiB in the heap of each of some five
// threads that work at a time), and that large buffers end with a page of 2 MiB.
constexpr std::uint64_t kUncounted = 14 << 20;

// CLIP, STILL and CAPTURE have 1280 x 720 and 16 x 16 pixels.
struct Command {
  const char* what;
  std::vector<std::string> words;
};

const Command kCommands[] = {
    {"encode", {"encode", "CLIP", "o.tik"}},
    {"encode, noise of the clip", {"encode", "--noise", "auto", "STILL", "o.tik"}},
    {"encode, noise of a file", {"encode", "--noise", "camera.noise", "STILL", "o.tik"}},
    {"expose", {"--start", "0s", "--exposure", "0.25s", "CAPTURE", "o.png"}},
    {"expose, double", {"--precision", "double", "--start", "0s", "--exposure", "0.25s", "CAPTURE", "o.png"}},
    {"expose, light", {"--start", "0s", "--exposure", "0.25s", "CAPTURE", "o.pfm"}},
    {"expose, reference",
     {"--renderer", "reference", "--start", "0s", "--exposure", "5f", "CAPTURE", "o.png"}},
    {"expose of a clip", {"--start", "0s", "--exposure", "0.25s", "CLIP", "o.png"}},
    {"series", {"--start", "0s", "--exposure", "10f", "--every", "20f", "CAPTURE", "o-%02d.png"}},
    {"series of a clip", {"--start", "0s", "--exposure", "10f", "--every", "20f", "CLIP", "o-%02d.png"}},
    {"batch", {"batch", "list.txt", "CAPTURE"}},
    {"sweep", {"sweep", "--start", "0s", "--exposure", "10f", "--shift", "0f..40f/20f", "CAPTURE", "o.png"}},
    {"video", {"video", "--out-fps", "24", "CAPTURE", "o.mp4"}},
    {"contact", {"contact", "CAPTURE", "o.png"}},
    {"trace", {"trace", "--pixel", "3,3", "--start", "0s", "--exposure", "10f", "CAPTURE"}},
    {"validate", {"validate", "--start", "0s", "--exposure", "5f", "--runs", "1", "CAPTURE"}},
    {"mask", {"mask", "--moving", "CAPTURE", "o.pgm"}},
    {"activity", {"activity", "CAPTURE", "o.png"}},
    {"check", {"check", "CAPTURE"}},
    {"noise", {"noise", "STILL", "-o", "o.noise"}},
    {"solve", {"solve", "-k", "named.fn", "--wish", "all = 0.3", "CAPTURE", "o.fn"}},
    {"solve, plate", {"solve", "-k", "named.fn", "--wish", "0,0,16,16 gone", "CAPTURE", "o.fn"}},
};

class MemoryOfCommands : public testing::TestWithParam<Command> {
 protected:
  // Once for all: the clips are large.
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<Scratch>();
    write_raw_video(*scratch_, "tiny.gray", 16 * 16, 70);
    write_raw_video(*scratch_, "large.gray", 1280 * 720, 70);
    scratch_->write("list.txt", "--start 0s --exposure 10f b1.png\n--start 20f --exposure 10f b2.png\n");
    scratch_->write("named.fn", "M0 [0:a], [100000000:a], [100000001:0]");
    scratch_->write("camera.noise",
                    "nutik noise 0\nwhite 255\ntransfer srgb\nchannel grey\nread 0.002\nshot 0.0001\n"
                    "curve sensor\npoint 10 1.5 100\npoint 20.5 2 50\n");
    for (const bool is_tiny : {true, false}) {
      write_still_video(*scratch_, is_tiny ? "tiny-still.gray" : "large-still.gray",
                        is_tiny ? 16 * 16 : 1280 * 720, 70);
      ASSERT_EQ(run(*scratch_, words_of({{}, {"encode", "CLIP", "CAPTURE"}}, is_tiny)).status, 0);
    }
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  static std::vector<std::string> words_of(const Command& command, bool is_tiny,
                                           const std::string& memory = {}) {
    std::vector<std::string> words;
    bool reads_clip = false;
    for (const std::string& word : command.words) {
      reads_clip |= word == "CLIP" || word == "STILL";
      words.push_back(word == "CLIP"      ? is_tiny ? "tiny.gray" : "large.gray"
                      : word == "STILL"   ? is_tiny ? "tiny-still.gray" : "large-still.gray"
                      : word == "CAPTURE" ? is_tiny ? "tiny.tik" : "large.tik"
                                          : word);
    }
    words.emplace_back("-q");
    if (words.front() != "validate" && words.front() != "check") words.emplace_back("--overwrite");
    if (reads_clip) {
      const bool is_timed = command.words.front() != "noise";
      if (is_timed) words.insert(words.end(), {"-f", "240"});
      words.emplace_back("--raw");
      words.emplace_back(is_tiny ? "16x16:gray" : "1280x720:gray");
    }
    if (!memory.empty()) words.insert(words.end(), {"--memory", memory});
    return words;
  }

  static inline std::unique_ptr<Scratch> scratch_;
};

// The baseline is the same command on 16 x 16 pixels. What is too little is refused with the least that does, which
// does; and whatever is allowed is kept to.
TEST_P(MemoryOfCommands, KeepsToIt) {
  const Command& command = GetParam();
  ASSERT_EQ(run(*scratch_, words_of(command, true)).status, 0);  // builds kernels
  const Measured baseline = run(*scratch_, words_of(command, true));
  ASSERT_EQ(baseline.status, 0) << baseline.err;
  const Measured refused = run(*scratch_, words_of(command, false, "1MB"));
  EXPECT_NE(refused.status, 0);
  expect_says(refused.err, "1 MB of memory is too little; at least ");
  const std::regex min_text("allow more: --memory ([0-9]+)MB");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(refused.err, found, min_text)) << refused.err;
  const std::uint64_t least = std::stoull(found[1].str());
  for (const std::uint64_t megabytes : {least, 2 * least}) {
    const Measured allowed = run(*scratch_, words_of(command, false, format("{}MB", megabytes)));
    EXPECT_EQ(allowed.status, 0) << megabytes << " MB: " << allowed.err;
    EXPECT_LE(allowed.peak_bytes, baseline.peak_bytes + megabytes * 1'000'000 + kUncounted)
        << megabytes << " MB";
    std::printf("%s: %llu MB allowed, %.1f MB above a baseline of %.1f MB\n", command.what,
                static_cast<unsigned long long>(megabytes),
                (static_cast<double>(allowed.peak_bytes) - static_cast<double>(baseline.peak_bytes)) * 1e-6,
                static_cast<double>(baseline.peak_bytes) * 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MemoryOfCommands, testing::ValuesIn(kCommands), [](const auto& tested) {
  std::string name;
  for (const char* c = tested.param.what; *c != '\0'; ++c) {
    if (std::isalpha(static_cast<unsigned char>(*c)) != 0) name += *c;
  }
  return name;
});

// 256 mask values and 65,536 delays: how many pairs of them occur is known before anything is held for each that could.
TEST(Memory, OfDelaysAndMaskValuesIsAskedForFirst) {
  constexpr int kSide = 256;
  const Scratch scratch;
  write_raw_video(scratch, "clip.gray", kSide * kSide, 4);
  std::string mask = "P5 256 256 255\n", delays = "P5 256 256 65535\n", functions;
  for (int y = 0; y < kSide; ++y) {
    functions += format("M{} [0:1], [10000000:1], [10000001:0]\n", y);
    for (int x = 0; x < kSide; ++x) {
      mask += static_cast<char>(y);
      delays += {static_cast<char>(y), static_cast<char>(x)};
    }
  }
  scratch.write("mask.pgm", mask);
  scratch.write("delays.pgm", delays);
  scratch.write("f.fn", functions);
  const auto exposing = [](const std::string& delay) {
    return std::vector<std::string>{"-f",   "100", "--raw",    "256x256:gray", "--memory",  "8MB",  "-k", "f.fn",
                                    "-m",   "mask.pgm", "--delay", delay,  "clip.gray", "o.pfm", "-q", "--overwrite"};
  };
  ASSERT_EQ(run(scratch, exposing("rows:1ms")).status, 0);  // builds kernels
  const Measured few = run(scratch, exposing("rows:1ms")), many = run(scratch, exposing("delays.pgm:0s..30ms"));
  EXPECT_EQ(few.status, 0) << few.err;
  EXPECT_EQ(many.status, 2) << many.err;
  expect_says(many.err, "gain tables of a block 204 MB");
  EXPECT_LE(many.peak_bytes, few.peak_bytes + 16'000'000);
  std::printf("%.1f MB with 65,536 delays, %.1f MB with 256\n", static_cast<double>(many.peak_bytes) * 1e-6,
              static_cast<double>(few.peak_bytes) * 1e-6);
}

TEST(Memory, SaysWhatIsTooLittle) {
  const Scratch scratch;
  write_raw_video(scratch, "clip.gray", 640 * 360, 40);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"-f", "240", "--raw", "640x360:gray", "--overwrite", "clip.gray", "clip.tik"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, scratch.folder());
  };
  const auto small = run({"--memory", "1MB"});
  EXPECT_EQ(small.status, 2);
  expect_says(small.err, "1 MB of memory is too little; at least 10.23 MB is needed: packing them 8.39 MB, ");
  expect_says(small.err, "; allow more: --memory 11MB");
  EXPECT_EQ(run({"--memory", "11MB"}).status, 0);
  const MemoryTooLittle huge(12'640'000'000, {{"codes", 49'930'000'000'000}});
  EXPECT_STREQ(huge.what(), "12.64 GB of memory is too little; at least 49930 GB is needed: codes 49930 GB");
  expect_says(huge.advice(), "encode a clip before it is exposed");
  EXPECT_EQ(huge.advice().find("`memory"), std::string::npos);
  const auto blocks = run({"--memory", "20MB", "--block-samples", "30"});
  EXPECT_EQ(blocks.status, 2);
  expect_says(blocks.err, "(--block-samples 7)");
  EXPECT_EQ(run({"--memory", "20MB", "--block-samples", "7"}).status, 0);
  for (const char* size : {"20000000", "20 mb", "20000K", "20mIb", "1g", "0.5GB", "2e9"}) {
    EXPECT_EQ(run({"--memory", size}).status, 0) << size;
  }
  for (const char* size : {"much", "0", "-3MB", "inf", "2XB", "5i", "20EB", "1 0MB", "7kMB"}) {
    const auto senseless = run({"--memory", size});
    EXPECT_EQ(senseless.status, 2) << size;
    expect_says(senseless.err, std::string("--memory '") + size + "' is no size");
  }
}

}  // namespace
}  // namespace nutik::test

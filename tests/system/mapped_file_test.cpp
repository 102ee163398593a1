// Files that are lost while they are mapped: the process lives, and makes nothing of them.
#include "system/mapped_file.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <thread>

#include "capture/error.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "system/output_file.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBytes = 1 << 20;

std::uint64_t sum_of(std::span<const std::byte> bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0}, [](std::uint64_t sum, std::byte byte) {
    return sum + static_cast<std::uint64_t>(byte);
  });
}

// Losses are counted by process: each case has one of its own.
class LostFile : public testing::Test {
 protected:
  LostFile() : path_(scratch_.write("c.tik", std::string(kBytes, '\1'))) {}

  // Ends with the message of check_mapped_files(), status 3.
  [[noreturn]] static void end_by_check() {
    const std::string message = message_of<InputError>([] { check_mapped_files(); });
    std::fputs(message.c_str(), stderr);
    std::exit(message.empty() ? 0 : 3);
  }

  Scratch scratch_;
  fs::path path_;
};

TEST_F(LostFile, IsZerosAndThenAnError) {
  const auto run = [&] {
    watch_mapped_files();
    const MappedFile file(path_);
    check_mapped_files();
    fs::resize_file(path_, kBytes / 2);
    std::uint64_t of_a_thread = 0;
    std::jthread([&] { of_a_thread = sum_of(file.bytes()); }).join();
    if (sum_of(file.bytes()) != kBytes / 2 || of_a_thread != kBytes / 2) std::exit(1);
    end_by_check();
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(3),
              "c.tik changed or could not be read any more while it was read");
}

TEST_F(LostFile, IsStillZerosAfterALibraryTookTheSignal) {
  const auto run = [&] {
    watch_mapped_files();
    std::signal(SIGBUS, [](int) { std::_Exit(7); });
    take_back_signals();
    const MappedFile file(path_);
    fs::resize_file(path_, 0);
    if (sum_of(file.bytes()) != 0) std::exit(1);
    end_by_check();
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(3), "c.tik changed");
}

// Also of one that nobody read again: what was read before may be another file's already.
TEST_F(LostFile, IsNoticedWhenItIsClosed) {
  for (const bool is_shorter : {true, false}) {
    const auto run = [&] {
      {
        const MappedFile file(path_);
        if (is_shorter) {
          fs::resize_file(path_, kBytes - 1);
        } else {
          std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the clock of a file's time is coarse
          std::fstream(path_, std::ios::in | std::ios::out).write("other", 5);
        }
      }
      end_by_check();
    };
    EXPECT_EXIT(run(), testing::ExitedWithCode(3), "c.tik changed");
  }
}

TEST_F(LostFile, GivesNothingAName) {
  const auto run = [&] {
    watch_mapped_files();
    const MappedFile file(path_);
    OutputFile output(scratch_ / "p.png");
    output.write("made of it");
    fs::resize_file(path_, 0);
    try {
      output.commit();
    } catch (const InputError&) {
      std::exit(fs::exists(scratch_ / "p.png") ? 1 : 3);
    }
    std::exit(0);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(3), "");
}

// A program that goes on for days: what a file was touched for is that file's alone, until it is opened again.
TEST_F(LostFile, ConcernsOnlyWhatWasMadeOfIt) {
  const auto run = [&] {
    const MappedFile file(path_);
    const MappedFile other(scratch_.write("other.tik", "as it was"));
    OutputFile begun(scratch_ / "begun.png");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::fstream(path_, std::ios::in | std::ios::out).write("other", 5);
    const auto throws = [](const auto& call) {
      return message_of<InputError>(call).find("c.tik changed") != std::string::npos;
    };
    if (!throws([&] { begun.commit(); })) std::exit(1);
    for (int again = 0; again < 2; ++again) {
      if (!throws([&] { file.check(); })) std::exit(2);
      other.check();
      write_text(scratch_ / "notes.txt", "made of nothing");
      MappedFile(path_).check();
    }
    if (!fs::exists(scratch_ / "notes.txt") || fs::exists(scratch_ / "begun.png")) std::exit(3);
    do_one_work();  // of which all is
    std::exit(throws([&] { write_text(scratch_ / "late.txt", "made of it, perhaps"); }) ? 0 : 4);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
}

TEST_F(LostFile, MayBeReplacedByAnother) {
  const auto run = [&] {
    watch_mapped_files();
    const MappedFile file(path_);
    scratch_.write("new", "another");
    fs::rename(scratch_ / "new", path_);
    if (sum_of(file.bytes()) != kBytes) std::exit(1);
    end_by_check();
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
}

TEST_F(LostFile, OfAnotherLibraryEndsTheProcessAsBefore) {
  const auto run = [&] {
    watch_mapped_files();
    raise(SIGBUS);
    std::exit(0);
  };
  EXPECT_EXIT(run(), testing::KilledBySignal(SIGBUS), "");
}

TEST_F(LostFile, OfAnotherLibraryIsThatLibrarys) {
  const auto run = [&] {
    std::signal(SIGBUS, [](int) { std::_Exit(7); });
    watch_mapped_files();
    watch_mapped_files();
    const MappedFile file(path_);
    fs::resize_file(path_, 0);
    if (sum_of(file.bytes()) != 0) std::exit(1);
    raise(SIGBUS);
    std::exit(0);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace nutik::test

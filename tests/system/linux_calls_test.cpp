// What Linux does, and in posix_tests what POSIX does instead.
#include "system/linux_calls.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <span>

#include "support/scratch.hpp"
#include "system/page_buffer.hpp"
#include "system/temporary_folder.hpp"

namespace nutik::test {
namespace {

TEST(LinuxCalls, FilesWithoutANameAreOnlyLinuxs) {
  const Scratch scratch;
  const int nameless = open_nameless(scratch / "", O_WRONLY, 0600);
#ifdef NUTIK_POSIX
  EXPECT_LT(nameless, 0);
  EXPECT_FALSE(give_name(nameless, scratch / "named"));
#else
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without names";
  EXPECT_TRUE(std::filesystem::is_empty(scratch / ""));
  EXPECT_TRUE(give_name(nameless, scratch / "named"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "named"));
  close(nameless);
#endif
}

TEST(LinuxCalls, AnOpenFileIsOpenedAgainByItsPath) {
  const NamelessFile file;
  ASSERT_EQ(write(file.descriptor(), "told", 4), 4);
  EXPECT_EQ(std::filesystem::file_size(file.path()), 4u);
}

TEST(LinuxCalls, LinksAreReadAndNotFollowed) {
  const Scratch scratch;
  scratch.write("file", "");
  std::filesystem::create_symlink("nowhere", scratch / "link");
  EXPECT_EQ(read_link(scratch / "link").target, "nowhere");
  EXPECT_EQ(read_link(scratch / "file").target, std::nullopt);
  EXPECT_EQ(read_link(scratch / "file").error, 0);
  EXPECT_EQ(read_link(scratch / "nowhere").error, ENOENT);
  std::filesystem::create_directory_symlink(".", scratch / "folder");
  EXPECT_LT(open_folder(scratch / "folder"), 0);
  const int folder = open_folder(scratch / "");
  ASSERT_GE(folder, 0);
  EXPECT_TRUE(std::filesystem::exists(path_in(folder, scratch / "", "file")));
  close(folder);
}

TEST(LinuxCalls, TheRunningProgramIsTheOneInPath) {
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe");
  const char* const before = std::getenv("PATH");
  const std::string path = before == nullptr ? "" : before;
  ::setenv("PATH", ("/nowhere:" + own.parent_path().string()).c_str(), 1);
  EXPECT_EQ(running_program(own.filename()), own);
  ::setenv("PATH", path.c_str(), 1);
}

TEST(LinuxCalls, PagesKeepWhatTheyHoldWhereTheyGrow) {
  constexpr std::uint64_t kBytes = 3 << 20, kMore = 40 << 20;  // across the size from which pages are large
  PageBuffer buffer(kBytes);
  for (std::uint64_t i = 0; i < kBytes; ++i) buffer.data()[i] = static_cast<std::byte>(i % 251);
  buffer.grow(kMore);
  for (std::uint64_t i = 0; i < kBytes; ++i) ASSERT_EQ(buffer.data()[i], static_cast<std::byte>(i % 251)) << i;
  const std::span grown(buffer.data() + kBytes, buffer.data() + kMore);
  EXPECT_TRUE(std::ranges::all_of(grown, [](std::byte b) { return b == std::byte{0}; }));
}

}  // namespace
}  // namespace nutik::test

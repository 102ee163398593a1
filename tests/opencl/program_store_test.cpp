#include "opencl/program_store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "capture/error.hpp"
#include "opencl/cache_folder.hpp"
#include "support/messages.hpp"
#include "support/running_program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

constexpr const char* kSource = "kernel void fill(global int* to) { to[get_global_id(0)] = NUMBER; }";

class ProgramStoreTest : public testing::Test {
 protected:
  // Builds or loads the program, runs it, saves; returns what the kernel wrote.
  int run(const std::string& number) {
    ProgramStore store(context_, device_, scratch_.folder() / "cache", [this](auto&) { ++builds_; });
    const cl::Program program = store.get("fill", kSource, "-DNUMBER=" + number);
    cl::CommandQueue queue(context_, device_);
    const cl::Buffer buffer(context_, CL_MEM_READ_WRITE, sizeof(cl_int));
    cl::KernelFunctor<cl::Buffer> fill(program, "fill");
    fill(cl::EnqueueArgs(queue, cl::NDRange(1)), buffer);
    cl_int value = 0;
    queue.enqueueReadBuffer(buffer, CL_TRUE, 0, sizeof value, &value);
    store.save_new_binaries();
    return value;
  }

  [[nodiscard]] std::vector<std::filesystem::path> cached() const { return files_with(scratch_ / "cache", ""); }

  cl::Device device_ = all_devices().front();
  cl::Context context_{device_};
  Scratch scratch_;
  int builds_ = 0;
};

TEST_F(ProgramStoreTest, BuildsOnceAndThenLoads) {
  EXPECT_EQ(run("7"), 7);
  EXPECT_EQ(run("7"), 7);
  EXPECT_EQ(builds_, 1);
  EXPECT_EQ(run("8"), 8);  // other options: another program
  EXPECT_EQ(builds_, 2);
  EXPECT_EQ(cached().size(), 2u);
}

TEST_F(ProgramStoreTest, RebuildsADamagedEntry) {
  EXPECT_EQ(run("7"), 7);
  const auto file = cached().front();
  const std::string whole = read_file(file);
  for (const std::string& damaged : {std::string(), whole.substr(0, whole.size() / 2),
                                     whole.substr(0, whole.size() - 1) + "x", "other " + whole}) {
    std::ofstream(file, std::ios::binary) << damaged;
    const int before = builds_;
    EXPECT_EQ(run("7"), 7);
    EXPECT_EQ(builds_, before + 1);
    EXPECT_EQ(read_file(file).size(), whole.size()) << "the entry was not written again";
  }
}

TEST_F(ProgramStoreTest, WorksWithoutAPlaceToWrite) {
  std::ofstream(scratch_.folder() / "cache") << "a file where the folder should be";
  EXPECT_EQ(run("7"), 7);
}

TEST_F(ProgramStoreTest, BuildsWhereAFolderHasAFilesName) {
  EXPECT_EQ(run("7"), 7);
  const auto file = cached().front();
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_EQ(run("7"), 7);
  EXPECT_EQ(builds_, 2);
  EXPECT_EQ(cached().size(), 1u) << "something was left behind";
}

// Binaries are native code.
TEST_F(ProgramStoreTest, LoadsNothingThatOthersMayWrite) {
  namespace fs = std::filesystem;
  EXPECT_EQ(run("7"), 7);
  const fs::path folder = scratch_ / "cache";
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all);
  EXPECT_EQ(flaw_of_cache(folder), "");
  EXPECT_EQ(flaw_of_cache(scratch_ / "absent"), "");
  for (const fs::perms others : {fs::perms::group_write, fs::perms::others_write}) {
    const auto file = cached().front();
    fs::permissions(file, others, fs::perm_options::add);
    const int before = builds_;
    EXPECT_EQ(run("7"), 7);
    EXPECT_EQ(builds_, before + 1);

    fs::permissions(folder, others, fs::perm_options::add);
    expect_says(flaw_of_cache(folder), "other users may write to " + folder.string());
    fs::permissions(folder, fs::perms::owner_all);
  }
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a file to another user";
  ASSERT_EQ(chown(cached().front().c_str(), 12345, 12345), 0);
  const int before = builds_;
  EXPECT_EQ(run("7"), 7);
  EXPECT_EQ(builds_, before + 1);
  ASSERT_EQ(chown(folder.c_str(), 12345, 12345), 0);
  expect_says(flaw_of_cache(folder), "belongs to another user");
}

TEST_F(ProgramStoreTest, AFailureCarriesProgramOptionsAndLog) {
  ProgramStore store(context_, device_, {}, {});
  expect_error<DeviceError>([&] { return store.get("broken", "kernel void broken() { undeclared = 1; }", "-DX=1"); },
                            {"kernels/broken.cl", "-DX=1", "undeclared"});
}

}  // namespace
}  // namespace nutik::test

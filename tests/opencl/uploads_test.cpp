// What is copied to a device by way of pinned memory is there, however it is cut.
#include "opencl/uploads.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nutik {
namespace {

std::vector<std::byte> counted(std::uint64_t bytes) {
  std::vector<std::byte> values(bytes);
  std::uint32_t state = 1;
  for (std::byte& value : values) value = static_cast<std::byte>((state = state * 1664525u + 1013904223u) >> 24);
  return values;
}

class UploadsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (describe_device(device_).largest_allocation_bytes < 32 * kPiece) GTEST_SKIP() << "it allocates less at a time";
  }

  // What a device's buffer holds after writes of the parts of `values` that end at `ends`, in turn.
  std::vector<std::byte> uploaded(std::span<const std::byte> values, std::span<const std::uint64_t> ends) {
    const cl::Buffer buffer(context_, CL_MEM_READ_WRITE, values.size());
    std::uint64_t begin = 0;
    for (const std::uint64_t end : ends) {
      uploads_.write(buffer, begin, values.subspan(begin, end - begin));
      begin = end;
    }
    std::vector<std::byte> read(values.size());
    queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, read.size(), read.data());
    return read;
  }

  static constexpr std::uint64_t kPiece = Uploads::kPieceBytes;

  cl::Device device_ = all_devices().front();
  cl::Context context_{device_};
  cl::CommandQueue queue_{context_, device_};
  Uploads uploads_{context_, device_};
};

TEST_F(UploadsTest, ArriveWhole) {
  const std::vector<std::byte> values = counted(20 * kPiece + 3);
  const std::uint64_t ends[] = {values.size()};
  EXPECT_EQ(uploaded(values, ends), values);
}

TEST_F(UploadsTest, ArriveInPartsOfAnySize) {
  const std::vector<std::byte> values = counted(12 * kPiece);
  const std::uint64_t ends[] = {1,          5,          kPiece + 5,     3 * kPiece + 5,  3 * kPiece + 6,
                                5 * kPiece, 7 * kPiece, 11 * kPiece + 1, 12 * kPiece};
  EXPECT_EQ(uploaded(values, ends), values);
}

}  // namespace
}  // namespace nutik

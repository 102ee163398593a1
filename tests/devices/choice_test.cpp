// Which devices a person means who names several.
#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "opencl/device.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

using Indices = std::vector<std::size_t>;

std::vector<DeviceInfo> four_devices() {
  std::vector<DeviceInfo> devices(4);
  devices[0].name = "GeForce RTX 4090";
  devices[0].platform = "NVIDIA CUDA";
  devices[1].name = "GeForce RTX 4090";
  devices[1].platform = "NVIDIA CUDA";
  devices[2].name = "Radeon Pro";
  devices[2].platform = "Advanced Micro Devices, Inc.";
  devices[3].name = "pthread-skylake";
  devices[3].platform = "Portable Computing Language";
  return devices;
}

TEST(ChosenDevices, AreNamedOneByOneOrAllAtOnce) {
  const auto devices = four_devices();
  EXPECT_EQ(choose_devices(devices, ""), (Indices{0}));
  EXPECT_EQ(choose_devices(devices, "2"), (Indices{2}));
  EXPECT_EQ(choose_devices(devices, "radeon"), (Indices{2}));
  EXPECT_EQ(choose_devices(devices, "0,1"), (Indices{0, 1}));
  EXPECT_EQ(choose_devices(devices, "3, 1"), (Indices{3, 1}));
  EXPECT_EQ(choose_devices(devices, "pthread,RADEON"), (Indices{3, 2}));
  for (const char* all : {"all", "ALL", " all "})
    EXPECT_EQ(choose_devices(devices, all), (Indices{0, 1, 2, 3}));
}

TEST(ChosenDevices, MayHaveACommaInTheirName) {
  EXPECT_EQ(choose_devices(four_devices(), "micro devices, inc"), (Indices{2}));
}

TEST(ChosenDevices, AreThereEachOnce) {
  const auto devices = four_devices();
  const auto refusal = [&](const char* wanted) {
    return message_of<DeviceError>([&] { return choose_devices(devices, wanted); });
  };
  EXPECT_EQ(refusal("2,radeon"), "'2,radeon' names device 2 twice (Radeon Pro); name each once");
  for (const char* wanted : {"0,", ",0", "0,,1", ","}) {
    expect_says(refusal(wanted), "names no device before or after a comma; these were found:\n  0  GeForce");
  }
  EXPECT_EQ(refusal("all,0"), "'all,0' names all devices and some of them; say all, or name some");
  expect_says(refusal("0,4"), "there is no OpenCL device 4; these were found:");
  expect_says(refusal("0,arc"), "no OpenCL device's name contains 'arc'");
  expect_says(refusal("3,geforce"), "more than one OpenCL device's name contains 'geforce'");
}

TEST(ChosenDevices, ALookAtTheTextTellsWhetherTheyMayBeSeveral) {
  for (const char* one : {"", "0", "radeon", "small"}) EXPECT_FALSE(may_mean_several(one)) << one;
  for (const char* several : {"0,1", "all", "All"}) EXPECT_TRUE(may_mean_several(several)) << several;
}

}  // namespace
}  // namespace nutik::test

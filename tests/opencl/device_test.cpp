#include "opencl/device.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

std::vector<DeviceInfo> three_devices() {
  std::vector<DeviceInfo> devices(3);
  devices[0].name = "GeForce RTX 4090";
  devices[0].platform = "NVIDIA CUDA";
  devices[0].kind = DeviceKind::gpu;
  devices[1].name = "Radeon Pro";
  devices[1].platform = "AMD";
  devices[1].kind = DeviceKind::gpu;
  devices[2].name = "pthread-skylake";
  devices[2].platform = "Portable Computing Language";
  devices[2].kind = DeviceKind::cpu;
  return devices;
}

TEST(Device, IsChosenByIndexOrPartOfAName) {
  const auto devices = three_devices();
  EXPECT_EQ(choose_device(devices, ""), 0u);
  EXPECT_EQ(choose_device(devices, "2"), 2u);
  EXPECT_EQ(choose_device(devices, "radeon"), 1u);
  EXPECT_EQ(choose_device(devices, "portable"), 2u);
}

TEST(Device, AnAbsentOneIsAnErrorThatListsThoseFound) {
  const auto devices = three_devices();
  for (const char* wanted : {"3", "arc", "a", "-1"}) {
    expect_error<DeviceError>([&] { return choose_device(devices, wanted); }, {wanted, "\n  1  Radeon Pro (GPU, AMD)"});
  }
}

TEST(Device, ThisMachineHasOneAndGpusComeFirst) {
  const auto devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (std::size_t i = 1; i < devices.size(); ++i) EXPECT_LE(devices[i - 1].kind, devices[i].kind);
  for (const DeviceInfo& device : devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_GT(device.largest_allocation_bytes, 0u);
  }
}

}  // namespace
}  // namespace nutik::test

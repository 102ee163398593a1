// A program of somebody else's: it uses a room of each kind of dependency, and says so.
#include <cstdio>
#include <fstream>
#include <string>

#include "capture/error.hpp"
#include "capture/timeline.hpp"
#include "media/clip.hpp"
#include "media/picture_writer.hpp"
#include "opencl/device.hpp"
#include "tik/reader.hpp"

int main() {
  const auto timeline = nutik::Timeline::constant({960, 1}, nutik::Timeline::kFullShutter, 48);
  std::printf("%lld ns\n", static_cast<long long>(timeline.duration_ns()));
  if (nutik::parse_depth("16") != nutik::Depth::bits16) return 1;
  try {
    std::printf("%zu devices\n", nutik::list_devices().size());
  } catch (const nutik::DeviceError& error) {
    std::printf("%s\n", error.what());
  }
  // Videos are read by a module, which is found though this program does not lie beside it.
  std::ofstream("consumer.raw", std::ios::binary) << std::string(3 * 8 * 8, 'x');
  nutik::ClipOptions options;
  options.raw = nutik::RawVideo{8, 8, "gray"};
  options.rate = nutik::Rational{30, 1};
  std::printf("%u pixels wide\n", nutik::open_clip("consumer.raw", options)->info().format.shape.width);
  try {
    const nutik::tik::Reader reader("absent.tik");
  } catch (const nutik::InputError& error) {
    std::printf("%s\n", error.what());
    return 0;
  }
  return 1;
}

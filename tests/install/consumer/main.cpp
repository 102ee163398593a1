// A program of somebody else's: it uses a room of each kind of dependency, and says so.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <nutik/session.hpp>

namespace {

// Three equal pictures expose to one that has their codes.
bool renders(const nutik::ClipOptions& clip) {
  nutik::SourceRequest source;
  source.path = "consumer.raw";
  source.clip = clip;
  nutik::ComputingRequest computing;
  computing.renderer = nutik::RendererKind::reference;
  nutik::Session session(source, computing);
  nutik::ExposureRequest request;
  request.gains = nutik::PlainInterval{nutik::StatedTime::of_pictures(2), nutik::Shutter()};
  const nutik::ExposedPicture exposed = session.render(request, {nutik::ValueType::code8, 255});
  nutik::write_picture("consumer.pgm", exposed.picture);
  return exposed.picture.bytes == std::vector<std::byte>(8 * 8, std::byte{'x'});
}

}  // namespace

int main() {
  const auto timeline = nutik::Timeline::constant({960, 1}, nutik::Timeline::kFullShutter, 48);
  std::printf("%lld ns\n", static_cast<long long>(timeline.duration_ns()));
  if (nutik::parse_primaries("p3") != nutik::Primaries::p3) return 1;
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
  if (!renders(options)) return 1;
  try {
    const nutik::tik::Reader reader("absent.tik");
  } catch (const nutik::InputError& error) {
    std::printf("%s\n", error.what());
    return 0;
  }
  return 1;
}

// Recordings of events: open_clip() reads them whole, then every sample is read as what changes. The first byte chooses
// how the file begins.
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "fuzz/target.hpp"
#include "media/clip.hpp"

namespace nutik::fuzz {
namespace {

constexpr std::string_view kStarts[] = {
    "% evt 2.0\n",    "% format EVT21;height=9;width=70;endianness=legacy\n% end\n",
    "% format EVT21\n", "% format EVT3;height=9;width=70\n",
    "% Width 70\n% Height 9\n\x0c\x08", "adder\x03"
                                      "b",
    "adder", "% "};

// Coordinates alone may make a picture of 2048 x 2048 pixels, or in ADΔER of 65535 x 65535.
constexpr std::uint64_t kMaxSampleBytes = 64 << 20;

void read(Bytes input) {
  if (input.empty()) return;
  const std::string_view start = kStarts[static_cast<std::size_t>(input.front()) % std::size(kStarts)];
  std::vector<std::byte> file;
  for (const char c : start) file.push_back(static_cast<std::byte>(c));
  file.insert(file.end(), input.begin() + 1, input.end());
  const std::unique_ptr<Clip> clip = open_clip(as_file(file, "a.raw"), {});
  const CaptureFormat& format = clip->info().format;
  demand(clip->tells_changes() && format.shape.value_count() > 0, "a recording has pixels, which change");
  if (format.sample_bytes() > kMaxSampleBytes) return;
  std::uint64_t samples = 0;
  for (auto changes = clip->read_changes(); changes; changes = clip->read_changes()) {
    ++samples;
    for (const PixelChange& change : *changes) {
      demand(change.pixel < format.shape.pixel_count(), "a change lies in the picture");
    }
  }
  demand(samples == clip->info().sample_count, "there are as many samples as are announced");
  static_cast<void>(timeline_of("clip", clip->info(), {}, Timeline::kFullShutter, samples));
}

}  // namespace

const Target kTarget{{std::size_t{3} << 30, 4000}, read};

}  // namespace nutik::fuzz

// Photron's headers, beside pictures that some of them fit.
#include <string>
#include <vector>

#include "fuzz/target.hpp"
#include "media/clip.hpp"
#include "media/formats/input_kinds.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  as_file(input, "a.cihx");
  const std::vector<std::byte> pictures(240, std::byte{1});
  const auto clip = inputs::kPhotron.open(as_file(pictures, "a.mraw"), {}, {});
  std::vector<std::byte> raster(clip->info().format.sample_bytes());
  while (clip->read(raster)) {
  }
}

}  // namespace

const Target kTarget{{1 << 20, 100}, read};

}  // namespace nutik::fuzz

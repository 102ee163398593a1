// Masks: PGM in both forms, and PNG.
#include "fuzz/target.hpp"
#include "media/stills/mask_reader.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  const Picture mask = read_mask(input, "mask");
  demand(mask.bytes.size() == mask.shape.pixel_count(), "a mask has a tag for each pixel");
}

}  // namespace

// Zeros are packed to a thousandth in a PNG; rows are pointed at while it is read.
const Target kTarget{{1 << 22, 4000}, read};

}  // namespace nutik::fuzz

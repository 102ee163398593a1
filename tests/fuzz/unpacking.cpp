// Packed payloads: the first bytes choose codec and geometry, the rest is what a file would hold.
#include <vector>

#include "fuzz/target.hpp"
#include "imev/block.hpp"
#include "tik/codec.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  constexpr std::size_t kChoices = 8;
  if (input.size() < kChoices) return;
  const auto choice = [&](std::size_t i) { return static_cast<std::uint32_t>(input[i]); };
  CaptureFormat format{.shape = {1 + choice(0) % 40, 1 + choice(1) % 40, choice(2) % 2 == 0 ? 1u : 3u},
                       .code_bytes = 1 + choice(3) % 2};
  format.white_code = format.code_bytes == 1 ? 255 : 4095;
  const BlockGeometry geometry(format, 1 + choice(4) % 70);
  std::vector<std::byte> payload((choice(5) + 256 * choice(6)) * 64);
  constexpr tik::CodecId kPacking[] = {tik::CodecId::lz4, tik::CodecId::zstd, tik::CodecId::rice};
  const tik::CodecId codec = kPacking[choice(7) % 3];
  static_cast<void>(tik::unpack_directory(codec, geometry, input.subspan(kChoices), payload.size()));
  tik::unpack(codec, geometry, input.subspan(kChoices), payload);
}

}  // namespace

const Target kTarget{{64 << 20, 100}, read};

}  // namespace nutik::fuzz

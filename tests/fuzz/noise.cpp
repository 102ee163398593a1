// Noise files; what is read from one is read again, identically, from what is written of it.
#include "capture/noise_file.hpp"
#include "fuzz/target.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  const CameraNoise noise = parse_noise(as_text(input), "input.noise");
  demand(parse_noise(noise_text(noise, {}), "again") == noise, "noise is read from its text as it was");
}

}  // namespace

const Target kTarget{{1 << 22, 2000}, read};

}  // namespace nutik::fuzz

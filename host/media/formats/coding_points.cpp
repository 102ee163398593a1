#include "media/formats/coding_points.hpp"

namespace nutik {

std::optional<std::uint8_t> coding_point(const Transfer& transfer) {
  // The first number that stands for a function is its own.
  for (std::uint8_t number = 1; number <= 18; ++number) {
    if (transfer_of_coding_point(number) == transfer) return number;
  }
  return std::nullopt;
}

std::uint8_t coding_point(Primaries primaries) {
  for (std::uint8_t number = 1; number <= 12; ++number) {
    if (primaries_of_coding_point(number) == primaries) return number;
  }
  return kUnnamedPrimaries;
}

std::optional<Transfer> transfer_of_coding_point(unsigned number) {
  switch (number) {
    case 1:   // BT.709
    case 6:   // BT.601
    case 14:  // BT.2020, 10 bits
    case 15: return Transfer::bt709();
    case 4: return Transfer::gamma(2.2);
    case 5: return Transfer::gamma(2.8);
    case 8: return Transfer::linear();
    case 13: return Transfer::srgb();
    case 16: return Transfer::pq();
    case 18: return Transfer::hlg();
    default: return std::nullopt;
  }
}

std::optional<Primaries> primaries_of_coding_point(unsigned number) {
  switch (number) {
    case 1:
    case 5:  // PAL
    case 6:  // NTSC
    case 7: return Primaries::bt709;
    case 9: return Primaries::bt2020;
    case 11: return Primaries::dci_p3;
    case 12: return Primaries::p3;
    default: return std::nullopt;
  }
}

}  // namespace nutik

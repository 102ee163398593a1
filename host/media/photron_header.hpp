// What Photron's cameras write beside their pictures (.cih: text, .cihx: XML): how fast they filmed, and how long each
// picture was exposed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "capture/rational.hpp"

namespace nutik {

struct PhotronHeader {
  std::filesystem::path file;
  std::optional<Rational> rate;            // pictures a second
  std::optional<std::int64_t> exposed_ns;  // of each
};

// What a header's text says; whatever it does not say, or what makes no sense, is left out.
[[nodiscard]] PhotronHeader parse_photron_header(std::string_view text);

// The header of a file of pictures, which has its name, or the only one in a folder of them. None where there is
// none, or it tells no rate.
[[nodiscard]] std::optional<PhotronHeader> photron_header_of(const std::filesystem::path& pictures);

}  // namespace nutik

// Netpbm pictures: PGM and PPM, plain (P2, P3) and raw (P5, P6), PAM (P7), and PFM.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

// Reads a PGM, PPM or PAM. Codes are taken as they stand and never scaled; the picture's white code is the
// file's maxval. Throws InputError naming `name` where the file is damaged, cut off, of another kind, or transparent.
[[nodiscard]] Picture read_netpbm(std::span<const std::byte> file, const std::string& name);

// Where the pictures begin of a file that holds one behind the other; the first at 0, whatever it is.
[[nodiscard]] std::vector<std::size_t> netpbm_starts(std::span<const std::byte> file, const std::string& name);

// A picture as a raw PGM or PPM (codes), or as a PFM (light32: floats in light, bottom row first).
// `comment` is one line behind the first of a PGM or PPM; none where it is empty.
[[nodiscard]] std::string netpbm_text(const Picture& picture, const std::string& comment = {});

}  // namespace nutik

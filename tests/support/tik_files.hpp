// .tik files of random cases, and what is read back from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "tik/codec.hpp"
#include "tik/reader.hpp"

namespace nutik::test {

// Writes a capture, whose first sample is held so, or a case's into `capture.tik`, and returns its path.
std::filesystem::path write_tik(const MemoryCapture& capture, std::span<const std::byte> first, const tik::Codec& codec,
                                const Scratch& scratch);
std::filesystem::path write_tik(const RandomCase& random, const tik::Codec& codec, const Scratch& scratch);

// Writes a copy of a capture whose header says something else, and returns its path.
std::filesystem::path write_saying(const tik::Reader& plain, const std::filesystem::path& copy,
                                   const std::function<void(tik::Header&)>& change);

// A random case whose camera's noise is known: points or a sensor, with as many digits as doubles have.
[[nodiscard]] RandomCase noisy_case(std::uint64_t seed);

// Format, timeline and every block are those of the case.
void expect_same_capture(const RandomCase& random, tik::Reader& reader);

}  // namespace nutik::test

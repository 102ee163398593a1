// A soft mask as files: a layer for each of its tags.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "exposure/mask.hpp"
#include "media/formats/numbered_name.hpp"
#include "session/output_check.hpp"

namespace nutik {

class MaskLayers {
 public:
  // `mask-%d.png`. Throws UsageError where the name has no place for a number.
  explicit MaskLayers(const std::filesystem::path& name);

  [[nodiscard]] std::filesystem::path file(std::uint64_t tag) const { return folder_ / numbered_.with(tag); }

  // Throws what check_output() does.
  void check(std::span<const std::string> inputs, Replacing replacing) const;

  // Writes those of the tags that have a share, in 16 bits. Throws OutputError, also where a layer of another mask is
  // there, which would be read along with them.
  void write(const Mask& mask) const;

 private:
  std::filesystem::path name_, folder_;
  NumberedName numbered_;
};

}  // namespace nutik

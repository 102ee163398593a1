// Names with a number in them, as printf writes it: `frame%04d.png`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace nutik {

struct NumberedName {
  std::string before;
  std::string after;
  std::size_t width = 0;
  char fill = ' ';

  // Reads %d, %i or %u, with a width and leading zeros. Nothing where the name has none of them.
  static std::optional<NumberedName> parse(const std::string& name);

  // The name with a number, which is given in digits without leading zeros.
  [[nodiscard]] std::string with(const std::string& digits) const;
  [[nodiscard]] std::string with(std::uint64_t number) const { return with(std::to_string(number)); }
};

}  // namespace nutik

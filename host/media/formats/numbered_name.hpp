// Names with a number in them, `frame%04d.png`, as printf has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace nutik {

// What stands before and after the number, and how it is written.
struct NumberedName {
  std::string before;
  std::string after;
  std::size_t width = 0;
  char fill = ' ';

  // A file's name without its folder: `%d`, `%4d` or `%04d`, also with i or u, once. Empty where there is
  // none.
  static std::optional<NumberedName> parse(const std::string& name);

  // Throws UsageError where another number follows, which no one number gives.
  void expect_one(const std::string& name) const;

  // The name with this number, given as its digits or as such.
  [[nodiscard]] std::string with(const std::string& digits) const;
  [[nodiscard]] std::string with(std::uint64_t number) const { return with(std::to_string(number)); }
};

}  // namespace nutik

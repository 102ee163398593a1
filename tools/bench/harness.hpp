// What benchmarks share: their options, and medians.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <variant>
#include <vector>

namespace nutik::bench {

// An option and where its value goes; a flag has none.
struct BenchOption {
  std::string_view name;
  std::variant<std::uint32_t*, std::uint64_t*, int*, std::string*, bool*> value;
};

[[noreturn]] inline void refuse(std::string_view word, const char* why, const char* source) {
  std::fprintf(stderr, "%.*s %s; see the head of tools/bench/%s\n", static_cast<int>(word.size()),
               word.data(), why, source);
  std::exit(2);
}

// Reads a command line; `source` is the file that explains its options. Ends the program where one is not known, or its
// value is no whole number of 0 on.
inline void read_options(int argc, char** argv, const char* source,
                         std::initializer_list<BenchOption> options) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const auto* option = std::ranges::find(options, word, &BenchOption::name);
    if (option == options.end()) refuse(word, "is no option", source);
    if (auto* const* flag = std::get_if<bool*>(&option->value)) {
      **flag = true;
      continue;
    }
    if (i + 1 == argc) refuse(word, "needs a value", source);
    const std::string_view text = argv[++i];
    std::visit(
        [&](auto* value) {
          using Value = std::remove_pointer_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, std::string>) {
            *value = text;
          } else if constexpr (!std::is_same_v<Value, bool>) {
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
            if (error != std::errc() || end != text.data() + text.size() || *value < Value{0}) {
              refuse(word, "needs a whole number", source);
            }
          }
        },
        option->value);
  }
}

inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace nutik::bench

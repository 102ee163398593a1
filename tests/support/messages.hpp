// What an error says.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <optional>
#include <source_location>
#include <string>
#include <string_view>
#include <vector>

namespace nutik::test {

// A text has all of these parts. What fails is told at the line of the test.
inline void expect_says(std::string_view text, std::initializer_list<std::string_view> parts,
                        const std::source_location& at = std::source_location::current()) {
  for (const std::string_view part : parts) {
    if (text.find(part) == text.npos)
      ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << "no '" << part << "' in: " << text;
  }
}
inline void expect_says(std::string_view text, std::string_view part,
                        const std::source_location& at = std::source_location::current()) {
  expect_says(text, {part}, at);
}

// The `Error` that `act` throws; none where it throws none.
template <typename Error, typename Act>
[[nodiscard]] std::optional<Error> error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

// Its message; empty where it throws none.
template <typename Error, typename Act>
[[nodiscard]] std::string message_of(Act act) {
  const auto error = error_of<Error>(act);
  return error ? error->what() : "";
}

// `act` throws an `Error` whose message has all of these parts.
template <typename Error, typename Act>
void expect_error(Act act, const std::vector<std::string>& parts,
                  const std::source_location& at = std::source_location::current()) {
  const auto error = error_of<Error>(act);
  if (!error) {
    ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << "nothing was thrown; expected: " << parts.front();
    return;
  }
  for (const std::string& part : parts) expect_says(error->what(), part, at);
}

}  // namespace nutik::test

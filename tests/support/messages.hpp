// What an error says.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace nutik::test {

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
void expect_error(Act act, const std::vector<std::string>& parts) {
  const auto error = error_of<Error>(act);
  if (!error) FAIL() << "nothing was thrown; expected: " << parts.front();
  for (const std::string& part : parts)
    EXPECT_NE(std::string(error->what()).find(part), std::string::npos) << error->what();
}

}  // namespace nutik::test

// What an error says.
#pragma once

#include <string>

namespace nutik::test {

// The message of the `Error` that `act` throws; empty where it throws none.
template <typename Error, typename Act>
[[nodiscard]] std::string message_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace nutik::test

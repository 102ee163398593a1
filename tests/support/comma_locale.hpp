// A locale whose numbers have a comma, as 2,5, of all threads while this lives.
#pragma once

#include <clocale>
#include <cstdlib>

#include "support/scratch.hpp"

namespace nutik::test {

class CommaLocale {
 public:
  CommaLocale() {
    const std::string made = "localedef -i de_DE -f UTF-8 " + (scratch_ / "de_DE.UTF-8").string() + " 2> /dev/null";
    is_set_ = std::system(made.c_str()) == 0 && setenv("LOCPATH", scratch_.folder().c_str(), 1) == 0 &&
              std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  }
  ~CommaLocale() {
    std::setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  // False where the system has not what it is made of.
  [[nodiscard]] bool is_set() const { return is_set_; }

 private:
  Scratch scratch_;
  bool is_set_ = false;
};

}  // namespace nutik::test

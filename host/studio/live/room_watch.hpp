// Whether a temporary capture will fit, looked at while it is written: what its first samples took says what the rest
// will take.
//
//   in:   progress in samples; the bytes that are left where it lies
//   out:  OutputError once the rest is sure not to fit, while there still is room
//   kept: a quarter more than is left is let pass, since what follows may pack better
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace nutik::studio {

class RoomWatch {
 public:
  using Left = std::function<std::uint64_t()>;

  explicit RoomWatch(std::filesystem::path folder);
  RoomWatch(std::filesystem::path folder, Left left);

  void look(std::uint64_t done, std::uint64_t total) const;

 private:
  std::filesystem::path folder_;
  Left left_;
  std::uint64_t at_first_;
};

}  // namespace nutik::studio

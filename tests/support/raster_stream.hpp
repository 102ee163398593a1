// Samples in memory as a stream that a StreamingCapture reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nutik::test {

class RasterStream {
 public:
  // The first `count` of these, which must outlive this.
  RasterStream(std::span<const std::vector<std::byte>> rasters, std::uint64_t count)
      : rest_(rasters.first(count)) {}
  explicit RasterStream(std::span<const std::vector<std::byte>> rasters)
      : RasterStream(rasters, rasters.size()) {}

  std::span<const std::span<const std::byte>> operator()(std::uint64_t most) {
    given_.clear();
    for (; !rest_.empty() && given_.size() < most; rest_ = rest_.subspan(1))
      given_.emplace_back(rest_.front());
    read_ += given_.size();
    return given_;
  }

  // How many were asked for so far.
  [[nodiscard]] std::uint64_t read() const { return read_; }

 private:
  std::span<const std::vector<std::byte>> rest_;
  std::vector<std::span<const std::byte>> given_;
  std::uint64_t read_ = 0;
};

}  // namespace nutik::test

// A capture that does something when its blocks are asked for.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "imev/capture_source.hpp"

namespace nutik::test {

class WatchedCapture : public CaptureSource {
 public:
  using OnBlock = std::function<void(std::uint64_t block)>;
  WatchedCapture(MemoryCapture& capture, OnBlock on_block, bool is_forward_only = false)
      : capture_(capture), on_block_(std::move(on_block)), is_forward_only_(is_forward_only) {}

  [[nodiscard]] const CaptureFormat& format() const override { return capture_.format(); }
  [[nodiscard]] const Timeline& timeline() const override { return capture_.timeline(); }
  [[nodiscard]] std::uint64_t block_count() const override { return capture_.block_count(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override {
    return capture_.block_extent(block);
  }
  [[nodiscard]] bool is_forward_only() const override { return is_forward_only_; }

 private:
  BlockLease lend(std::uint64_t block, const LeaseTerms& terms) override {
    on_block_(block);
    return capture_.acquire(block, terms);
  }

  MemoryCapture& capture_;
  OnBlock on_block_;
  bool is_forward_only_;
};

}  // namespace nutik::test

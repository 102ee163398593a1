// What work takes in memory at the least, part by part, beside what it may take.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "capture/error.hpp"

namespace nutik {

// What one part of the work takes.
struct MemoryPart {
  std::string what;  // "blocks of the capture"
  std::uint64_t bytes = 0;
};

// The parts of a piece of work that are held at the same time.
class MemoryNeeds {
 public:
  MemoryNeeds() = default;
  MemoryNeeds(std::initializer_list<MemoryPart> parts) : parts_(parts) {}

  // To the part of that name, if there is one.
  void add(const std::string& what, std::uint64_t bytes);
  void add(const MemoryNeeds& others);

  [[nodiscard]] const std::vector<MemoryPart>& parts() const { return parts_; }
  [[nodiscard]] std::uint64_t bytes() const;

  // What is left of `allowed` bytes. Throws MemoryTooLittle where that is less than all parts together.
  std::uint64_t rest_of(std::uint64_t allowed) const;

 private:
  std::vector<MemoryPart> parts_;
};

// All that the machine has.
[[nodiscard]] std::uint64_t machine_memory();

// Less is allowed than the work takes at the least. The message says what takes it.
struct MemoryTooLittle : UsageError {
  MemoryNeeds needs;

  MemoryTooLittle(std::uint64_t allowed, MemoryNeeds least);
  [[nodiscard]] std::uint64_t min_bytes() const { return needs.bytes(); }
};

}  // namespace nutik
